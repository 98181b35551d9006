#include "vdb/vdb_reader.h"

#include "support/temp_folder.h"
#include "vdbeam/scene_file.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

class GridNames : public ::testing::Test {
protected:
  std::string make(const std::string& name) {
    VolumeOptions options;
    options.size = 16;
    options.name = name;
    const std::string path = folder_.file("v.vdb");
    write_volume("noise", path, options);
    return path;
  }
  test::TempFolder folder_;
};

TEST_F(GridNames, HoldAnyByte) {
  for (const std::string name : {"a\nb", "\n", "W\xf6lkchen", "\x1b[31m", "\"quoted\\\""}) {
    const std::string path = make(name);
    const std::vector<GridSummary> grids = summarize_vdb(path);
    ASSERT_EQ(grids.size(), 1u) << name;
    EXPECT_EQ(grids[0].name, name);
    EXPECT_FALSE(read_density_grid(path, name).field.empty()) << name;
    // The default scene is written as TOML, which is UTF-8, and read again.
    const Scene scene = load_scene(path);
    EXPECT_FALSE(read_density_grid(path, scene.volumes.at(0).density).field.empty()) << name;
  }
}

TEST_F(GridNames, AreNotedWhereCapitalsDiffer) {
  const std::string path = make("Density");
  EXPECT_EQ(read_density_grid(path, "Density").notes, std::vector<std::string>{});
  EXPECT_EQ(read_density_grid(path, "density").notes,
            std::vector<std::string>{path + ": grid \"density\": the file's grid \"Density\" is "
                                            "taken for it"});
}

TEST_F(GridNames, PathsNeedNotBeUtf8) {
  VolumeOptions options;
  options.size = 16;
  const std::string path = folder_.file("W\xf6lkchen.vdb");
  write_volume("noise", path, options);
  EXPECT_EQ(load_scene(path).volumes.at(0).file, path);
}

} // namespace
} // namespace vdbeam
