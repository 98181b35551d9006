#include "scene_fixture.h"

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
                .find("mesh.0.material.ior does not belong to type \"mirror\", only to dielectric"),
            std::string::npos);
  EXPECT_NE(error_of(path + "[[mesh]]\ntype = 'quad'\nscale = [1, 0, 1]\n")
                .find("mesh.0.scale must not be 0"),
            std::string::npos);
  EXPECT_NE(error_of(path + "[[mesh]]\nfile = 'gone.obj'\n").find("there is no file"),
            std::string::npos);
}

} // namespace
} // namespace vdbeam
