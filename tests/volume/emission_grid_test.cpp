#include "grids/emission_grid.h"
#include "support/memory_scene.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "volume/blackbody.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

DensityGrid grid_of(DensityField field, const Affine& map = {}) {
  DensityGrid grid;
  grid.field = std::move(field);
  grid.index_to_world = map;
  grid.active_voxels = 1;
  return grid;
}

EmissionSettings named(const char* intensity, const char* temperature) {
  EmissionSettings settings;
  settings.intensity = intensity;
  settings.temperature = temperature;
  return settings;
}

constexpr std::uint64_t plenty = std::uint64_t(1) << 30;

/// The emission of a file.
EmissionGrid read_emission_grid(const std::string& path, const EmissionSettings& settings) {
  const auto read = [&](const std::string& name) {
    return name.empty() ? DensityGrid{} : read_density_grid(path, name, {}, Background::ignored);
  };
  return make_emission(settings, read(settings.intensity), read(settings.temperature), path,
                       plenty);
}

/// A ramp takes the place of a black body, and of an intensity without a temperature.
TEST(EmissionRamp, GivesTheColours) {
  const Vec3<int> cells{1, 1, 1};
  const DensityGrid two = grid_of(uniform_field(cells, 2)),
                    three = grid_of(uniform_field(cells, 3));
  EmissionSettings settings = named("flame", "temperature");
  settings.ramp = "0:0,0,0 4:4,8,0.4";
  const EmissionGrid hot = make_emission(settings, two, three, "a.vdb", plenty);
  const Rgb both = hot.field->sample_cell(hot.field->cell(0, 0, 0), Vec3f(4));
  EXPECT_NEAR(both.x, 2 * 3, 1e-5);
  EXPECT_NEAR(both.y, 2 * 6, 1e-5);
  EXPECT_NEAR(both.z, 2 * 0.3f, 1e-5);
  settings.temperature.clear();
  const EmissionGrid flame = make_emission(settings, two, {}, "a.vdb", plenty);
  const Rgb alone = flame.field->sample_cell(flame.field->cell(0, 0, 0), Vec3f(4));
  EXPECT_NEAR(alone.x, 2, 1e-5);
  EXPECT_NEAR(alone.y, 4, 1e-5);
}

TEST(BlackbodyEmission, FollowsItsLaw) {
  EmissionSettings settings = named("", "temperature");
  settings.kelvin = 1000;
  settings.kelvin_offset = 500;
  settings.reference = 2000;
  const auto light = [&](float value) {
    return luminance(Vec3d(blackbody_emission(settings, value)));
  };
  EXPECT_NEAR(light(1.5f), 1, 1e-3); // 2000 K
  EXPECT_NEAR(light(1) / (planck_xyz(1500).y / planck_xyz(2000).y), 1, 1e-3);
  settings.law = EmissionLaw::stefan_boltzmann;
  EXPECT_NEAR(light(1) / std::pow(0.75, 4), 1, 1e-3);
  settings.law = EmissionLaw::none;
  EXPECT_NEAR(light(1), 1, 1e-3);
  EXPECT_EQ(blackbody_emission(settings, 0), Rgb()); // outside of the grid, whatever the offset
  settings.kelvin_offset = -2000;
  EXPECT_EQ(blackbody_emission(settings, 1), Rgb()); // below absolute zero
}

TEST(MakeEmission, IntensityIsTheGridItself) {
  const auto value = [](int i, int j, int k) { return i + 10 * j + 100 * k + 1; };
  const EmissionGrid grid = make_emission(
      named("flame", ""), grid_of(closed_field({1, 1, 1}, value)), {}, "memory", plenty);
  ASSERT_FALSE(grid.empty());
  EXPECT_EQ(grid.field->sample_cell(grid.field->cell(0, 0, 0), {1, 2, 3}), Rgb(322));
  EXPECT_EQ(grid.field->sample_cell(grid.field->cell(0, 0, 0), {0.5f, 0, 0}), Rgb(1.5f));
}

/// A temperature on a coarser, shifted lattice is interpolated at the voxels of the intensity.
TEST(MakeEmission, TemperatureOnAnotherLattice) {
  EmissionSettings settings = named("flame", "temperature");
  settings.law = EmissionLaw::stefan_boltzmann;
  settings.reference = 1000;
  Affine half; // a voxel of the temperature is two of the intensity, moved by two of them
  for (int a = 0; a < 3; ++a)
    half.rows[static_cast<std::size_t>(a)] *= 2.0;
  half.translation = {-2, 0, 0};
  const DensityGrid flame = grid_of(uniform_field({1, 1, 1}, 3));
  const DensityGrid temperature =
      grid_of(closed_field({1, 1, 1}, [](int i, int, int) { return 500 + 100 * i; }), half);
  const EmissionGrid grid = make_emission(settings, flame, temperature, "memory", plenty);
  ASSERT_FALSE(grid.empty());
  for (const int i : {0, 1, 5}) { // x = i is at 1 + i / 2 there
    const Rgb light =
        grid.field->sample_cell(grid.field->cell(0, 0, 0), {static_cast<float>(i), 4, 4});
    const double kelvin = 600 + 50 * i;
    EXPECT_NEAR(luminance(Vec3d(light)) / (3 * std::pow(kelvin / 1000, 4)), 1, 1e-3);
  }
}

TEST(MakeEmission, ColdSmokeTakesNoRoom) {
  EmissionSettings settings = named("", "temperature");
  const Vec3<int> cells{3, 1, 1};
  const auto value = [](int i, int, int) { return i < 9 ? 1500 : 300; };
  const EmissionGrid grid =
      make_emission(settings, {}, grid_of(closed_field(cells, value)), "memory", plenty);
  EXPECT_EQ(grid.field->brick_count(), 2u); // the third cell is all cold
  EXPECT_EQ(grid.field->cell(2, 0, 0), DensityField::empty_cell);
  EXPECT_EQ(grid.field->occupied().upper.x, 16);
}

TEST(MakeEmission, NothingGlows) {
  EXPECT_TRUE(make_emission(named("flame", ""), {}, {}, "memory", plenty).empty());
  EXPECT_TRUE(make_emission(named("flame", "temperature"), grid_of(uniform_field({1, 1, 1}, 1)), {},
                            "memory", plenty)
                  .empty());
  EXPECT_TRUE(make_emission(named("", "temperature"), {}, grid_of(uniform_field({1, 1, 1}, 3)),
                            "memory", plenty)
                  .empty()); // 3 K
}

TEST(MakeEmission, RefusesWhatDoesNotFit) {
  const auto value = [](int i, int, int) { return i + 1; };
  EXPECT_THROW(make_emission(named("flame", ""), grid_of(closed_field({4, 4, 4}, value)), {},
                             "memory", 1000),
               FrameError);
}

class ReadEmission : public testing::Test {
protected:
  std::string write(const char* kind) {
    VolumeOptions options;
    options.size = 24;
    write_volume(kind, path_, options);
    return path_;
  }
  TempFolder folder_;
  std::string path_ = folder_.file("fire.vdb");
};

TEST_F(ReadEmission, ReadsTheGridsThatAreNamed) {
  EmissionSettings settings = named("density", "temperature");
  settings.kelvin = 2000;
  const EmissionGrid grid = read_emission_grid(write("simulation"), settings);
  EXPECT_FALSE(grid.empty());
  EXPECT_GT(grid.active_voxels, read_density_grid(path_, "density").active_voxels);
}

TEST_F(ReadEmission, MissingGridNamesThoseThatAreThere) {
  try {
    read_emission_grid(write("simulation"), named("flame", ""));
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.substr(text.rfind('/') + 1),
              "fire.vdb: has no grid \"flame\"; it holds \"density\", \"temperature\", "
              "\"velocity\"");
  }
  EXPECT_THROW(read_emission_grid(path_, named("velocity", "")), InputError);
}

TEST_F(ReadEmission, BadValuesAreCountedAndCountAsZero) {
  const EmissionGrid grid = read_emission_grid(write("bad"), named("density", ""));
  ASSERT_EQ(grid.notes.size(), 1u);
  EXPECT_NE(grid.notes[0].find("NaN"), std::string::npos) << grid.notes[0];
  for (std::size_t b = 0; b < grid.field->brick_count(); ++b)
    for (int i = 0; i < DensityField::brick_size; ++i) {
      const Rgb value = grid.field->brick(static_cast<std::int32_t>(b))[i];
      EXPECT_TRUE(value.x >= 0 && value.x < infinity);
    }
}

/// A temperature may have an ambient value everywhere; it does not glow.
TEST_F(ReadEmission, BackgroundCountsAsZero) {
  write("background");
  EXPECT_THROW(read_density_grid(path_, "density"), InputError);
  const EmissionGrid grid = read_emission_grid(path_, named("density", ""));
  write("noise");
  const EmissionGrid plain = read_emission_grid(path_, named("density", ""));
  ASSERT_FALSE(grid.empty());
  EXPECT_EQ(grid.field->cell_counts(), plain.field->cell_counts());
  EXPECT_EQ(grid.field->brick_count(), plain.field->brick_count());
}

TEST_F(ReadEmission, EmptyGrid) {
  const EmissionGrid grid = read_emission_grid(write("empty"), named("density", ""));
  EXPECT_TRUE(grid.empty());
}

} // namespace
} // namespace vdbeam
