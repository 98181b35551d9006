#include "scene/default_emission.h"
#include "scene/default_scene.h"
#include "scene_fixture.h"

namespace vdbeam {
namespace {

using EmissionKeys = test::SceneTest;

const std::string volume = "[[volume]]\nfile = 'cloud.vdb'\n";

TEST_F(EmissionKeys, AreRead) {
  const Scene scene = load(volume + "translate = [1, 0, 0]\n"
                                    "emission = { intensity = 'flame', temperature = 'heat', "
                                    "kelvin = 900, kelvin_offset = 273.15, law = "
                                    "'stefan_boltzmann', reference = 2000, color = [1, 0.5, 0], "
                                    "scale = 12 }\n");
  const EmissionSettings& emission = scene.volumes[0].emission;
  EXPECT_EQ(emission.intensity, "flame");
  EXPECT_EQ(emission.temperature, "heat");
  EXPECT_EQ(emission.kelvin, 900);
  EXPECT_EQ(emission.kelvin_offset, 273.15);
  EXPECT_EQ(emission.law, EmissionLaw::stefan_boltzmann);
  EXPECT_EQ(emission.reference, 2000);
  EXPECT_EQ(emission.color, Rgb(1, 0.5f, 0));
  EXPECT_EQ(emission.scale, 12);
  EXPECT_EQ(scene.volumes[0].transform[3], 1); // not forgotten over the emission
  EXPECT_TRUE(scene.volumes[0].glows());
  for (const std::string& note : scene.notes)
    EXPECT_EQ(note.find("black"), std::string::npos) << note;
}

TEST_F(EmissionKeys, NoneByDefault) {
  EXPECT_FALSE(load(volume).glows());
  EXPECT_FALSE(load(volume + "emission = {}\n").glows());
  EXPECT_FALSE(load(volume + "emission = { intensity = 'flame', scale = 0 }\n").volumes[0].glows());
}

TEST_F(EmissionKeys, CanBeAnimatedAndOverridden) {
  const std::string text =
      volume + "emission = { intensity = 'flame', scale = { keys = [[1, 0], [11, 10]] } }\n";
  EXPECT_EQ(load(text, {}, 6).volumes[0].emission.scale, 5);
  EXPECT_EQ(load(text, {"volume.0.emission.scale=3"}, 6).volumes[0].emission.scale, 3);
  const Scene added = load(volume, {"volume.0.emission.temperature=temperature"});
  EXPECT_EQ(added.volumes[0].emission.temperature, "temperature");
}

TEST_F(EmissionKeys, EnterTheSceneHash) {
  const std::string hash = scene_hash(load(volume));
  const std::string glowing = scene_hash(load(volume + "emission = { intensity = 'flame' }\n"));
  EXPECT_NE(glowing, hash);
  EXPECT_NE(scene_hash(load(volume + "emission = { intensity = 'flame', kelvin = 2 }\n")), glowing);
}

TEST_F(EmissionKeys, Mistakes) {
  EXPECT_EQ(error_of(volume + "emission = 3\n"),
            "s.toml:3: volume.0.emission must be a table, e.g. { intensity = \"flame\", scale = 10 "
            "}, got 3");
  EXPECT_EQ(error_of(volume + "emission = { scale = 3 }\n"),
            "s.toml:3: volume.0.emission must name the grid that glows: intensity, temperature or "
            "both");
  EXPECT_EQ(error_of(volume + "emission = { intensty = 'flame' }\n"),
            "s.toml:3: unknown key volume.0.emission.intensty; did you mean intensity?");
  EXPECT_EQ(error_of(volume + "emission = { intensity = 'flame', law = 'wien' }\n"),
            "s.toml:3: volume.0.emission.law must be planck, stefan_boltzmann or none, "
            "got \"wien\"");
  EXPECT_EQ(error_of(volume + "emission = { temperature = 't', kelvin = 0 }\n"),
            "s.toml:3: volume.0.emission.kelvin must be greater than 0, got 0");
}

GridSummary summary(const std::string& name, double maximum, double mean) {
  GridSummary grid;
  grid.name = name;
  grid.value_type = "float";
  grid.grid_class = "Fog Volume";
  grid.active_voxels = maximum > 0 ? 500 : 0;
  grid.index_lower = Vec3<std::int64_t>(0);
  grid.index_upper = Vec3<std::int64_t>(9); // half of the voxels are active
  for (double& size : grid.voxel_size)
    size = 0.1;
  grid.maximum = maximum;
  grid.mean = mean;
  return grid;
}

TEST(DefaultEmission, FlameInTheColoursOfItsTemperature) {
  std::vector<std::string> notes;
  // The first frame is not lit yet.
  const EmissionSettings emission = default_emission(
      "fire.vdb",
      {{summary("density", 1, 0.5), summary("flame", 0, 0), summary("temperature", 0, 0)},
       {summary("density", 1, 0.5), summary("flame", 1, 0.5), summary("temperature", 2, 1)}},
      notes);
  EXPECT_EQ(emission.intensity, "flame");
  EXPECT_EQ(emission.temperature, "temperature");
  EXPECT_EQ(emission.kelvin, 1100);
  EXPECT_EQ(emission.scale, 12); // a mean line of 0.25 shows 3
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], "fire.vdb: grid \"flame\" glows in the colours of \"temperature\", with "
                      "strength 12; change it with --set volume.0.emission.scale=X (0: off)");
}

TEST(DefaultEmission, FlamesWithoutTemperature) {
  std::vector<std::string> notes;
  const EmissionSettings emission =
      default_emission("fire.vdb", {{summary("density", 1, 1), summary("flames", 4, 1)}}, notes);
  EXPECT_EQ(emission.intensity, "flames");
  EXPECT_EQ(emission.temperature, "");
  EXPECT_GT(emission.color.x, emission.color.y);
  EXPECT_GT(emission.color.y, emission.color.z);
}

TEST(DefaultEmission, KelvinGlowsAndWarmAirDoesNot) {
  std::vector<std::string> notes;
  const EmissionSettings hot = default_emission(
      "a.vdb", {{summary("density", 1, 1), summary("temperature", 1800, 900)}}, notes);
  EXPECT_EQ(hot.temperature, "temperature");
  EXPECT_EQ(hot.kelvin, 1);
  EXPECT_EQ(hot.reference, 1800);
  // Smoke comes with a temperature of 0 to about 2, which says how it rises.
  for (const double maximum : {0.0, 2.0, 320.0})
    EXPECT_FALSE(default_emission("a.vdb",
                                  {{summary("density", 1, 1), summary("flame", 0, 0),
                                    summary("temperature", maximum, maximum / 2)}},
                                  notes)
                     .glows());
  EXPECT_EQ(notes.size(), 1u);
}

/// No flame as a lump of smoke, whatever its capitals, and no fuel either.
TEST(DefaultEmission, FireWithoutSmoke) {
  const Scene scene =
      make_default_scene("fire.vdb", {{summary("fuel", 1, 0.5), summary("Flame", 1, 0.5)}}, {});
  EXPECT_EQ(scene.volumes[0].emission.intensity, "Flame");
  EXPECT_EQ(scene.volumes[0].extinction, 0);
  EXPECT_NE(std::find(scene.notes.begin(), scene.notes.end(),
                      "fire.vdb: no grid is smoke, so only the fire is rendered; for smoke of grid "
                      "\"fuel\": --set volume.0.extinction=X"),
            scene.notes.end());
  FramingWishes wishes;
  wishes.grid = "fuel";
  EXPECT_GT(
      make_default_scene("fire.vdb", {{summary("fuel", 1, 0.5), summary("Flame", 1, 0.5)}}, wishes)
          .volumes[0]
          .extinction,
      0);
  // Smoke under another name is there to be seen.
  const Scene smoke =
      make_default_scene("fire.vdb", {{summary("flame", 1, 0.5), summary("soot", 1, 0.5)}}, {});
  EXPECT_EQ(smoke.volumes[0].density, "soot");
  EXPECT_GT(smoke.volumes[0].extinction, 0);
}

TEST(DefaultGrid, OfSeveralOfOneNameOrNone) {
  const Scene twins = make_default_scene(
      "a.vdb", {{summary("density[0]", 1, 0.5), summary("density[1]", 1, 0.5)}}, {});
  EXPECT_EQ(twins.volumes[0].density, "density[0]");
  EXPECT_EQ(twins.notes.at(0), "a.vdb: there are 2 grids called \"density\"; the first with "
                               "voxels, \"density[0]\", is rendered; for another: "
                               "--set volume.0.density=density[1]");
  const Scene unnamed = make_default_scene("a.vdb", {{summary("[0]", 1, 0.5)}}, {});
  EXPECT_EQ(unnamed.notes.at(0), "a.vdb: its grid has no name; it is rendered as density");
}

TEST(DefaultEmission, InitWritesItAndItIsRead) {
  Scene scene;
  scene.volumes.emplace_back().file = "fire.vdb";
  EXPECT_NE(scene_text(scene, "fire.vdb").find("\n# emission = {"), std::string::npos);
  scene.volumes[0].emission.intensity = "flame \"1\"";
  scene.volumes[0].emission.scale = 7;
  EXPECT_NE(scene_text(scene, "fire.vdb")
                .find("\nemission = { intensity = \"flame \\\"1\\\"\", scale = 7 }"),
            std::string::npos);
  const std::string text = scene_text(scene, "fire.vdb", true);
  EXPECT_NE(
      text.find("\nemission = { intensity = \"flame \\\"1\\\"\", temperature = \"\", kelvin = 1"),
      std::string::npos)
      << text;
}

} // namespace
} // namespace vdbeam
