#include "scene_fixture.h"

#include "support/gltf.h"

namespace vdbeam {
namespace {

class MeshKeys : public test::SceneTest {};

TEST_F(MeshKeys, ShapesAndMaterials) {
  const Scene scene = load("[render]\nestimator = 'path'\n"
                           "[[mesh]]\ntype = 'sphere'\nscale = 2\ntranslate = [1, 2, 3]\n"
                           "material = { type = 'dielectric', ior = 1.33 }\n"
                           "[[mesh]]\ntype = 'quad'\nmaterial = 'mirror'\nvisible = false\n");
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_EQ(scene.surfaces[0].shape, SurfaceShape::sphere);
  EXPECT_EQ(scene.surfaces[0].material.ior, 1.33);
  EXPECT_EQ(scene.surfaces[0].transform,
            (std::array<double, 12>{2, 0, 0, 1, 0, 2, 0, 2, 0, 0, 2, 3}));
  EXPECT_EQ(scene.surfaces[1].material.type, MaterialType::mirror);
  EXPECT_FALSE(scene.surfaces[1].visible);
}

TEST_F(MeshKeys, Complaints) {
  const std::string path = "[render]\nestimator = 'path'\n";
  EXPECT_NE(error_of(path + "[[mesh]]\n").find("mesh.0 needs a file, or a type that needs none"),
            std::string::npos);
  EXPECT_NE(error_of(path + "[[mesh]]\ntype = 'quad'\nmaterial = { type = 'mirror', ior = 2 }\n")
                .find("mesh.0.material.ior does not belong to type \"mirror\", only to standard "
                      "and dielectric"),
            std::string::npos);
  EXPECT_NE(error_of(path + "[[mesh]]\ntype = 'quad'\nscale = [1, 0, 1]\n")
                .find("mesh.0.scale must not be 0"),
            std::string::npos);
  EXPECT_NE(error_of(path + "[[mesh]]\nfile = 'gone.obj'\n").find("there is no file"),
            std::string::npos);
}

/// Animated nodes of a glTF follow the frame; files without an animation are the same in all
/// frames.
TEST_F(MeshKeys, AnimationOfTheFile) {
  write("a.gltf", test::moving_triangle("LINEAR"));
  write("b.gltf", R"({"meshes": []})");
  write("s.toml", "[[mesh]]\nfile = 'a.gltf'\nfile_fps = 12\n[[mesh]]\nfile = 'b.gltf'\n");
  const Scene scene = load_scene(file("s.toml"), FrameTime{18, 18.5});
  EXPECT_NEAR(scene.surfaces[0].file_seconds.value_or(0), 18.5 / 12, 1e-12);
  EXPECT_FALSE(scene.surfaces[1].file_seconds.has_value());
  // An open shutter sees it at several times.
  const Scene blurred = load_scene(file("s.toml"), 18, {"camera.shutter_close=1"});
  ASSERT_FALSE(blurred.moments.empty());
  EXPECT_GT(blurred.moments.back().surfaces[0].file_seconds.value_or(0),
            blurred.moments.front().surfaces[0].file_seconds.value_or(0) + 0.5 / 12);
  EXPECT_NE(scene_hash(scene), scene_hash(load_scene(file("s.toml"), 19)));
}

/// A surface for each material of the file; the first has the mesh's number.
TEST_F(MeshKeys, MaterialsOfTheFile) {
  write("a.gltf", R"({"meshes": [{"primitives": [{"material": 1}, {"material": 0}, {}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}},
                  {"emissiveFactor": [1, 1, 1]}]})");
  const std::string mesh = "[[mesh]]\nfile = 'a.gltf'\nfile_materials = true\ngroup = 'lamp'\n"
                           "file_axes = 'y_up_to_z_up'\n";
  const Scene scene = load(mesh + "[[mesh]]\ntype = 'sphere'\n");
  ASSERT_EQ(scene.surfaces.size(), 4u);
  EXPECT_EQ(scene.surfaces[0].part, 0);
  EXPECT_EQ(scene.surfaces[0].material.albedo, Rgb(1, 0, 0));
  EXPECT_EQ(scene.surfaces[0].file_axes, FileAxes::y_up_to_z_up);
  EXPECT_EQ(scene.surfaces[0].group, "");
  EXPECT_EQ(scene.surfaces[1].shape, SurfaceShape::sphere);
  EXPECT_EQ(scene.surfaces[1].part, -1);
  EXPECT_EQ(scene.surfaces[2].material.type, MaterialType::emissive);
  EXPECT_EQ(scene.surfaces[2].group, "lamp");
  EXPECT_EQ(scene.surfaces[3].part, 2);
  for (const std::size_t i : {0, 2, 3})
    EXPECT_EQ(scene.surfaces[i].name, "mesh0");
  EXPECT_EQ(error_of(mesh + "material = 'mirror'\n"),
            "s.toml:3: mesh.0.file_materials excludes mesh.0.material: write one or the other");
  write("a.obj", "v 0 0 0\n");
  EXPECT_EQ(error_of("[[mesh]]\nfile = 'a.obj'\nfile_materials = true\n"),
            "s.toml:3: mesh.0.file_materials needs a .gltf or .glb file, got a.obj");
  write("b.gltf", "nothing");
  EXPECT_EQ(error_of("[[mesh]]\nfile = 'b.gltf'\nfile_materials = true\n"),
            "s.toml:2: mesh.0.file: b.gltf: is no readable glTF");
}

} // namespace
} // namespace vdbeam
