#include "geometry/gltf/gltf_materials.h"

#include "geometry/mesh_reader.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

namespace vdbeam {
namespace {

using test::TempFolder;
using test::write_bytes;

/// A triangle of area 1/2, that many times; each time with what the primitive says.
std::string triangles(const std::vector<std::string>& primitives, const std::string& materials,
                      const std::string& more = "") {
  std::string list;
  for (const std::string& primitive : primitives)
    list += fmt::format(R"({}{{"attributes": {{"POSITION": 1, "TEXCOORD_0": 2}}, "indices": 0{}}})",
                        list.empty() ? "" : ", ", primitive);
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
    "nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{}]}}], "materials": [{}]{},
    "buffers": [{{"byteLength": 44, "uri": "data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA="}}],
    "bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 6, "target": 34963}},
                    {{"buffer": 0, "byteOffset": 8, "byteLength": 36, "target": 34962}}],
    "accessors": [{{"bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR", "max": [2], "min": [0]}},
                  {{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "max": [1, 1, 0], "min": [0, 0, 0]}},
                  {{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}}]}})",
      list, materials, more);
}

TEST(GltfMaterials, FactorsOfTheModel) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf");
  write_bytes(path, triangles({R"(, "material": 2)", R"(, "material": 0)", R"(, "material": 3)",
                               R"(, "material": 4)", ""},
                              R"({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1],
                                  "metallicFactor": 0.25, "roughnessFactor": 0.75},
                                  "extensions": {"KHR_materials_ior": {"ior": 1.4},
                                  "KHR_materials_clearcoat": {"clearcoatFactor": 0.5,
                                  "clearcoatRoughnessFactor": 0.125}}},
                                 {"name": "not used"}, {},
                                 {"emissiveFactor": [1, 0.5, 0], "extensions":
                                  {"KHR_materials_emissive_strength": {"emissiveStrength": 8}}},
                                 {"pbrMetallicRoughness": {"roughnessFactor": 0.1}, "extensions":
                                  {"KHR_materials_transmission": {"transmissionFactor": 1}}})"));
  const GltfMaterials materials = read_gltf_materials(path);
  ASSERT_EQ(materials.used.size(), 5u);
  const MaterialSettings& paint = materials.used[0].settings;
  EXPECT_EQ(materials.used[0].index, 0);
  EXPECT_EQ(paint.type, MaterialType::standard);
  EXPECT_EQ(paint.albedo, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(paint.metal, 0.25);
  EXPECT_EQ(paint.roughness, 0.75);
  EXPECT_EQ(paint.ior, 1.4);
  EXPECT_EQ(paint.coat, 0.5);
  EXPECT_EQ(paint.coat_roughness, 0.125);
  // Without values, and without a material: rough white metal, as glTF has it.
  for (const std::size_t i : {1, 4}) {
    const MaterialSettings& plain = materials.used[i].settings;
    EXPECT_EQ(plain.type, MaterialType::standard);
    EXPECT_EQ(plain.albedo.value_or(Rgb(1)), Rgb(1));
    EXPECT_EQ(plain.metal, 1);
    EXPECT_EQ(plain.roughness, 1);
  }
  EXPECT_EQ(materials.used[1].index, 2);
  EXPECT_EQ(materials.used[4].index, 5);
  EXPECT_EQ(materials.used[2].settings.type, MaterialType::emissive);
  EXPECT_EQ(materials.used[2].settings.radiance, Rgb(8, 4, 0));
  EXPECT_EQ(materials.used[3].settings.type, MaterialType::dielectric);
  EXPECT_EQ(materials.used[3].settings.roughness, 0.1);
  EXPECT_TRUE(materials.notes.empty());
  // The triangles of each.
  EXPECT_EQ(read_mesh(path).triangles.size(), 5u);
  for (const GltfMaterial& material : materials.used)
    EXPECT_NO_THROW(read_mesh(path, {.material = material.index})) << material.index;
  for (const GltfMaterial& material : materials.used)
    EXPECT_EQ(read_mesh(path, {.material = material.index}).triangles.size(), 1u) << material.index;
}

/// Whatever the order in which nodes use materials, with names and without.
TEST(GltfMaterials, TrianglesAreThoseOfTheMaterial) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf");
  for (const auto& names :
       {std::array{"", "", ""}, std::array{"a", "a", "b"}, std::array{"a", "b", "c"}}) {
    std::string text = triangles(
        {}, fmt::format(R"({{"name": "{}"}}, {{"name": "{}"}}, {{"name": "{}"}}, {{"name": "d"}})",
                        names[0], names[1], names[2]));
    const auto replace = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace(R"([{"nodes": [0]}])", R"([{"nodes": [0, 2]}])");
    replace(R"([{"mesh": 0}])", R"([{"mesh": 0, "children": [1]},
      {"mesh": 1, "translation": [10, 0, 0]}, {"mesh": 2, "translation": [20, 0, 0]}])");
    std::string meshes;
    for (const int material : {2, 1, 0})
      meshes += fmt::format(
          R"({}{{"primitives": [{{"attributes": {{"POSITION": 1}}, "indices": 0, "material": {}}}]}})",
          meshes.empty() ? "" : ", ", material);
    replace(R"([{"primitives": []}])", "[" + meshes + "]");
    write_bytes(path, text);
    EXPECT_EQ(read_gltf_materials(path).used.size(), 3u);
    for (const int material : {0, 1, 2})
      EXPECT_NEAR(read_mesh(path, {.material = material}).center.x, 20 - 10 * material + 0.5, 1e-6)
          << names[0] << names[1] << material;
  }
}

TEST(GltfMaterials, TexturesOfTheBaseColour) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf");
  const auto with_image = [&](const std::string& image) {
    write_bytes(path, triangles({R"(, "material": 0)"},
                                R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
                                    "normalTexture": {"index": 0}, "alphaMode": "MASK"})",
                                R"(, "textures": [{"source": 0, "sampler": 0}],
                                    "samplers": [{"wrapS": 33071}], "images": [)" +
                                    image + "]"));
    return read_gltf_materials(path);
  };
  write_bytes(folder.file("my wood.png"), "any");
  const GltfMaterials beside = with_image(R"({"uri": "my%20wood.png"})");
  EXPECT_EQ(beside.used[0].settings.texture, folder.file("my wood.png"));
  EXPECT_EQ(texture_file(beside.used[0].settings, TextureUse::color).image, -1);
  EXPECT_EQ(beside.used[0].settings.texture_wrap, TextureWrap::clamp);
  EXPECT_TRUE(beside.notes.empty());
  for (const char* image : {R"({"bufferView": 0, "mimeType": "image/png"})",
                            R"({"uri": "data:image/jpeg;base64,AAAA"})"}) {
    const GltfMaterials held = with_image(image);
    EXPECT_EQ(held.used[0].settings.texture, path) << image;
    EXPECT_EQ(texture_file(held.used[0].settings, TextureUse::color).image, 0) << image;
    EXPECT_TRUE(held.notes.empty()) << image;
  }
  for (const char* image :
       {R"({"uri": "wood.webp"})", R"({"bufferView": 0, "mimeType": "image/webp"})",
        R"({"uri": "data:image/webp;base64,AAAA"})"}) {
    const GltfMaterials without = with_image(image);
    EXPECT_EQ(without.used[0].settings.texture, "") << image;
    EXPECT_EQ(without.notes.size(), 1u) << image;
  }
}

/// Alpha counts where the material says so; roughness and metal share an image.
TEST(GltfMaterials, TexturesOfOpacityRoughnessAndNormals) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf");
  write_bytes(path, triangles({R"(, "material": 0)", R"(, "material": 1)", R"(, "material": 2)"},
                              R"({"alphaMode": "MASK", "alphaCutoff": 0.25,
                                  "pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                                  "metallicRoughnessTexture": {"index": 1}},
                                  "normalTexture": {"index": 2, "scale": 0.5}},
                                 {"alphaMode": "BLEND",
                                  "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}},
                                 {"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5],
                                  "baseColorTexture": {"index": 0}}})",
                              R"(, "textures": [{"source": 0}, {"source": 1}, {"source": 2}],
                                  "images": [{"uri": "a.png"}, {"uri": "b.png"},
                                             {"uri": "data:image/png;base64,AAAA"}])"));
  const GltfMaterials materials = read_gltf_materials(path);
  ASSERT_EQ(materials.used.size(), 3u);
  const MaterialSettings& leaf = materials.used[0].settings;
  EXPECT_EQ(leaf.opacity, 1);
  EXPECT_EQ(leaf.opacity_cutoff, 0.25);
  EXPECT_EQ(leaf.opacity_texture, folder.file("a.png"));
  EXPECT_EQ(leaf.roughness_texture, folder.file("b.png"));
  EXPECT_EQ(leaf.metal_texture, folder.file("b.png"));
  EXPECT_EQ(texture_file(leaf, TextureUse::normal), (TextureFile{path, 2}));
  EXPECT_EQ(leaf.normal_scale, 0.5);
  const MaterialSettings& veil = materials.used[1].settings;
  EXPECT_EQ(veil.opacity, 0.5);
  EXPECT_EQ(veil.opacity_cutoff, 0);
  EXPECT_EQ(veil.opacity_texture, "");
  const MaterialSettings& opaque = materials.used[2].settings;
  EXPECT_EQ(opaque.opacity, 1);
  EXPECT_EQ(opaque.opacity_texture, "");
}

/// What glows by a texture alone is a lamp; what has other textures too is not, and says so.
/// The part without texture coordinates does without the texture, the other one has it.
TEST(GltfMaterials, PartsWithoutTextureCoordinates) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf");
  std::string text = triangles({R"(, "material": 0)", R"(, "material": 1)"},
                               R"({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1],
                                   "baseColorTexture": {"index": 0}}, "normalTexture": {"index": 0}},
                                  {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})",
                               R"(, "textures": [{"source": 0}], "images": [{"uri": "a.png"}])");
  write_bytes(folder.file("a.png"), "");
  const std::string uvs = R"(, "TEXCOORD_0": 2)";
  text.erase(text.find(uvs), uvs.size());
  write_bytes(path, text);
  const GltfMaterials materials = read_gltf_materials(path);
  ASSERT_EQ(materials.used.size(), 2u);
  EXPECT_EQ(texture_file(materials.used[0].settings, TextureUse::color), TextureFile());
  EXPECT_EQ(texture_file(materials.used[0].settings, TextureUse::normal), TextureFile());
  EXPECT_EQ(materials.used[0].settings.albedo, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(texture_file(materials.used[1].settings, TextureUse::color).file, folder.file("a.png"));
  ASSERT_EQ(materials.notes.size(), 1u);
  EXPECT_NE(materials.notes[0].find("TEXCOORD_0"), std::string::npos);
}

TEST(GltfMaterials, TexturesOfEmission) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf");
  write_bytes(path, triangles({R"(, "material": 0)", R"(, "material": 1)"},
                              R"({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}},
                                 {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
                                  "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})",
                              R"(, "textures": [{"source": 0}], "images": [{"uri": "a.png"}])"));
  const GltfMaterials materials = read_gltf_materials(path);
  EXPECT_EQ(materials.used[0].settings.type, MaterialType::emissive);
  EXPECT_EQ(materials.used[0].settings.texture, folder.file("a.png"));
  EXPECT_EQ(materials.used[1].settings.type, MaterialType::standard);
  EXPECT_EQ(materials.notes.size(), 1u);
}

TEST(GltfMaterials, WhatIsWrongIsSaid) {
  const TempFolder folder;
  write_bytes(folder.file("a.gltf"), "no JSON");
  EXPECT_THROW(read_gltf_materials(folder.file("a.gltf")), FrameError);
  EXPECT_THROW(read_gltf_materials(folder.file("a.obj")), InputError);
  // Values of other kinds count as missing.
  write_bytes(folder.file("b.gltf"),
              triangles({R"(, "material": 0)", R"(, "material": 77)", R"(, "material": "x")"},
                        R"({"pbrMetallicRoughness": {"baseColorFactor": [2, -1], "metallicFactor":
                            "much", "baseColorTexture": {"index": 9}}, "extensions": [],
                            "emissiveFactor": 3})"));
  const GltfMaterials odd = read_gltf_materials(folder.file("b.gltf"));
  ASSERT_EQ(odd.used.size(), 2u);
  EXPECT_EQ(odd.used[0].settings.albedo, Rgb(1));
  EXPECT_EQ(odd.used[0].settings.metal, 1);
}

} // namespace
} // namespace vdbeam
