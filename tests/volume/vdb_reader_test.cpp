#include "vdb/vdb_reader.h"

#include "machine/guarded_process.h"
#include "support/temp_folder.h"
#include "vdb/vdb_parse.h"
#include "volume_factory.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <tbb/task_arena.h>

#include <fcntl.h>

#include <cmath>
#include <cstring>
#include <random>
#include <thread>

namespace vdbeam {
namespace {

/// What OpenVDB itself makes of a file, mended by the plainest code.
openvdb::FloatGrid::Ptr reference_grid(const std::string& path, const std::string& name) {
  openvdb::io::File file(path);
  file.open(false);
  const openvdb::GridBase::Ptr base = file.readGrid(name);
  if (base->isType<openvdb::DoubleGrid>()) {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create();
    grid->setTransform(base->transformPtr());
    const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(base);
    for (auto value = doubles->cbeginValueOn(); value; ++value)
      grid->tree().setValue(value.getCoord(), static_cast<float>(value.getValue()));
    return grid;
  }
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
  if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
    openvdb::tools::sdfToFogVolume(*grid);
  for (auto value = grid->beginValueAll(); value; ++value)
    if (!std::isfinite(*value) || *value < 0)
      value.setValue(0);
  return grid;
}

openvdb::CoordBBox box_of_density(const openvdb::FloatGrid& grid) {
  openvdb::CoordBBox box;
  for (auto value = grid.cbeginValueAll(); value; ++value)
    if (*value > 0)
      box.expand(value.getBoundingBox());
  return box;
}

/// Index coordinates around the grid's values, a third of them on or next to lattice planes; all
/// are multiples of 2^-10, so that both sides compute with the same numbers.
class Points {
public:
  explicit Points(const openvdb::CoordBBox& box) : box_(box) {}

  openvdb::Vec3d next() {
    openvdb::Vec3d point;
    for (int axis = 0; axis < 3; ++axis) {
      std::uniform_int_distribution<int> whole(box_.min()[axis] - 12, box_.max()[axis] + 12);
      std::uniform_int_distribution<int> fraction(0, 1023), kind(0, 2);
      constexpr int edges[] = {0, 0, 1, 1023};
      const int part = kind(random_) == 0 ? edges[fraction(random_) % 4] : fraction(random_);
      point[axis] = whole(random_) + part / 1024.0;
    }
    return point;
  }

private:
  openvdb::CoordBBox box_;
  std::mt19937 random_{7};
};

struct Case {
  std::string kind;
  int size;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.kind << c.size;
}

class ReadKind : public ::testing::TestWithParam<Case> {
protected:
  void SetUp() override {
    VolumeOptions options;
    options.size = GetParam().size;
    options.density = 1.5;
    path_ = folder_.file("volume.vdb");
    write_volume(GetParam().kind, path_, options);
    grid_ = read_density_grid(path_, "density");
    // OpenVDB warns where several grids have the name that is asked for.
    const bool is_one_of_two = GetParam().kind == "duplicates";
    reference_ = reference_grid(path_, is_one_of_two ? "density[0]" : "density");
  }

  test::TempFolder folder_;
  std::string path_;
  DensityGrid grid_;
  openvdb::FloatGrid::Ptr reference_;
};

TEST_P(ReadKind, samples_equal_OpenVDBs) {
  const openvdb::CoordBBox box = box_of_density(*reference_);
  Points points(box);
  const Vec3<std::int64_t> origin = grid_.field.origin();
  const float tolerance = 1e-6f * grid_.field.maximum();
  int inside = 0;
  for (int n = 0; n < 20000; ++n) {
    const openvdb::Vec3d at = points.next();
    const float expected = openvdb::tools::BoxSampler::sample(reference_->tree(), at);
    const Vec3d local = Vec3d(at.x(), at.y(), at.z()) - Vec3d(origin);
    ASSERT_NEAR(grid_.field.sample(Vec3f(local)), expected, tolerance) << at;
    if (expected > 0) {
      ++inside;
      const Boxf& bounds = grid_.field.occupied();
      const Vec3f p(local);
      ASSERT_TRUE(p.x > bounds.lower.x && p.x < bounds.upper.x) << at;
      ASSERT_TRUE(p.y > bounds.lower.y && p.y < bounds.upper.y) << at;
      ASSERT_TRUE(p.z > bounds.lower.z && p.z < bounds.upper.z) << at;
    }
  }
  EXPECT_GT(inside, 5);
}

TEST_P(ReadKind, transform_equals_OpenVDBs) {
  Points points({openvdb::Coord(-100), openvdb::Coord(100)});
  for (int n = 0; n < 100; ++n) {
    const openvdb::Vec3d at = points.next();
    const openvdb::Vec3d expected = reference_->indexToWorld(at);
    const Vec3d world = grid_.index_to_world.point({at.x(), at.y(), at.z()});
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(world[axis], expected[axis], 1e-14 * (10 + std::abs(expected[axis])));
  }
}

std::vector<Case> readable_kinds() {
  std::vector<Case> cases{{"tiles", 256}, {"noise", 41}, {"box", 7}};
  for (const char* kind : {"sphere", "box", "slab", "ramp", "noise", "spikes", "tiles", "voxel",
                           "half", "double", "rotated", "sheared", "mirrored", "anisotropic", "far",
                           "levelset", "bad", "duplicates", "inactive"})
    cases.push_back({kind, 32});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Volume, ReadKind, ::testing::ValuesIn(readable_kinds()),
                         [](const auto& c) { return c.param.kind + std::to_string(c.param.size); });

class ReadVolume : public ::testing::Test {
protected:
  std::string make(const std::string& kind, int size = 24) {
    VolumeOptions options;
    options.size = size;
    const std::string path = folder_.file(kind + ".vdb");
    write_volume(kind, path, options);
    return path;
  }
  test::TempFolder folder_;
};

TEST_F(ReadVolume, counts_and_reports_what_it_mends) {
  const std::string path = make("bad");
  const DensityGrid grid = read_density_grid(path, "density");
  EXPECT_EQ(grid.repairs.nan, 1u);
  EXPECT_EQ(grid.repairs.infinite, 2u);
  EXPECT_EQ(grid.repairs.negative, 3u + 512u) << "three voxels and a tile";
  ASSERT_EQ(grid.notes.size(), 1u);
  EXPECT_EQ(grid.notes[0], path + ": grid \"density\": values replaced by 0: 1 NaN, 2 infinite, "
                                  "515 negative");
}

TEST_F(ReadVolume, says_that_a_level_set_was_converted) {
  const std::string path = make("levelset");
  const DensityGrid grid = read_density_grid(path, "density");
  ASSERT_EQ(grid.notes.size(), 1u);
  EXPECT_EQ(grid.notes[0], path + ": grid \"density\": is a level set, made a fog volume");
  EXPECT_EQ(grid.field.maximum(), 1);
}

TEST_F(ReadVolume, a_good_file_needs_no_notes) {
  for (const char* kind : {"noise", "tiles", "half", "double", "sheared"})
    EXPECT_TRUE(read_density_grid(make(kind), "density").notes.empty()) << kind;
}

TEST_F(ReadVolume, reads_each_grid_of_one_name) {
  const std::string path = make("duplicates");
  const float cloud = read_density_grid(path, "density").field.maximum();
  EXPECT_LT(cloud, 1);
  EXPECT_EQ(read_density_grid(path, "density[0]").field.maximum(), cloud);
  EXPECT_EQ(read_density_grid(path, "density[1]").field.maximum(), 2);
}

TEST_F(ReadVolume, empty_grids_are_empty_fields) {
  const std::vector<std::string> paths{make("empty"),
                                       VDBEAM_SOURCE_DIR "/data/smoke/smoke.0001.vdb"};
  for (const std::string& path : paths) {
    const DensityGrid grid = read_density_grid(path, "density");
    EXPECT_TRUE(grid.field.empty());
    EXPECT_EQ(grid.active_voxels, 0u);
    ASSERT_EQ(grid.notes.size(), 1u);
    EXPECT_EQ(grid.notes[0], path + ": grid \"density\": is empty, nothing to render");
  }
}

TEST_F(ReadVolume, reads_the_sample_volumes) {
  for (const char* name :
       {"cloud.vdb", "smoke/smoke.0012.vdb", "smoke/smoke.0024.vdb", "fire/fire.0018.vdb"}) {
    const std::string path = std::string(VDBEAM_SOURCE_DIR "/data/") + name;
    const DensityGrid grid = read_density_grid(path, "density");
    const openvdb::FloatGrid::Ptr reference = reference_grid(path, "density");
    EXPECT_EQ(grid.active_voxels, reference->activeVoxelCount());
    Points points(box_of_density(*reference));
    for (int n = 0; n < 5000; ++n) {
      const openvdb::Vec3d at = points.next();
      const Vec3d local = Vec3d(at.x(), at.y(), at.z()) - Vec3d(grid.field.origin());
      ASSERT_NEAR(grid.field.sample(Vec3f(local)),
                  openvdb::tools::BoxSampler::sample(reference->tree(), at),
                  1e-6f * grid.field.maximum());
    }
  }
}

TEST_F(ReadVolume, notes_a_wrong_voxel_count) {
  const std::string path = make("noise");
  std::string bytes = test::read_bytes(path);
  const std::size_t at = bytes.find("file_voxel_count");
  ASSERT_NE(at, std::string::npos);
  bytes[bytes.find("int64", at) + 9] ^= 1; // behind the type's name and the value's size
  test::write_bytes(path, bytes);
  const DensityGrid grid = read_density_grid(path, "density");
  ASSERT_EQ(grid.notes.size(), 1u);
  EXPECT_NE(grid.notes[0].find("it may be damaged"), std::string::npos);
}

/// Whether the thread that calls this has run anything through TBB.
bool has_entered_tbb() {
  return tbb::this_task_arena::current_thread_index() != tbb::task_arena::not_initialized;
}

/// In the forked child TBB may be locked for ever: a grid that was destroyed there hung one read in
/// hundreds. A thread of its own, since this one has written a grid through TBB.
TEST_F(ReadVolume, parsing_never_enters_tbb) {
  const std::string path = make("noise");
  char entered[] = {1, 1, 1};
  std::thread reader([&] {
    const GuardLimits ample{30, 30, std::uint64_t(1) << 30};
    const MappedFile answer = run_guarded(path, ample, [&](int output) {
      const Descriptor null(::open("/dev/null", O_WRONLY));
      entered[0] = has_entered_tbb();
      write_raw_grid(path, "density", Background::refused, {}, null.get());
      write_raw_grid(path, "density", Background::refused, WantedBox{{Vec3d(0), Vec3d(0.5)}},
                     null.get());
      entered[1] = has_entered_tbb();
      write_summary(path, "density", null.get());
      entered[2] = has_entered_tbb();
      write_all(output, entered, sizeof entered);
    });
    ASSERT_EQ(answer.size(), sizeof entered);
    std::memcpy(entered, answer.data(), sizeof entered);
  });
  reader.join();
  EXPECT_FALSE(entered[0]);
  EXPECT_FALSE(entered[1]);
  EXPECT_FALSE(entered[2]);
}

} // namespace
} // namespace vdbeam
