#include "geometry/gltf/gltf_materials.h"

#include "geometry/gltf/gltf_camera.h"
#include "geometry/gltf/gltf_json.h"
#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "machine/memory.h"
#include "text/printable.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>
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
      if (index < count) {
        fill((*materials)[index], material);
        drop_textures_without_uvs(index, material.settings);
      } else {
        material.settings.metal = material.settings.roughness.emplace(1);
      }
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
  /// Notes those of primitives without texture coordinates.
  std::set<std::size_t> used(std::size_t count) {
    std::set<std::size_t> indices;
    const Json* meshes = at(gltf_, {"meshes"});
    for (const Json& mesh : meshes && meshes->is_array() ? *meshes : Json::array()) {
      const Json* primitives = at(mesh, {"primitives"});
      for (const Json& primitive :
           primitives && primitives->is_array() ? *primitives : Json::array()) {
        const Json* index = at(primitive, {"material"});
        const bool named = index && index->is_number_unsigned();
        const std::size_t material = named ? std::min(index->get<std::size_t>(), count) : count;
        indices.insert(material);
        if (!at(primitive, {"attributes", "TEXCOORD_0"}))
          lack_uvs_.insert(material);
      }
    }
    return indices;
  }

  void fill(const Json& json, GltfMaterial& material) {
    const Json* base = at(json, {"pbrMetallicRoughness"});
    const Json none = Json::object();
    const Json& pbr = base ? *base : none;
    MaterialSettings& settings = material.settings;
    settings.albedo = color(at(pbr, {"baseColorFactor"}), Rgb(1), 1);
    settings.metal = number(at(pbr, {"metallicFactor"}), 1, 0, 1);
    settings.roughness = number(at(pbr, {"roughnessFactor"}), 1, 0, 1);
    settings.ior = number(at(json, {"extensions", "KHR_materials_ior", "ior"}), 1.5, 1, 10);
    const auto coat = [&](const char* name) {
      return at(json, {"extensions", "KHR_materials_clearcoat", name});
    };
    settings.coat = number(coat("clearcoatFactor"), 0, 0, 1);
    settings.coat_roughness = number(coat("clearcoatRoughnessFactor"), 0, 0, 1);
    use_picture(at(pbr, {"baseColorTexture", "index"}), settings);
    const TextureFile packed = picture_of(at(pbr, {"metallicRoughnessTexture", "index"}));
    set_texture(settings, TextureUse::roughness, packed);
    set_texture(settings, TextureUse::metal, packed);
    set_texture(settings, TextureUse::normal, picture_of(at(json, {"normalTexture", "index"})));
    settings.normal_scale = number(at(json, {"normalTexture", "scale"}), 1, -10, 10);
    use_opacity(json, pbr, settings);
    const double transmission = number(
        at(json, {"extensions", "KHR_materials_transmission", "transmissionFactor"}), 0, 0, 1);
    if (!become_lamp(json, material) && transmission > 0.5)
      become_glass(material);
    note_unused(json, pbr);
  }

  /// Nothing says where textures go on parts without texture coordinates.
  void drop_textures_without_uvs(std::size_t index, MaterialSettings& settings) {
    if (!lack_uvs_.contains(index))
      return;
    for (const TextureUse use : texture_uses) {
      if (texture_file(settings, use).file.empty())
        continue;
      set_texture(settings, use, {});
      note("the textures of parts without texture coordinates (TEXCOORD_0) are not used");
    }
  }

  void note_unused(const Json& json, const Json& pbr) {
    for (const Json* use : {at(pbr, {"baseColorTexture"}), at(json, {"emissiveTexture"}),
                            at(pbr, {"metallicRoughnessTexture"}), at(json, {"normalTexture"})})
      if (use && at(*use, {"extensions", "KHR_texture_transform"}))
        note("its texture transforms are not used");
      else if (use && number(at(*use, {"texCoord"}), 0, 0, 9) > 0)
        note("its second texture coordinates are not used, but the first in their place");
  }

  /// The alpha of the base colour, where the material says that it counts.
  static void use_opacity(const Json& json, const Json& pbr, MaterialSettings& settings) {
    const Json* mode = at(json, {"alphaMode"});
    const bool mask = mode && *mode == "MASK";
    if (!mask && !(mode && *mode == "BLEND"))
      return;
    const double cutoff = mask ? number(at(json, {"alphaCutoff"}), 0.5, 0, 1) : 0;
    if (mask && !(cutoff > 0)) // every alpha reaches it
      return;
    settings.opacity_cutoff = cutoff;
    const Json* color = at(pbr, {"baseColorFactor"});
    if (color && color->is_array() && color->size() > 3)
      settings.opacity = number(&(*color)[3], 1, 0, 1);
    set_texture(settings, TextureUse::opacity, texture_file(settings, TextureUse::color));
  }

  /// Makes a lamp of what glows; false where it does not, or where only parts of something that has
  /// another texture may.
  bool become_lamp(const Json& json, GltfMaterial& material) {
    const Json* strength =
        at(json, {"extensions", "KHR_materials_emissive_strength", "emissiveStrength"});
    const Rgb emission = color(at(json, {"emissiveFactor"}), Rgb(0), 1) *
                         static_cast<float>(number(strength, 1, 0, 1e30));
    const Json* map = at(json, {"emissiveTexture", "index"});
    if (!(max_component(emission) > 0))
      return false;
    if (map && at(json, {"pbrMetallicRoughness", "baseColorTexture"})) {
      note("the glow of materials with an emissiveTexture and a baseColorTexture is not used");
      return false;
    }
    material.settings = {};
    material.settings.type = MaterialType::emissive;
    material.settings.radiance = emission;
    use_picture(map, material.settings);
    return true;
  }
  static void become_glass(GltfMaterial& material) {
    MaterialSettings glass;
    glass.type = MaterialType::dielectric;
    glass.ior = material.settings.ior;
    glass.roughness = material.settings.roughness;
    set_texture(glass, TextureUse::normal, texture_file(material.settings, TextureUse::normal));
    glass.normal_scale = material.settings.normal_scale;
    glass.texture_wrap = material.settings.texture_wrap;
    material.settings = glass;
  }

  /// The picture of a texture; without a file where there is none, or none that can be read.
  TextureFile picture_of(const Json* index) {
    const Json* texture = element(gltf_, "textures", index);
    const Json* source = texture ? at(*texture, {"source"}) : nullptr;
    const Json* image = element(gltf_, "images", source);
    if (!image)
      return {};
    GltfPicture picture = find_gltf_picture(path_, *image, source->get<int>());
    if (!picture.issue.empty())
      note(picture.issue);
    return {picture.file, picture.image};
  }

  void use_picture(const Json* index, MaterialSettings& settings) {
    set_texture(settings, TextureUse::color, picture_of(index));
    const Json* texture = element(gltf_, "textures", index);
    const Json* sampler = texture ? element(gltf_, "samplers", at(*texture, {"sampler"})) : nullptr;
    const double wrap = sampler ? number(at(*sampler, {"wrapS"}), 10497, 0, 1e5) : 10497;
    settings.texture_wrap = wrap == 33071   ? TextureWrap::clamp
                            : wrap == 33648 ? TextureWrap::mirror
                                            : TextureWrap::repeat;
  }

  void note(const std::string& text) { notes_.insert(text); }

  std::string path_;
  Json gltf_;
  std::set<std::size_t> lack_uvs_; ///< materials of primitives without texture coordinates
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
    Json textures = Json::array();
    for (const TextureUse use : texture_uses)
      textures.push_back({texture_file(s, use).file, texture_file(s, use).image});
    result["used"].push_back({{"index", material.index},
                              {"type", s.type.name},
                              {"albedo", to_json(s.albedo.value_or(Rgb(1)))},
                              {"metal", s.metal},
                              {"roughness", s.roughness.value_or(0)},
                              {"ior", s.ior},
                              {"coat", s.coat},
                              {"coat_roughness", s.coat_roughness},
                              {"radiance", to_json(s.radiance)},
                              {"opacity", s.opacity},
                              {"cutoff", s.opacity_cutoff},
                              {"normal_scale", s.normal_scale},
                              {"textures", textures},
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
    if (s.type == MaterialType::standard)
      s.albedo = to_rgb(one.at("albedo"));
    for (std::size_t i = 0; i < texture_uses.size(); ++i) {
      const Json& texture = one.at("textures").at(i);
      set_texture(s, texture_uses[i], {texture.at(0).get<std::string>(), texture.at(1).get<int>()});
    }
    s.texture_wrap = static_cast<TextureWrap>(one.at("wrap").get<int>());
    s.opacity = one.at("opacity").get<double>();
    s.opacity_cutoff = one.at("cutoff").get<double>();
    s.normal_scale = one.at("normal_scale").get<double>();
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
