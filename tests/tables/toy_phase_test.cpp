// A new phase function is one file and one line: this is the file.
#include "phase/phase_table.h"
#include "tables/toy_support.h"

#include <array>

namespace vdbeam {
namespace {

constexpr std::string_view toy_phase_keys[] = {"g"};

/// As much backwards as forwards.
const PhaseKind mirrored_phase{
    .name = "mirrored",
    .help = "as much backwards as forwards",
    .keys = toy_phase_keys,
    .complaint =
        [](const PhaseSettings& phase) {
          return phase.g > 0 ? mean_cosine_complaint("g", phase.g)
                             : KeyComplaint{"g", "must be greater than 0 in a mirrored one"};
        },
    .lobes = [](const PhaseSettings& phase) -> PhaseLobes {
      const auto g = static_cast<float>(phase.g);
      return {DraineLobe{.g = g, .weight = 0.5f}, DraineLobe{.g = -g, .weight = 0.5f}};
    }};

} // namespace

std::span<const PhaseKind* const> phase_table() {
  static constexpr std::array table{&isotropic_phase, &henyey_greenstein_phase,
                                    &rayleigh_phase,  &two_lobe_phase,
                                    &mie_phase,       &mirrored_phase};
  return table;
}

namespace {

using test::holds;
using test::key;

PhaseSettings mirrored(double g) {
  PhaseSettings phase;
  phase.type = {"mirrored"};
  phase.g = g;
  return phase;
}

/// With a file, as validation asks for.
Scene scene_with(const PhaseSettings& phase) {
  Scene scene;
  VolumeSettings& volume = scene.volumes.emplace_back();
  volume.file = "fog.vdb";
  volume.phase = phase;
  return scene;
}

test::MemoryScene fog_of(const PhaseSettings& phase) {
  test::MemoryScene scene = test::lit_by(LightType::point, 1);
  scene.scene.volumes[0].phase = phase;
  return scene;
}

TEST(ToyPhase, IsInKeysAndHelp) {
  EXPECT_TRUE(holds(key(SceneSection::phase, "type").choices, "mirrored"));
  EXPECT_EQ(key(SceneSection::phase, "g").types,
            (std::vector<std::string>{"henyey_greenstein", "two_lobe", "mirrored"}));
  EXPECT_FALSE(holds(key(SceneSection::phase, "g2").types, "mirrored"));
  EXPECT_NE(key_tables_text(100).find("mirrored: as much backwards as forwards"),
            std::string::npos);
  EXPECT_NE(key_table_markdown(SceneSection::phase).find("`mirrored`"), std::string::npos);
}

TEST(ToyPhase, IsValidated) {
  Scene scene = scene_with(mirrored(0.5));
  EXPECT_EQ(test::complaint_about(scene), "");
  scene.volumes[0].phase.g = 0;
  EXPECT_EQ(test::complaint_about(scene),
            "scene: volume.0.phase.g must be greater than 0 in a mirrored one");
  EXPECT_THROW(PhaseFunction{scene.volumes[0].phase}, InputError);
}

TEST(ToyPhase, IsReadAndWritten) {
  Scene scene;
  scene.volumes.emplace_back();
  const SceneKey& type = key(SceneSection::phase, "type");
  type.set(scene, 0, std::string("mirrored")); // the name of the table is kept, not this one
  EXPECT_EQ(scene.volumes[0].phase.type, (PhaseType{"mirrored"}));
  EXPECT_EQ(type.format(type.get(scene, 0)), "\"mirrored\"");
}

TEST(ToyPhase, OtherNamesAreErrors) {
  PhaseSettings misspelt;
  misspelt.type = {"mirored"};
  const Scene scene = scene_with(misspelt);
  EXPECT_NE(test::complaint_about(scene).find("did you mean mirrored?"), std::string::npos);
  EXPECT_THROW(PhaseFunction{scene.volumes[0].phase}, InputError);
}

TEST(ToyPhase, IsPlanned) {
  EXPECT_TRUE(test::TestFrame(fog_of(mirrored(0.5))).plan.needs(Stage::photon_directions));
  EXPECT_FALSE(test::TestFrame(fog_of({})).plan.needs(Stage::photon_directions));
}

TEST(ToyPhase, EveryEstimatorScattersByIt) {
  PhaseSettings two_lobe = mirrored(0.6);
  two_lobe.type = PhaseType::two_lobe;
  two_lobe.g2 = -0.6;
  test::expect_same_picture(fog_of(mirrored(0.6)), fog_of(two_lobe));
  EXPECT_NE(test::first_pass(fog_of(mirrored(0.6)), EstimatorType::path).direct,
            test::first_pass(fog_of(mirrored(0.3)), EstimatorType::path).direct);
}

/// Volumes of one phase function share it, of others do not.
TEST(ToyPhase, WorldKeepsItApart) {
  test::MemoryScene scene = fog_of(mirrored(0.5));
  for (const double g : {0.5, 0.25})
    scene.add_box(Vec3d(-0.5), Vec3d(0.5)).phase = mirrored(g);
  EXPECT_EQ(scene.world().medium.phases.size(), 2u);
}

} // namespace
} // namespace vdbeam
