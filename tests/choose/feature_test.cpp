// The table of features: each condition excludes its feature in some scene, with its own clause,
// and what the plan describes is what passes do.
#include "choose/feature.h"

#include "choose/plan_numbers.h"
#include "support/lumpy_cloud.h"
#include "support/surface_scene.h"
#include "support/test_frame.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace vdbeam {
namespace {

using namespace test;

/// A cloud of droplets in the sun, for which every feature can be used.
MemoryScene cloud() {
  MemoryScene scene = lumpy_cloud(80, 48);
  scene.scene.volumes[0].albedo = Rgb(0.99f);
  scene.scene.volumes[0].phase = henyey_greenstein(0.85);
  scene.scene.render.estimator = EstimatorType::automatic;
  return scene;
}

std::vector<FeatureChoice> features_of(const MemoryScene& scene) {
  const TestFrame frame(scene);
  const EstimatorKind& kind = estimator_kind(scene.scene.render.estimator);
  const SceneChoices chosen = choose_for_scene(frame.input(), kind);
  return describe_features(frame.input(), kind, chosen.choices);
}

FeatureChoice feature_of(const MemoryScene& scene, std::string_view name) {
  for (const FeatureChoice& feature : features_of(scene))
    if (feature.name == name)
      return feature;
  ADD_FAILURE() << "there is no feature " << name;
  return {};
}

/// A scene in which a feature is off, and why.
struct Exclusion {
  std::string_view feature, clause;
  std::function<void(MemoryScene&)> change;
};

void store_scattered_flux(MemoryScene& scene) {
  scene.scene.render.store = PhotonStore::scatter;
}
void limit_bounces(MemoryScene& scene) {
  scene.scene.render.max_bounces = 100000;
}
void name_path(MemoryScene& scene) {
  scene.scene.render.estimator = EstimatorType::path;
}
void name_beam(MemoryScene& scene) {
  scene.scene.render.estimator = EstimatorType::beam;
}

const std::vector<Exclusion>& exclusions() {
  static const std::vector<Exclusion> list{
      {"path guide", "photons store scattered flux (render.store)", store_scattered_flux},
      {"forward peak", "render.forward_peak is \"kept\"",
       [](MemoryScene& s) { s.scene.render.forward_peak = ForwardPeak::kept; }},
      {"forward peak", "photons store scattered flux (render.store)", store_scattered_flux},
      {"forward peak", "render.max_bounces limits the scattering events", limit_bounces},
      {"forward peak", "phase functions are isotropic",
       [](MemoryScene& s) { s.scene.volumes[0].phase = {}; }},
      {"forward peak", "a light other than a constant sky is sampled by photons only",
       [](MemoryScene& s) { s.scene.render.direct = DirectLight::photons; }},
      {"final gathering", "render.estimator names another method", name_beam},
      {"final gathering", "photons store scattered flux (render.store)", store_scattered_flux},
      {"final gathering", "render.max_bounces limits the scattering events", limit_bounces},
      {"final gathering", "a point or directional light is sampled by photons only",
       [](MemoryScene& s) { s.scene.render.direct = DirectLight::photons; }},
      {"final gathering",
       "a small light without shadow rays makes the pilot's noise estimate unreliable",
       [](MemoryScene& s) {
         s.scene.lights[0].angular_radius = 0.5;
         s.scene.render.direct = DirectLight::photons;
       }},
      {"hidden lights", "the estimator traces no photons", name_path},
      {"hidden lights", "no surface hides a light", [](MemoryScene&) {}},
      {"shadow lattice", "the estimator traces no photons", name_path},
      {"shadow lattice", "extinction differs between channels",
       [](MemoryScene& s) {
         s.scene.volumes[0].extinction_scale = {1, 0.9f, 0.8f};
       }},
      {"boundary correction", "photons of scattered flux need no boundary correction",
       store_scattered_flux},
      {"refined edges", "path divides its rays among pixels by their noise", name_path},
      {"refined edges", "render.estimator names another method, and there are no surfaces",
       name_beam},
      {"branches", "photons carry the light; only bias probes are path traced",
       [](MemoryScene&) {}},
      {"branches", "no phase function has a sharp enough peak, and no lamp stands in the medium",
       name_path},
      {"branches", "no sun, lamp or spot has shadow rays", [](MemoryScene& s) {
         name_path(s);
         s.scene.volumes[0].phase = henyey_greenstein(0.97);
         s.scene.lights.clear();
         s.add_light(LightType::environment);
       }}};
  return list;
}

TEST(Features, ACloudInTheSunUsesThem) {
  for (const std::string_view name :
       {"view importance", "path guide", "kernel pilot", "forward peak", "final gathering",
        "shadow lattice", "boundary correction", "refined edges"}) {
    const FeatureChoice feature = feature_of(cloud(), name);
    EXPECT_TRUE(feature.on) << name << ": " << feature.reason;
  }
}

/// What the features are called is what passes do: outlines get more rays, and walks from surfaces
/// branch.
TEST(Features, SurfacesAreRefinedAndTheirWalksBranch) {
  MemoryScene scene = cloud();
  scene.scene.volumes[0].phase = henyey_greenstein(0.97);
  name_beam(scene);
  EXPECT_FALSE(feature_of(scene, "refined edges").on);
  EXPECT_FALSE(feature_of(scene, "branches").on);
  surfaces::add_surface(scene, SurfaceShape::sphere, surfaces::scaled(0.1),
                        surfaces::diffuse(0.5f));
  EXPECT_TRUE(feature_of(scene, "refined edges").on);
  EXPECT_TRUE(feature_of(scene, "branches").on);
}

TEST(Features, EachConditionExcludesItsFeatureAndSaysWhy) {
  for (const Exclusion& exclusion : exclusions()) {
    MemoryScene scene = cloud();
    exclusion.change(scene);
    const FeatureChoice feature = feature_of(scene, exclusion.feature);
    EXPECT_FALSE(feature.on) << exclusion.feature << ", " << exclusion.clause;
    EXPECT_EQ(feature.reason, exclusion.clause) << exclusion.feature;
  }
}

/// So that a new condition is tried as well. Of colour grids and of no medium at all there are
/// tests elsewhere (color_grid_test, edge_cases_test).
TEST(Features, EveryConditionIsTried) {
  std::set<std::pair<std::string_view, std::string_view>> tried{
      {"forward peak", "a colour grid varies the albedo"},
      {"shadow lattice", "there is no medium"}};
  for (const Exclusion& exclusion : exclusions())
    tried.insert({exclusion.feature, exclusion.clause});
  for (const Feature* feature : feature_table())
    for (const FeatureCondition& condition : feature->conditions)
      EXPECT_TRUE(tried.count({feature->name, condition.clause}))
          << feature->name << ": " << condition.clause;
}

TEST(Features, OfTheTableHaveNamesAndHelp) {
  std::set<std::string_view> names;
  for (const Feature* feature : feature_table()) {
    EXPECT_FALSE(feature->help.empty()) << feature->name;
    EXPECT_TRUE(names.insert(feature->name).second) << feature->name;
    EXPECT_EQ(feature->used == nullptr, feature->unused.empty()) << feature->name;
  }
}

/// No shadow ray reaches a lamp in a closed box. The walks of final gathering look for it, so that
/// it excludes nothing.
TEST(Features, HiddenLightsAreNamed) {
  MemoryScene scene = cloud();
  LightSettings& lamp = scene.add_light(LightType::point);
  lamp.position = {0, -3, 0};
  surfaces::add_surface(scene, SurfaceShape::box,
                        surfaces::moved(surfaces::scaled(0.2), {0, -3, 0}),
                        surfaces::diffuse(0.5f));
  EXPECT_FALSE(feature_of(scene, "hidden lights").on);
  EXPECT_TRUE(feature_of(scene, "final gathering").on);
  name_beam(scene);
  const FeatureChoice hidden = feature_of(scene, "hidden lights");
  EXPECT_TRUE(hidden.on) << hidden.reason;
  EXPECT_EQ(hidden.scope, "light.0");
  scene.scene.lights.pop_back();
  EXPECT_FALSE(feature_of(scene, "hidden lights").on);
}

/// Features say which lights, volumes and paths do without them.
TEST(Features, NameWhatDoesWithoutThem) {
  MemoryScene scene = cloud();
  EXPECT_EQ(feature_of(scene, "forward peak").scope, "");
  scene.add_light(LightType::environment);
  EXPECT_EQ(feature_of(scene, "shadow lattice").scope, "");
  VolumeSettings& mist =
      scene.add(uniform_field({1, 1, 1}, 1), box_map({1, 1, 1}, Vec3d(-0.6), Vec3d(-0.2)));
  mist.extinction = 1;
  EXPECT_EQ(feature_of(scene, "forward peak").scope, "volume.1");
  scene.scene.render.direct = DirectLight::photons;
  const FeatureChoice off = feature_of(scene, "forward peak");
  EXPECT_FALSE(off.on);
  EXPECT_EQ(off.scope, "the scene, because of light.0");
  scene = cloud();
  name_path(scene);
  for (const FeatureChoice& feature : features_of(scene))
    EXPECT_TRUE(feature.on || !feature.scope.empty()) << feature.name;
  EXPECT_EQ(feature_of(scene, "view importance").scope, "the scene");
}

TEST(Features, StateTheWorkOfTheirPilots) {
  const TestFrame frame(cloud());
  const EstimatorKind& kind = estimator_kind(EstimatorType::automatic);
  const Choices choices = choose_for_scene(frame.input(), kind).choices;
  const PilotWork &view = choices.view_work, &guide = choices.guide_work,
                  &kernels = choices.kernel_work;
  EXPECT_GT(view.camera_rays, 0u);
  EXPECT_GT(guide.light_paths, 0u);
  EXPECT_GT(kernels.light_paths, 0u);
  // The first pilot belongs to no feature.
  EXPECT_EQ(view.light_paths + guide.light_paths + kernels.light_paths + 1024,
            choices.photons.pilot_paths);
  EXPECT_EQ(view.camera_rays + guide.camera_rays + kernels.camera_rays,
            choices.photons.importance_rays);
  for (const FeatureChoice& feature : describe_features(frame.input(), kind, choices))
    if (feature.name == "kernel pilot") {
      EXPECT_NE(feature.cost.find("a pilot of " + std::to_string(kernels.light_paths)),
                std::string::npos)
          << feature.cost;
    } else if (feature.name == "final gathering") {
      EXPECT_NE(feature.cost.find("times its forecast error"), std::string::npos) << feature.cost;
    } else if (feature.name == "boundary correction") {
      EXPECT_EQ(feature.cost, ""); // no pilot measures it
    }
}

std::vector<PlanNumber> numbers_of(const MemoryScene& scene) {
  const TestFrame frame(scene);
  const EstimatorKind& kind = estimator_kind(scene.scene.render.estimator);
  const Choices choices = choose_for_scene(frame.input(), kind).choices;
  return describe_numbers(frame.input(), choices, list_passes(choices, scene.scene.render));
}

PlanNumber number_of(const MemoryScene& scene, std::string_view name) {
  for (const PlanNumber& number : numbers_of(scene))
    if (number.name == name)
      return number;
  ADD_FAILURE() << "there is no number " << name;
  return {};
}

TEST(Numbers, StateTheirOrigin) {
  MemoryScene scene = cloud();
  scene.scene.render.passes = 64;
  EXPECT_EQ(number_of(scene, "neighbours").origin, NumberOrigin::measured);
  EXPECT_EQ(number_of(scene, "kernel scale").origin, NumberOrigin::standard);
  EXPECT_EQ(number_of(scene, "shadow rays per camera ray").origin, NumberOrigin::measured);
  EXPECT_EQ(number_of(scene, "walks per camera ray").origin, NumberOrigin::measured);
  EXPECT_GE(number_of(scene, "fit [pixels]").first, number_of(scene, "fit [pixels]").last);
  RenderSettings& render = scene.scene.render;
  render.photons = 20000;
  render.neighbours = 100;
  render.alpha = 0.7;
  render.direct_samples = 3;
  for (const std::string_view name :
       {"light paths", "neighbours", "kernel scale", "shadow rays per camera ray"})
    EXPECT_EQ(number_of(scene, name).origin, NumberOrigin::scene) << name;
  EXPECT_EQ(number_of(scene, "shadow rays per camera ray").first, 3);
  EXPECT_EQ(number_of(scene, "neighbours").first, 100);
  name_path(scene);
  EXPECT_TRUE(numbers_of(scene).empty());
}

TEST(Schedule, BeamIsTheBeamEstimateInEveryPass) {
  MemoryScene scene = cloud();
  name_beam(scene);
  const TestFrame frame(scene);
  const FramePasses passes(EstimatorType::beam, frame.input());
  for (const int pass : {0, 1, 100}) {
    const PassSpec spec = schedule(passes.choices(), scene.scene.render, pass);
    EXPECT_EQ(spec.estimator, "beam");
    EXPECT_EQ(spec.gather_walks, 0);
  }
}

TEST(Schedule, SaysWhatEachPassIs) {
  MemoryScene scene = cloud();
  scene.scene.render.passes = 100;
  scene.scene.render.estimator = EstimatorType::gather;
  const TestFrame frame(scene);
  const FramePasses passes(EstimatorType::gather, frame.input());
  const std::vector<PassSpec> list = list_passes(passes.choices(), scene.scene.render);
  ASSERT_FALSE(list.empty());
  EXPECT_EQ(list.front().pass, 0);
  EXPECT_EQ(list.back().pass, 99);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const PassSpec& spec = list[i];
    EXPECT_EQ(spec.estimator, "gather");
    EXPECT_GT(spec.gather_walks, 0);
    EXPECT_GT(spec.light_paths, 0u);
    EXPECT_GE(spec.peak_order, 4);
    if (i > 0) {
      EXPECT_LT(spec.kernel_scale, list[i - 1].kernel_scale);
      EXPECT_LE(spec.regression_radius, list[i - 1].regression_radius);
    }
  }
  // Half the photons of a kernel along rays.
  EXPECT_EQ(list[0].neighbours, 0.5 * passes.choices().photons.neighbours);
}

} // namespace
} // namespace vdbeam
