#include "geometry/gltf_materials.h"

#include "geometry/gltf_camera.h"
#include "geometry/gltf_files.h"
#include "geometry/gltf_json.h"
#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "machine/memory.h"
#include "text/printable.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace vdbeam {
namespace {

using Json = nlohmann::json;

/// Greatest number of materials of a file: each becomes a surface, and the file is read for each.
constexpr std::size_t most_materials = 256;

/// The value at a path of names, or null.
const Json* at(const Json& json, std::initializer_list<const char*> names) {
  const Json* found = &json;
  for (const char* name : names) {
    if (!found->is_object() || !found->contains(name))
      return nullptr;
    found = &(*found)[name];
  }
  return found;
}

const Json* element(const Json& json, const char* list, const Json* index) {
  const Json* values = at(json, {list});
  if (!index || !index->is_number_unsigned() || !values || !values->is_array() ||
      index->get<std::size_t>() >= values->size())
    return nullptr;
  return &(*values)[index->get<std::size_t>()];
}

double number(const Json* value, double otherwise, double least, double most) {
  if (!value || !value->is_number() || !std::isfinite(value->get<double>()))
    return otherwise;
  return std::clamp(value->get<double>(), least, most);
}

Rgb color(const Json* value, const Rgb& otherwise, float most) {
  if (!value || !value->is_array() || value->size() < 3)
    return otherwise;
  Rgb result;
  for (int c = 0; c < 3; ++c)
    result[c] = static_cast<float>(
        number(&(*value)[static_cast<std::size_t>(c)], 0, 0, static_cast<double>(most)));
  return result;
}

class MaterialReader {
public:
  explicit MaterialReader(const std::string& path) : path_(path), gltf_(read_gltf_json(path)) {
    if (!gltf_.is_object())
      throw FrameError(path + ": is no readable glTF");
  }

  GltfMaterials read() {
    GltfMaterials result;
    const Json* materials = at(gltf_, {"materials"});
    const std::size_t count = materials && materials->is_array() ? materials->size() : 0;
    for (const std::size_t index : used(count)) {
      GltfMaterial material;
      material.index = static_cast<int>(index);
      material.settings.type = MaterialType::standard;
      if (index < count)
        fill((*materials)[index], material.settings);
      else
        material.settings.metal = material.settings.roughness.emplace(1);
      result.used.push_back(material);
    }
    if (result.used.size() > most_materials)
      throw FrameError(fmt::format("{}: has {} materials; at most {} are read: join some", path_,
                                   result.used.size(), most_materials));
    result.notes.assign(notes_.begin(), notes_.end());
    return result;
  }

private:
  /// Indices of the materials that primitives name; `count` for those that name none.
  std::set<std::size_t> used(std::size_t count) const {
    std::set<std::size_t> indices;
    const Json* meshes = at(gltf_, {"meshes"});
    for (const Json& mesh : meshes && meshes->is_array() ? *meshes : Json::array()) {
      const Json* primitives = at(mesh, {"primitives"});
      for (const Json& primitive :
           primitives && primitives->is_array() ? *primitives : Json::array()) {
        const Json* index = at(primitive, {"material"});
        const bool named = index && index->is_number_unsigned();
        indices.insert(named ? std::min(index->get<std::size_t>(), count) : count);
      }
    }
    return indices;
  }

  void fill(const Json& json, MaterialSettings& settings) {
    const Json* base = at(json, {"pbrMetallicRoughness"});
    const Json none = Json::object();
    const Json& pbr = base ? *base : none;
    settings.albedo = color(at(pbr, {"baseColorFactor"}), Rgb(1), 1);
    settings.metal = number(at(pbr, {"metallicFactor"}), 1, 0, 1);
    settings.roughness = number(at(pbr, {"roughnessFactor"}), 1, 0, 1);
    settings.ior = number(at(json, {"extensions", "KHR_materials_ior", "ior"}), 1.5, 1, 10);
    const auto coat = [&](const char* name) {
      return at(json, {"extensions", "KHR_materials_clearcoat", name});
    };
    settings.coat = number(coat("clearcoatFactor"), 0, 0, 1);
    settings.coat_roughness = number(coat("clearcoatRoughnessFactor"), 0, 0, 1);
    read_texture(at(pbr, {"baseColorTexture", "index"}), settings);
    const Json* strength =
        at(json, {"extensions", "KHR_materials_emissive_strength", "emissiveStrength"});
    const Rgb emission = color(at(json, {"emissiveFactor"}), Rgb(0), 1) *
                         static_cast<float>(number(strength, 1, 0, 1e30));
    const double transmission = number(
        at(json, {"extensions", "KHR_materials_transmission", "transmissionFactor"}), 0, 0, 1);
    if (max_component(emission) > 0)
      become_lamp(emission, settings);
    else if (transmission > 0.5)
      become_glass(settings);
    for (const char* map : {"normalTexture", "occlusionTexture", "emissiveTexture"})
      if (json.contains(map))
        note(fmt::format("its {} are not used", map));
    if (pbr.contains("metallicRoughnessTexture"))
      note("its metallicRoughnessTexture are not used, only the factors");
  }

  static void become_lamp(const Rgb& emission, MaterialSettings& settings) {
    settings = {};
    settings.type = MaterialType::emissive;
    settings.radiance = emission;
  }
  static void become_glass(MaterialSettings& settings) {
    MaterialSettings glass;
    glass.type = MaterialType::dielectric;
    glass.ior = settings.ior;
    glass.roughness = settings.roughness;
    settings = glass;
  }

  /// The image of a texture that lies beside the file.
  void read_texture(const Json* index, MaterialSettings& settings) {
    const Json* texture = element(gltf_, "textures", index);
    const Json* image = texture ? element(gltf_, "images", at(*texture, {"source"})) : nullptr;
    if (!image)
      return;
    const Json* uri = at(*image, {"uri"});
    if (!uri || !uri->is_string() || uri->get<std::string>().starts_with("data:")) {
      note("an image of a base colour lies in the file and is not used: export it as glTF with "
           "separate textures");
      return;
    }
    const std::string file = named_by_uri(
        (std::filesystem::path(path_).parent_path() / uri->get<std::string>()).string());
    const std::string extension = lower_case(std::filesystem::path(file).extension().string());
    if (extension != ".png" && extension != ".exr" && extension != ".hdr") {
      note(fmt::format("its image {} is not used: textures are PNG, EXR or HDR images",
                       as_utf8(uri->get<std::string>())));
      return;
    }
    settings.texture = file;
    const Json* sampler = element(gltf_, "samplers", at(*texture, {"sampler"}));
    const double wrap = sampler ? number(at(*sampler, {"wrapS"}), 10497, 0, 1e5) : 10497;
    settings.texture_wrap = wrap == 33071   ? TextureWrap::clamp
                            : wrap == 33648 ? TextureWrap::mirror
                                            : TextureWrap::repeat;
  }

  void note(const std::string& text) { notes_.insert(text); }

  std::string path_;
  Json gltf_;
  std::set<std::string> notes_;
};

Json to_json(const Rgb& value) {
  return Json::array({value.x, value.y, value.z});
}
Rgb to_rgb(const Json& json) {
  return {json.at(0).get<float>(), json.at(1).get<float>(), json.at(2).get<float>()};
}

/// In the child: what the parent needs of the file.
void parse(const std::string& path, int output) {
  const GltfMaterials materials = MaterialReader(path).read();
  Json result{{"notes", materials.notes}, {"used", Json::array()}};
  for (const GltfMaterial& material : materials.used) {
    const MaterialSettings& s = material.settings;
    result["used"].push_back({{"index", material.index},
                              {"type", s.type.name},
                              {"albedo", to_json(s.albedo.value_or(Rgb(1)))},
                              {"metal", s.metal},
                              {"roughness", s.roughness.value_or(0)},
                              {"ior", s.ior},
                              {"coat", s.coat},
                              {"coat_roughness", s.coat_roughness},
                              {"radiance", to_json(s.radiance)},
                              {"texture", s.texture},
                              {"wrap", static_cast<int>(s.texture_wrap)}});
  }
  const std::string text = result.dump(-1, ' ', false, Json::error_handler_t::replace);
  write_all(output, text.data(), text.size());
}

} // namespace

GltfMaterials read_gltf_materials(const std::string& path) {
  if (!is_gltf_file(path))
    throw InputError(path + ": has no materials to use: give a .gltf or .glb file");
  const std::uint64_t bytes = check_input_file(path);
  GuardLimits limits;
  limits.cpu_seconds = 2 + 5e-6 * static_cast<double>(bytes);
  limits.bytes = std::min(free_memory(), (std::uint64_t(256) << 20) + 200 * bytes);
  const MappedFile file = run_guarded(path, limits, [&](int output) { parse(path, output); });
  const auto* text = reinterpret_cast<const char*>(file.data());
  const Json json = Json::parse(text, text + file.size(), nullptr, false);
  if (json.is_discarded())
    throw FrameError(path + ": the reader returned too little");
  GltfMaterials result;
  result.notes = json.at("notes").get<std::vector<std::string>>();
  for (const Json& one : json.at("used")) {
    GltfMaterial material;
    material.index = one.at("index").get<int>();
    MaterialSettings& s = material.settings;
    for (const MaterialType& type :
         {MaterialType::standard, MaterialType::emissive, MaterialType::dielectric})
      if (one.at("type").get<std::string>() == type.name) // which outlives this text
        s.type = type;
    if (s.type == MaterialType::standard) {
      s.albedo = to_rgb(one.at("albedo"));
      s.texture = one.at("texture").get<std::string>();
      s.texture_wrap = static_cast<TextureWrap>(one.at("wrap").get<int>());
    }
    s.metal = one.at("metal").get<double>();
    if (s.type != MaterialType::emissive)
      s.roughness = one.at("roughness").get<double>();
    s.ior = one.at("ior").get<double>();
    s.coat = one.at("coat").get<double>();
    s.coat_roughness = one.at("coat_roughness").get<double>();
    s.radiance = to_rgb(one.at("radiance"));
    result.used.push_back(material);
  }
  return result;
}

} // namespace vdbeam
