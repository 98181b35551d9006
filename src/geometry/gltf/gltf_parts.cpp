#include "geometry/gltf/gltf_parts.h"

#include "geometry/gltf/gltf_json.h"
#include "vdbeam/error.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace vdbeam {
namespace {

using Json = nlohmann::json;

/// Materials in the order in which the nodes of the file's scene name them first: assimp reads the
/// children of a node before its mesh, and each mesh once.
class OrderOfUse {
public:
  explicit OrderOfUse(const Json& gltf) : gltf_(gltf) {
    const std::size_t scene = gltf.value("scene", std::size_t{0});
    for (const Json& node : gltf.at("scenes").at(scene).at("nodes"))
      visit(node.get<std::size_t>());
  }
  const std::vector<int>& materials() const { return materials_; }

private:
  void visit(std::size_t node) {
    if (!nodes_.insert(node).second)
      return;
    const Json& json = gltf_.at("nodes").at(node);
    if (json.contains("children"))
      for (const Json& child : json["children"])
        visit(child.get<std::size_t>());
    if (!json.contains("mesh") || !meshes_.insert(json["mesh"].get<std::size_t>()).second)
      return;
    for (const Json& primitive :
         gltf_.at("meshes").at(json["mesh"].get<std::size_t>()).at("primitives"))
      if (primitive.contains("material"))
        if (const int index = primitive["material"].get<int>();
            std::find(materials_.begin(), materials_.end(), index) == materials_.end())
          materials_.push_back(index);
  }

  const Json& gltf_;
  std::set<std::size_t> nodes_, meshes_;
  std::vector<int> materials_;
};

std::string name_of(const Json& materials, int index) {
  return materials.at(static_cast<std::size_t>(index)).value("name", "");
}

} // namespace

std::vector<int> gltf_material_indices(const std::string& path, const aiScene& scene) {
  const Json gltf = read_gltf_json(path);
  const Json none = Json::array();
  const Json& materials = gltf.contains("materials") ? gltf["materials"] : none;
  const auto count = static_cast<int>(materials.size());
  std::vector<int> order = OrderOfUse(gltf).materials();
  const std::size_t used = scene.mNumMaterials > 0 ? scene.mNumMaterials - 1 : 0;
  std::vector<int> result(scene.mNumMaterials, count); // the last one is that of no material
  for (std::size_t i = 0; i < used; ++i) {
    const std::string name = scene.mMaterials[i]->GetName().C_Str();
    const bool in_order = order.size() == used && name_of(materials, order[i]) == name;
    std::vector<int> same;
    for (int m = 0; m < count; ++m)
      if (name_of(materials, m) == name)
        same.push_back(m);
    if (in_order)
      result[i] = order[i];
    else if (same.size() == 1)
      result[i] = same[0];
    else
      throw FrameError(fmt::format("{}: its materials cannot be distinguished: give each a name of "
                                   "its own",
                                   path));
  }
  return result;
}

} // namespace vdbeam
