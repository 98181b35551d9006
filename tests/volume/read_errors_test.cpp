#include "vdb/vdb_reader.h"

#include "support/temp_folder.h"
#include "vdb/vdb_names.h"
#include "vdbeam/error.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

class ReadErrors : public ::testing::Test {
protected:
  std::string make(const std::string& kind) {
    VolumeOptions options;
    options.size = 16;
    const std::string path = folder_.file(kind + ".vdb");
    write_volume(kind, path, options);
    return path;
  }
  /// The line of the InputError that reading `grid` must throw, without the path it begins with.
  std::string refusal(const std::string& path, const std::string& grid = "density") {
    try {
      read_density_grid(path, grid);
    } catch (const InputError& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find(path), 0u) << line;
      EXPECT_EQ(line.find('\n'), line.npos) << line;
      return line.substr(std::min(path.size(), line.size()));
    }
    ADD_FAILURE() << path << ": no InputError";
    return "";
  }
  test::TempFolder folder_;
};

TEST_F(ReadErrors, missing_and_unreadable_files) {
  EXPECT_EQ(refusal(folder_.file("no.vdb")), ": No such file or directory");
  EXPECT_EQ(refusal("/tmp"), ": is a folder, not a regular file");
  EXPECT_EQ(refusal("/dev/zero"), ": is a device, not a regular file");
  test::write_bytes(folder_.file("text.vdb"), "a text, not a volume");
  EXPECT_EQ(refusal(folder_.file("text.vdb")), ": is not a VDB file");
}

TEST_F(ReadErrors, empty_files_may_still_be_copied) {
  const std::string path = folder_.file("empty.vdb");
  test::write_bytes(path, "");
  try {
    read_density_grid(path, "density");
    FAIL();
  } catch (const FrameError& error) { // trying again may help
    EXPECT_EQ(error.what(), path + ": is empty (0 bytes): perhaps it is still being copied");
  }
}

TEST_F(ReadErrors, missing_grids) {
  EXPECT_EQ(refusal(make("noise"), "flame"), ": has no grid \"flame\"; it holds \"density\"");
  EXPECT_EQ(
      refusal(make("simulation"), "temprature"),
      ": has no grid \"temprature\"; it holds \"density\", \"temperature\", \"velocity\"; did "
      "you mean \"temperature\"?");
  EXPECT_EQ(refusal(make("duplicates"), "density[2]"),
            ": has no grid \"density[2]\"; it holds \"density[0]\", \"density[1]\"; did you mean "
            "\"density[0]\"?");
}

TEST_F(ReadErrors, capitals_do_not_matter_where_one_grid_is_meant) {
  const std::string path = make("noise");
  EXPECT_EQ(read_density_grid(path, "Density").active_voxels,
            read_density_grid(path, "density").active_voxels);
  EXPECT_EQ(read_grid_header(path, "DENSITY").name, "density");
  EXPECT_EQ(same_grid_name("Flame", {"flame", "Flame"}), "Flame");
  EXPECT_EQ(same_grid_name("FLAME", {"flame", "Flame"}), ""); // which one?
  EXPECT_EQ(same_grid_name("fire", {"flame"}), "");
}

TEST_F(ReadErrors, long_lists_of_grids_are_cut) {
  std::vector<std::string> names;
  for (int i = 0; i < 30; ++i)
    names.push_back("grid" + std::to_string(i));
  const std::string line = missing_grid_message("x.vdb", "density", names);
  EXPECT_NE(line.find("\"grid19\" and 10 more"), line.npos) << line;
  EXPECT_EQ(missing_grid_message("x.vdb", "density", {}),
            "x.vdb: has no grid \"density\", and none at all");
}

TEST_F(ReadErrors, unsupported_grids) {
  EXPECT_EQ(refusal(make("vector")),
            ": grid \"density\" holds vec3s values, but only float and half grids can be rendered");
  EXPECT_EQ(refusal(make("integer")),
            ": grid \"density\" holds int32 values, but only float and half grids can be rendered");
  EXPECT_EQ(refusal(make("frustum")),
            ": grid \"density\" has a NonlinearFrustumMap, not an affine transform; resample it to "
            "a uniform grid");
  EXPECT_EQ(refusal(make("background")),
            ": grid \"density\" has the background value 0.25, so the medium would have no end; "
            "set the background to 0 (or, for a level set, its class to \"level set\")");
}

} // namespace
} // namespace vdbeam
