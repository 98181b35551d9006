// A new estimator and a new light are one file and one line each: this program links tables that
// are one line longer than the renderer's, and everything that reads them follows.
#include "estimators/estimator_table.h"
#include "keys/scene_keys.h"
#include "lights/light_table.h"
#include "math/color.h"
#include "report/report.h"
#include "scene/validate.h"
#include "support/test_frame.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace vdbeam {
namespace {

/// A quarter everywhere: no noise, no truth.
class FlatEstimator final : public Estimator {
public:
  explicit FlatEstimator(const EstimatorInput& input) : input_(input) {}

  void render(const PassSpec&, PassImage& image, RenderStatistics& statistics) override {
    const Camera& camera = input_.camera;
    image.resize(camera.width(), camera.height());
    std::fill(image.direct.begin(), image.direct.end(), Rgb(0.25f));
    std::fill(image.finished_tiles.begin(), image.finished_tiles.end(), 1);
    statistics.camera_rays += image.direct.size();
  }

private:
  EstimatorInput input_;
};

constexpr std::string_view toy_keys[] = {"step"};

const EstimatorKind toy_estimator{
    .name = "toy",
    .help = "a quarter everywhere",
    .stages = {Stage::depth_profiles},
    .keys = toy_keys,
    .make = [](const EstimatorInput& input, PhotonPass*) -> std::unique_ptr<Estimator> {
      return std::make_unique<FlatEstimator>(input);
    }};

constexpr std::string_view lantern_keys[] = {"position", "intensity"};

/// A point light of twice the intensity.
const LightKind lantern_light{
    .name = "lantern",
    .help = "a point that shines twice as brightly",
    .keys = lantern_keys,
    .colored = [](const LightSettings& light) { return !is_grey(light.intensity); },
    .complaint =
        [](const LightSettings& light) {
          return max_component(light.intensity) > 0
                     ? std::optional<KeyComplaint>()
                     : KeyComplaint{"intensity", "must not be 0 in a lantern"};
        },
    .make =
        [](const LightSettings& light, const LightContext& context) {
          LightSettings brighter = light;
          brighter.intensity = light.intensity * 2.0f;
          return point_light.make(brighter, context);
        }};

} // namespace

std::span<const EstimatorKind* const> estimator_table() {
  static constexpr std::array table{&auto_estimator,  &beam_estimator, &gather_estimator,
                                    &march_estimator, &path_estimator, &toy_estimator};
  return table;
}

std::span<const LightKind* const> light_table() {
  static constexpr std::array table{&distant_light,     &point_light, &spot_light,
                                    &environment_light, &sky_light,   &lantern_light};
  return table;
}

namespace {

test::MemoryScene lit_by(const LightType& type, float intensity) {
  test::MemoryScene scene;
  VolumeSettings& volume = scene.add_box(Vec3d(-0.5), Vec3d(0.5));
  volume.extinction = 2;
  LightSettings& light = scene.add_light(type);
  light.position = {0, 2, 0};
  light.intensity = Rgb(intensity);
  scene.look({0, 0, 3}, {0, 0, 0}, 20, 8, 8);
  scene.scene.render.photons = 2000;
  return scene;
}

const SceneKey& key(SceneSection section, const std::string& name) {
  const SceneKey* found = find_key(section, name);
  EXPECT_NE(found, nullptr) << name;
  return *found;
}

bool holds(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

TEST(ToyEstimator, IsInKeysAndHelp) {
  EXPECT_TRUE(holds(key(SceneSection::render, "estimator").choices, "toy"));
  EXPECT_EQ(key(SceneSection::render, "step").estimators,
            (std::vector<std::string>{"march", "toy"}));
  EXPECT_NE(key_tables_text(100).find("toy: a quarter everywhere"), std::string::npos);
  EXPECT_NE(key_table_markdown(SceneSection::render).find("`toy`"), std::string::npos);
}

TEST(ToyEstimator, IsPlannedAndRenders) {
  test::MemoryScene scene = lit_by(LightType::point, 1);
  scene.scene.render.estimator = {"toy"};
  const test::TestFrame frame(scene);
  EXPECT_TRUE(frame.plan.needs(Stage::depth_profiles));
  EXPECT_FALSE(frame.plan.needs(Stage::photons));
  EXPECT_FALSE(frame.plan.needs(Stage::paths));
  EXPECT_FALSE(frame.plan.unbiased); // it shoots no photons, but says that it is biased
  PassImage image;
  RenderStatistics statistics;
  frame.estimator()->render_pass(0, image, statistics);
  EXPECT_EQ(image.total(0), Rgb(0.25f));
}

/// From the scene to the picture and the report, through the public face.
TEST(ToyEstimator, RendersAnEmptyScene) {
  Scene scene;
  scene.image = {4, 4};
  scene.render.estimator = {"toy"};
  scene.render.passes = 2;
  const RenderResult result = render(scene);
  ASSERT_NE(result.image.find("R"), nullptr);
  EXPECT_FLOAT_EQ(result.image.find("R")->data[5], 0.25f);
  EXPECT_EQ(result.image.metadata.count("vdbeam:estimator"), 0u);
  EXPECT_EQ(report_json(scene, result, {})["settings"]["render"]["estimator"], "toy");
}

TEST(ToyEstimator, OtherNamesAreErrors) {
  Scene scene;
  scene.render.estimator = {"toi"};
  try {
    validate_scene(scene);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean toy?"), std::string::npos)
        << error.what();
  }
}

TEST(ToyLight, IsInKeysAndHelp) {
  EXPECT_TRUE(holds(key(SceneSection::light, "type").choices, "lantern"));
  EXPECT_TRUE(holds(key(SceneSection::light, "position").types, "lantern"));
  EXPECT_FALSE(holds(key(SceneSection::light, "irradiance").types, "lantern"));
  EXPECT_TRUE(key(SceneSection::light, "direct").types.empty());
  EXPECT_NE(key_tables_text(100).find("lantern: a point that shines twice"), std::string::npos);
}

TEST(ToyLight, IsValidated) {
  Scene scene;
  scene.lights.emplace_back().type = {"lantern"};
  EXPECT_NO_THROW(validate_scene(scene));
  scene.lights[0].intensity = Rgb(0);
  try {
    validate_scene(scene);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "scene: light.0.intensity must not be 0 in a lantern");
  }
}

TEST(ToyLight, LightsEveryEstimator) {
  for (const EstimatorType& type :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
    PassImage images[2];
    for (const bool lantern : {false, true}) {
      test::MemoryScene scene = lantern ? lit_by({"lantern"}, 1) : lit_by(LightType::point, 2);
      scene.scene.render.estimator = type;
      const test::TestFrame frame(scene);
      EXPECT_EQ(frame.plan.shadow_ray_lights, std::vector<bool>{true});
      RenderStatistics statistics;
      frame.estimator()->render_pass(0, images[lantern], statistics);
    }
    EXPECT_GT(mean_component(images[0].direct[27]), 0) << type.name;
    EXPECT_EQ(images[0].direct, images[1].direct) << type.name;
    EXPECT_EQ(images[0].indirect, images[1].indirect) << type.name;
  }
}

TEST(ToyLight, ColourOfALightIsSeenByThePlan) {
  test::MemoryScene scene = lit_by({"lantern"}, 1);
  EXPECT_FALSE(test::TestFrame(scene).plan.needs(Stage::photon_color));
  scene.scene.lights[0].intensity = {1, 2, 3};
  EXPECT_TRUE(test::TestFrame(scene).plan.needs(Stage::photon_color));
}

} // namespace
} // namespace vdbeam
