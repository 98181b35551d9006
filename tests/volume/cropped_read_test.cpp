// Reading what lies in a box: the same values there, and little else in memory.
#include "vdb/vdb_reader.h"

#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

/// From -0.1 to 0.1 along each axis, in volumes from -1 to 1.
const WantedBox corner{{Vec3d(-0.1), Vec3d(0.1)}};

float value_at_index(const DensityGrid& grid, const Vec3d& index) {
  return grid.field.sample(Vec3f(index - Vec3d(grid.field.origin())));
}

class CroppedRead : public testing::TestWithParam<const char*> {
protected:
  std::string write(const char* kind) const {
    VolumeOptions options;
    options.size = 96;
    write_volume(kind, folder_.file("v.vdb"), options);
    return folder_.file("v.vdb");
  }
  test::TempFolder folder_;
};

TEST_P(CroppedRead, HasTheSameValuesInTheBox) {
  const std::string path = write(GetParam());
  const DensityGrid whole = read_density_grid(path, "density", {}, Background::ignored),
                    part = read_density_grid(path, "density", {}, Background::ignored, corner);
  EXPECT_EQ(part.index_to_world.rows, whole.index_to_world.rows);
  int positive = 0;
  const Boxd inside = whole.index_to_world.inverse().bounds(corner.world);
  for (double i = std::floor(inside.lower.x); i <= inside.upper.x + 1; ++i)
    for (double j = std::floor(inside.lower.y); j <= inside.upper.y + 1; ++j)
      for (double k = std::floor(inside.lower.z); k <= inside.upper.z + 1; ++k) {
        ASSERT_EQ(value_at_index(part, {i, j, k}), value_at_index(whole, {i, j, k}))
            << i << " " << j << " " << k;
        positive += value_at_index(whole, {i, j, k}) > 0;
      }
  EXPECT_GT(positive, 500);
  EXPECT_LT(part.active_voxels, whole.active_voxels / 2 + 1);
  EXPECT_LT(part.field.bytes(), whole.field.bytes() / 2);
  for (const std::string& note : part.notes)
    EXPECT_EQ(note.find("damaged"), std::string::npos) << note;
}

INSTANTIATE_TEST_SUITE_P(Kinds, CroppedRead,
                         testing::Values("noise", "half", "double", "rotated", "sheared",
                                         "background", "inactive", "bad", "box"),
                         [](const auto& test) { return std::string(test.param); });

class CroppedReadOf : public CroppedRead {};

/// A tile of 64^3 voxels is cut like the rest.
TEST_F(CroppedReadOf, Tiles) {
  const std::string path = write("tiles");
  const DensityGrid whole = read_density_grid(path, "density"),
                    part = read_density_grid(path, "density", {}, Background::refused, corner);
  EXPECT_EQ(value_at_index(part, {0, 0, 0}), value_at_index(whole, {0, 0, 0}));
  EXPECT_EQ(value_at_index(part, {-5, -5, -5}), value_at_index(whole, {-5, -5, -5}));
  EXPECT_LT(part.active_voxels, whole.active_voxels);
}

TEST_F(CroppedReadOf, ABoxBesideTheVolume) {
  const DensityGrid part = read_density_grid(write("noise"), "density", {}, Background::refused,
                                             WantedBox{{Vec3d(5), Vec3d(6)}});
  EXPECT_TRUE(part.field.empty());
  ASSERT_EQ(part.notes.size(), 1u);
  EXPECT_NE(part.notes[0].find("is empty inside the box"), std::string::npos) << part.notes[0];
  EXPECT_FALSE(read_density_grid(write("noise"), "density", {}, Background::refused,
                                 WantedBox{{Vec3d(-1e30), Vec3d(1e30)}})
                   .field.empty());
}

/// The depth of a level set is that of its deepest voxel, wherever that is.
TEST_F(CroppedReadOf, ALevelSetIsReadWhole) {
  const std::string path = write("levelset");
  const DensityGrid whole = read_density_grid(path, "density"),
                    part = read_density_grid(path, "density", {}, Background::refused,
                                             WantedBox{{Vec3d(0.85), Vec3d(0.95)}});
  EXPECT_EQ(part.active_voxels, whole.active_voxels);
  EXPECT_EQ(part.field.bytes(), whole.field.bytes());
}

/// Cut short a file gives an error in one line, or, where the cut is beyond what is wanted, the
/// right values.
TEST_F(CroppedReadOf, FilesThatAreCutShort) {
  const std::string path = write("noise"), bytes = test::read_bytes(path);
  const DensityGrid whole = read_density_grid(path, "density", {}, Background::refused, corner);
  int refused = 0;
  for (const double share : {0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99}) {
    test::write_bytes(
        path, bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
    try {
      const DensityGrid part = read_density_grid(path, "density", {}, Background::refused, corner);
      for (double i = -9; i <= 16; ++i)
        EXPECT_EQ(value_at_index(part, {i, 3, -2}), value_at_index(whole, {i, 3, -2}))
            << share << " " << i;
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GE(refused, 3);
}

} // namespace
} // namespace vdbeam
