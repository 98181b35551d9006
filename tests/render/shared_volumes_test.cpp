#include "prepare/prepared_scene.h"
#include "support/temp_folder.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace vdbeam {
namespace {

/// Two volumes beside each other.
Scene pair_of(const std::string& first, const std::string& second,
              const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"image.width=24",          "image.height=14",
                                     "render.photons=2000",     "render.passes=1",
                                     "render.estimator=beam",   "volume.0.file=" + first,
                                     "volume.1.file=" + second, "volume.1.translate=[1, 0, 0]",
                                     "volume.1.extinction=20"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml", 1, overrides);
}

class SharedVolumes : public ::testing::Test {
protected:
  void SetUp() override { std::filesystem::copy_file(cloud_, copy_); }

  const std::string cloud_ = VDBEAM_SOURCE_DIR "/data/cloud.vdb";
  test::TempFolder folder_;
  const std::string copy_ = folder_.file("copy.vdb");
};

TEST_F(SharedVolumes, AreReadOnceAndRenderTheSameBits) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{},
        {"volume.0.density_power=2", "volume.1.density_power=2"},
        {"volume.0.emission={intensity=\"density\"}",
         "volume.1.emission={intensity=\"density\"}"}}) {
    const RenderResult shared = render(pair_of(cloud_, cloud_, more));
    const RenderResult apart = render(pair_of(cloud_, copy_, more));
    EXPECT_EQ(2 * shared.statistics.grids_read, apart.statistics.grids_read);
    ASSERT_EQ(shared.image.channels.size(), apart.image.channels.size());
    for (std::size_t c = 0; c < shared.image.channels.size(); ++c)
      EXPECT_EQ(shared.image.channels[c].data, apart.image.channels[c].data);
  }
}

TEST_F(SharedVolumes, HaveOneCopyOfTheValues) {
  const PreparedScenePtr prepared = prepare_scene(pair_of(cloud_, cloud_));
  const std::vector<Volume>& volumes = prepared->world->medium.volumes;
  ASSERT_EQ(volumes.size(), 2u);
  EXPECT_EQ(volumes[0].field.brick(0), volumes[1].field.brick(0));
}

TEST_F(SharedVolumes, DifferWhereTheirEditsDo) {
  const RenderResult result = render(pair_of(cloud_, cloud_, {"volume.1.density_power=2"}));
  EXPECT_EQ(result.statistics.grids_read, 2u);
  const PreparedScenePtr prepared =
      prepare_scene(pair_of(cloud_, cloud_, {"volume.1.density_power=2"}));
  const std::vector<Volume>& volumes = prepared->world->medium.volumes;
  EXPECT_NE(volumes[0].field.brick(0), volumes[1].field.brick(0));
}

/// A thousand rows of a table: one reading, one set of bricks, and the image of a thousand volumes.
TEST_F(SharedVolumes, InstancesOfATable) {
  std::string text = "[image]\nwidth = 16\nheight = 9\n[camera]\nposition = [0, 4, 30]\n"
                     "[[light]]\ntype = 'distant'\n[render]\npasses = 1\nestimator = 'path'\n";
  std::string volumes, rows;
  for (int i = 0; i < 1000; ++i) {
    const std::string place = std::to_string(i % 10 * 3 - 15) + ", " +
                              std::to_string(i / 10 % 10 * 2 - 10) + ", " +
                              std::to_string(i / -100 * 5);
    volumes += "[[volume]]\nfile = '" + cloud_ + "'\nextinction = 9\ntranslate = [" + place + "]\n";
    rows += "[" + place + "],\n";
  }
  const std::string table = "[[volume]]\nfile = '" + cloud_ +
                            "'\nname = 'a'\nextinction = 9\n[[instance]]\nvolume = 'a'\nrows = [" +
                            rows + "]\n";
  const Scene scene = parse_scene(text + table, folder_.file("s.toml"));
  const PreparedScenePtr prepared = prepare_scene(scene);
  const std::vector<Volume>& found = prepared->world->medium.volumes;
  ASSERT_EQ(found.size(), 1000u);
  EXPECT_EQ(found.front().field.brick(0), found.back().field.brick(0));
  const RenderResult instances = render(scene, prepared);
  EXPECT_EQ(instances.statistics.grids_read, 1u);
  const RenderResult apart = render(parse_scene(text + volumes, folder_.file("t.toml")));
  ASSERT_EQ(instances.image.channels.size(), apart.image.channels.size());
  for (std::size_t c = 0; c < apart.image.channels.size(); ++c)
    EXPECT_EQ(instances.image.channels[c].data, apart.image.channels[c].data);
}

TEST_F(SharedVolumes, AreKeptForTheNextFrame) {
  const Scene scene = pair_of(cloud_, cloud_);
  const PreparedScenePtr first = prepare_scene(scene);
  const Scene denser = pair_of(cloud_, cloud_, {"volume.0.extinction=30"});
  const RenderResult again = render(denser, prepare_scene(denser, first));
  EXPECT_EQ(again.statistics.grids_read, 0u);
}

} // namespace
} // namespace vdbeam
