#include "volume_factory.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

namespace vdbeam {
namespace {

namespace fs = std::filesystem;
using openvdb::FloatGrid;

/// A folder of this process alone, removed at the end.
class CloudVolumes : public testing::TestWithParam<const char*> {
protected:
  CloudVolumes() : folder_(fs::path(testing::TempDir()) / ("clouds" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~CloudVolumes() override { fs::remove_all(folder_); }

  FloatGrid::Ptr make(const VolumeOptions& options) const {
    const std::string path = folder_ / "cloud.vdb";
    write_volume(GetParam(), path, options);
    openvdb::io::File file(path);
    file.open();
    const auto grid = openvdb::gridPtrCast<FloatGrid>(file.readGrid("density"));
    saved_as_half_ = grid->saveFloatAsHalf();
    return grid;
  }

  fs::path folder_;
  mutable bool saved_as_half_ = false;
};

/// A field needs more voxels than one cloud: its clouds are a fiftieth of it wide.
VolumeOptions small(const std::string& kind) {
  VolumeOptions options;
  options.size = kind == "field" ? 384 : 96;
  options.density = 2;
  options.extent = 30;
  return options;
}

/// Sum of the densities, each with a weight of its place, so that no two clouds share it by chance.
double fingerprint(const FloatGrid& grid) {
  double sum = 0;
  for (auto value = grid.cbeginValueOn(); value; ++value) {
    const openvdb::Coord c = value.getCoord();
    sum += *value * (1 + 0.01 * c.x() + 0.0173 * c.y() + 0.0311 * c.z());
  }
  return sum;
}

TEST_P(CloudVolumes, StandOnTheGroundWithinTheirExtent) {
  const int size = small(GetParam()).size, reach = size * 7 / 12;
  const FloatGrid::Ptr grid = make(small(GetParam()));
  const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
  EXPECT_GT(grid->activeVoxelCount(), 1000u);
  EXPECT_DOUBLE_EQ(grid->voxelSize().x(), 30.0 / size);
  EXPECT_GE(box.min().y(), 0);
  EXPECT_LE(box.min().y(), 8);
  EXPECT_GE(box.min().x(), -reach);
  EXPECT_LE(box.max().x(), reach);
  EXPECT_GT(box.dim().x(), size * 5 / 8);
}

TEST_P(CloudVolumes, HaveDensitiesUpToTheOneAskedFor) {
  const FloatGrid::Ptr grid = make(small(GetParam()));
  float greatest = 0, least = 1e9f;
  for (auto value = grid->cbeginValueOn(); value; ++value) {
    greatest = std::max(greatest, *value);
    least = std::min(least, *value);
  }
  EXPECT_GT(greatest, 1.5f);
  EXPECT_LE(greatest, 2.0f);
  EXPECT_GE(least, 0.0079f); // 0.004 of the density, as a half float
  EXPECT_TRUE(saved_as_half_);
}

TEST_P(CloudVolumes, AreTheSameForTheSameSeedAndOthersForOthers) {
  VolumeOptions options = small(GetParam());
  const double first = fingerprint(*make(options));
  EXPECT_EQ(fingerprint(*make(options)), first);
  options.seed = 2;
  const double second = fingerprint(*make(options));
  EXPECT_GT(std::abs(second - first), 0.001 * std::abs(first));
}

/// A border is not a step: between emptiness and the greatest density there are voxels of all
/// densities, so that light enters softly.
TEST_P(CloudVolumes, HaveSoftBorders) {
  const FloatGrid::Ptr grid = make(small(GetParam()));
  std::array<int, 4> counts{};
  for (auto value = grid->cbeginValueOn(); value; ++value)
    ++counts[std::min(static_cast<std::size_t>(2 * *value), std::size_t{3})];
  for (const int count : counts)
    EXPECT_GT(count, 40);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CloudVolumes,
                         testing::Values("cumulus", "storm", "field", "fogbank"));

} // namespace
} // namespace vdbeam
