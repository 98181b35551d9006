#include "support/make_field.h"
#include "support/memory_scene.h"
#include "support/temp_folder.h"
#include "vdb/vector_reader.h"
#include "vdbeam/error.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

Rgb linear(const Vec3d& p) {
  return Rgb(Vec3d{p.x, p.y, p.z} / 16.0);
}

TEST(ColorFieldTest, IsLinearBetweenVoxels) {
  const DensityField shape = test::closed_field({2, 2, 2}, [](int, int, int) { return 1; });
  const ColorField colors(shape, linear);
  for (const Vec3f& p : {Vec3f{0, 0, 0}, Vec3f{3.25f, 7.5f, 15.75f}, Vec3f{8, 8, 8},
                         Vec3f{16, 16, 16}, Vec3f{7.999f, 8.001f, 0.5f}})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(colors.sample(p)[c], linear(Vec3d(p))[c], 1e-6f);
  EXPECT_EQ(colors.bytes(), ColorField::bytes_of(shape));
}

TEST(ColorFieldTest, IsWhiteWhereNothingIs) {
  const DensityField shape = test::closed_field(
      {2, 1, 1}, [](int i, int, int) { return i > 8 ? 1 : 0; }); // the first cell is empty
  const ColorField colors(shape, [](const Vec3d&) { return Rgb(0.5f); });
  EXPECT_EQ(colors.sample({4, 4, 4}), Rgb(1));
  EXPECT_EQ(colors.sample({12, 4, 4}), Rgb(0.5f));
}

class ReadColors : public ::testing::Test {
protected:
  ReadColors() {
    VolumeOptions options;
    options.size = 24;
    write_volume("colored", path_, options);
  }
  static void expect_colors(const Colors& colors) {
    ASSERT_TRUE(colors.field);
    for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(-12, 3, 5), Vec3d(5.5, -7, 11)})
      EXPECT_LT(length(colors.field->sample(p) - Vec3d(0.5 + p.x / 24, 0.25, 0.75)), 1e-6);
  }

  test::TempFolder folder_;
  const std::string path_ = folder_.file("colored.vdb");
};

TEST_F(ReadColors, OneGridOrThree) {
  for (const char* name : {"Cd", "auto", "cd", "tint_r,tint_g,tint_b"}) {
    SCOPED_TRACE(name);
    const Colors colors = read_colors(path_, name);
    expect_colors(colors);
    EXPECT_EQ(colors.limited, 0);
  }
}

TEST_F(ReadColors, BringsThemToUnity) {
  // Densities of 3: too bright; the third component is the same grid as the first.
  VolumeOptions options;
  options.size = 24;
  options.density = 3;
  write_volume("colored", path_, options);
  const Colors colors = read_colors(path_, "density,tint_g,density");
  EXPECT_EQ(colors.limited, 24u * 24 * 24);
  EXPECT_LT(length(colors.field->sample({1, 2, 3}) - Vec3d(1, 0.25, 1)), 1e-6);
}

TEST_F(ReadColors, NamesTheMistake) {
  const auto error = [&](const std::string& name) {
    try {
      read_colors(path_, name);
    } catch (const InputError& problem) {
      const std::string text = problem.what();
      return text.substr(text.find(": ") + 2);
    }
    return std::string();
  };
  EXPECT_EQ(error("density"), "grid \"density\" cannot be a colour: it must hold vectors of three");
  EXPECT_EQ(error("Cd,tint_g,tint_b"), "grid \"Cd\" cannot be a colour: it must hold numbers");
  EXPECT_EQ(error("a,b"), "\"a,b\" cannot be a colour: it must name one grid of vectors, or three "
                          "grids with commas between them");
  EXPECT_NE(error("nothing").find("Cd"), std::string::npos);
  VolumeOptions options;
  options.size = 24;
  write_volume("sphere", path_, options);
  EXPECT_EQ(read_colors(path_, "auto").field, nullptr);
}

} // namespace
} // namespace vdbeam
