#include "vdb/vdb_reader.h"

#include "support/temp_folder.h"
#include "vdb/summary_codec.h"
#include "vdbeam/error.h"
#include "volume_factory.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <filesystem>

namespace vdbeam {
namespace {

class Summary : public ::testing::Test {
protected:
  std::vector<GridSummary> summarize(const std::string& kind) {
    VolumeOptions options;
    options.size = 32;
    path_ = folder_.file(kind + ".vdb");
    write_volume(kind, path_, options);
    return summarize_vdb(path_);
  }
  test::TempFolder folder_;
  std::string path_;
};

TEST_F(Summary, agrees_with_OpenVDB) {
  const GridSummary summary = summarize("sheared").at(0);
  openvdb::io::File file(path_);
  file.open(false);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  EXPECT_EQ(summary.name, "density");
  EXPECT_EQ(summary.value_type, "float");
  EXPECT_EQ(summary.grid_class, "Fog Volume");
  EXPECT_EQ(summary.map_type, "AffineMap");
  EXPECT_EQ(summary.active_voxels, grid->activeVoxelCount());
  EXPECT_EQ(summary.leaf_count, grid->tree().leafCount());
  EXPECT_EQ(summary.tile_count, 0u);
  const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
  EXPECT_EQ(summary.index_lower.x, box.min().x());
  EXPECT_EQ(summary.index_upper.z, box.max().z());
  EXPECT_DOUBLE_EQ(summary.voxel_size[1], grid->voxelSize()[1]);
  const openvdb::Vec3d corner = grid->indexToWorld(openvdb::Vec3d(1, 2, 3));
  EXPECT_NEAR(summary.index_to_world.point({1, 2, 3}).x, corner.x(), 1e-15);
  EXPECT_GT(summary.maximum, summary.mean);
  EXPECT_GT(summary.mean, summary.minimum);
  EXPECT_GT(summary.minimum, 0);
  EXPECT_LT(summary.world_bounds.lower.x, -0.5);
  EXPECT_GT(summary.world_bounds.upper.x, 0.5);
}

TEST_F(Summary, constant_volumes) {
  const GridSummary box = summarize("box").at(0);
  EXPECT_EQ(box.active_voxels, 32u * 32 * 32);
  EXPECT_EQ(box.mean, 1);
  EXPECT_EQ(box.world_bounds.lower, Vec3d(-1));
  const GridSummary tiles = summarize("tiles").at(0);
  EXPECT_EQ(tiles.leaf_count, 0u);
  EXPECT_EQ(tiles.tile_count, 64u);
  EXPECT_EQ(tiles.active_voxels, 64u * 512);
}

TEST_F(Summary, counts_bad_values) {
  const GridSummary summary = summarize("bad").at(0);
  EXPECT_EQ(summary.bad_values.nan, 1u);
  EXPECT_EQ(summary.bad_values.infinite, 2u);
  EXPECT_EQ(summary.bad_values.negative, 515u);
  EXPECT_EQ(summary.minimum, -1);
}

TEST_F(Summary, every_kind_of_grid) {
  for (const VolumeKind& kind : volume_kinds())
    EXPECT_GE(summarize(kind.name).size(), 1u) << kind.name;
  const auto grids = summarize("simulation");
  ASSERT_EQ(grids.size(), 3u);
  EXPECT_EQ(grids[2].name, "velocity");
  EXPECT_EQ(grids[2].value_type, "vec3s");
  const auto doubles = summarize("duplicates");
  ASSERT_EQ(doubles.size(), 2u);
  EXPECT_EQ(doubles[1].name, "density[1]");
  EXPECT_EQ(summarize("half").at(0).value_type, "half");
  const GridSummary level_set = summarize("levelset").at(0);
  EXPECT_EQ(level_set.grid_class, "Level Set");
  EXPECT_LT(level_set.minimum, 0);
  EXPECT_EQ(level_set.bad_values.negative, 0u) << "its inside is not a mistake";
  EXPECT_EQ(summarize("frustum").at(0).map_type, "NonlinearFrustumMap");
  EXPECT_EQ(summarize("background").at(0).background, 0.25);
  const GridSummary empty = summarize("empty").at(0);
  EXPECT_EQ(empty.active_voxels, 0u);
  EXPECT_GT(empty.index_lower.x, empty.index_upper.x);
  EXPECT_TRUE(empty.world_bounds.empty());
}

TEST_F(Summary, codec_keeps_all_and_refuses_rubbish) {
  const GridSummary summary = summarize("rotated").at(0);
  const std::vector<std::uint8_t> bytes = encode_summary(summary);
  const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
  EXPECT_EQ(encode_summary(decode_summary("label", data, bytes.size())), bytes);
  EXPECT_THROW(decode_summary("label", data, bytes.size() / 2), FrameError);
  EXPECT_THROW(decode_summary("label", data, 0), FrameError);
}

TEST_F(Summary, headers_tell_the_same) {
  for (const char* kind : {"sheared", "tiles", "noise", "far", "empty"}) {
    const GridSummary full = summarize(kind).at(0);
    const GridSummary header = read_grid_header(path_, "density");
    SCOPED_TRACE(kind);
    EXPECT_EQ(header.active_voxels, full.active_voxels);
    EXPECT_EQ(header.index_lower, full.index_lower);
    EXPECT_EQ(header.index_upper, full.index_upper);
    EXPECT_EQ(header.world_bounds.lower, full.world_bounds.lower);
    EXPECT_EQ(header.world_bounds.upper, full.world_bounds.upper);
    EXPECT_EQ(header.value_type, full.value_type);
    EXPECT_EQ(header.map_type, full.map_type);
    EXPECT_EQ(header.leaf_count + header.tile_count, 0u); // nobody looked
  }
}

/// A header is read also where the voxels after it are cut off.
TEST_F(Summary, headers_need_no_voxels) {
  const GridSummary full = summarize("noise").at(0);
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
  EXPECT_THROW(read_density_grid(path_, "density"), FrameError);
  EXPECT_EQ(read_grid_header(path_, "density").active_voxels, full.active_voxels);
}

TEST_F(Summary, headers_without_statistics) {
  const GridSummary full = summarize("noise").at(0);
  openvdb::io::File file(path_);
  file.open(false);
  const openvdb::GridPtrVec grids{file.readGrid("density")};
  const std::string bare = folder_.file("bare.vdb");
  openvdb::io::File out(bare);
  out.setGridStatsMetadataEnabled(false);
  grids[0]->removeMeta(openvdb::GridBase::META_FILE_VOXEL_COUNT);
  out.write(grids);
  out.close();
  const GridSummary header = read_grid_header(bare, "density");
  EXPECT_EQ(header.active_voxels, full.active_voxels);
  EXPECT_GT(header.leaf_count, 0u);
}

TEST_F(Summary, headers_of_what_cannot_be_rendered_are_refused) {
  summarize("vector");
  EXPECT_THROW(read_grid_header(path_, "density"), InputError);
  EXPECT_THROW(read_grid_header(path_, "flame"), InputError);
  EXPECT_THROW(read_grid_header(folder_.file("none.vdb"), "density"), InputError);
}

} // namespace
} // namespace vdbeam
