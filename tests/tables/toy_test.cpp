// A new estimator, light and feature are one file and one line each, as are a phase function and a
// material in the files beside: this program links tables that are one line longer than the
// renderer's, and everything that reads them follows.
#include "choose/feature.h"
#include "estimators/estimator_table.h"
#include "lights/light_table.h"
#include "math/color.h"
#include "report/report.h"
#include "tables/toy_support.h"

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

/// A feature that a limit of bounces excludes.
constexpr FeatureCondition toy_conditions[] = {
    {[](const FeatureFacts& facts) { return facts.input.settings.max_bounces.has_value(); },
     "bounces are counted"}};
const Feature toy_feature{.name = "toy",
                          .key = "",
                          .help = "it does nothing",
                          .stage = std::nullopt,
                          .conditions = toy_conditions};

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

std::span<const Feature* const> feature_table() {
  static constexpr std::array table{&forward_peak_feature, &final_gather_feature, &toy_feature};
  return table;
}

std::span<const LightKind* const> light_table() {
  static constexpr std::array table{&distant_light,     &point_light,  &spot_light,
                                    &environment_light, &sky_light,    &atmosphere_light,
                                    &sun_light,         &lantern_light};
  return table;
}

namespace {

using test::holds;
using test::key;
using test::lit_by;

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

TEST(ToyFeature, IsDescribedAndExcluded) {
  test::MemoryScene scene = lit_by(LightType::point, 1);
  const auto described = [&] {
    const test::TestFrame frame(scene);
    const EstimatorKind& kind = estimator_kind(scene.scene.render.estimator);
    return describe_features(frame.input(), kind, choose_for_scene(frame.input(), kind).choices);
  };
  EXPECT_EQ(described().size(), 3u);
  EXPECT_TRUE(described().back().on);
  EXPECT_EQ(described().back().reason, "it does nothing");
  scene.scene.render.max_bounces = 3;
  EXPECT_FALSE(described().back().on);
  EXPECT_EQ(described().back().reason, "bounces are counted");
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
  EXPECT_NE(test::complaint_about(scene).find("did you mean toy?"), std::string::npos);
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
  EXPECT_EQ(test::complaint_about(scene), "");
  scene.lights[0].intensity = Rgb(0);
  EXPECT_EQ(test::complaint_about(scene), "scene: light.0.intensity must not be 0 in a lantern");
}

TEST(ToyLight, LightsEveryEstimator) {
  const test::MemoryScene lantern = lit_by({"lantern"}, 1);
  EXPECT_EQ(test::TestFrame(lantern).plan.shadow_ray_lights, std::vector<bool>{true});
  test::expect_same_picture(lantern, lit_by(LightType::point, 2));
}

TEST(ToyLight, ColourOfALightIsSeenByThePlan) {
  test::MemoryScene scene = lit_by({"lantern"}, 1);
  EXPECT_FALSE(test::TestFrame(scene).plan.needs(Stage::photon_color));
  scene.scene.lights[0].intensity = {1, 2, 3};
  EXPECT_TRUE(test::TestFrame(scene).plan.needs(Stage::photon_color));
}

} // namespace
} // namespace vdbeam
