// A new feature is one file and one line: this is the file.
#include "choose/feature.h"
#include "tables/toy_support.h"

#include <array>

namespace vdbeam {
namespace {

constexpr FeatureCondition conditions[] = {
    {[](const FeatureFacts& facts) { return !facts.kind.shoots_photons(); },
     "there are no photons to count"}};

/// Counts photons, or would.
const Feature photon_census_feature{.name = "photon census",
                                    .key = "",
                                    .help = "photons are counted twice",
                                    .stage = std::nullopt,
                                    .conditions = conditions};

} // namespace

std::span<const Feature* const> feature_table() {
  static constexpr std::array table{
      &view_importance_feature, &path_guide_feature,    &kernel_pilot_feature,
      &forward_peak_feature,    &final_gather_feature,  &shadow_lattice_feature,
      &boundary_share_feature,  &hidden_lights_feature, &edges_feature,
      &branches_feature,        &photon_census_feature};
  return table;
}

namespace {

FeatureChoice last_choice(const EstimatorType& type) {
  test::MemoryScene scene = test::lit_by(LightType::point, 1);
  scene.scene.render.estimator = type;
  const test::TestFrame frame(scene);
  return describe_features(frame.input(), estimator_kind(type), {}).back();
}

TEST(ToyFeature, IsDescribed) {
  const FeatureChoice on = last_choice(EstimatorType::march);
  EXPECT_EQ(on.name, "photon census");
  EXPECT_TRUE(on.on);
  EXPECT_EQ(on.reason, "photons are counted twice");
  const FeatureChoice off = last_choice(EstimatorType::path);
  EXPECT_FALSE(off.on);
  EXPECT_EQ(off.reason, "there are no photons to count");
}

} // namespace
} // namespace vdbeam
