#pragma once

#include "choose/choices.h"
#include "keys/estimator_kind.h"
#include "vdbeam/render_plan.h"

#include <optional>
#include <span>

namespace vdbeam {

/// Facts for the conditions of features.
struct FeatureFacts {
  const EstimatorInput& input;
  const EstimatorKind& kind;
  /// Per light: single scattering by shadow rays.
  std::vector<bool> sampled_lights;

  FeatureFacts(const EstimatorInput& input_, const EstimatorKind& kind_)
      : FeatureFacts(input_, kind_, input_.shadow_ray_lights()) {}
  FeatureFacts(const EstimatorInput& input_, const EstimatorKind& kind_,
               std::vector<bool> sampled_lights_)
      : input(input_), kind(kind_), sampled_lights(std::move(sampled_lights_)) {}

  bool needs(Stage stage) const { return input.plan.needs(stage); }
};

/// A condition that excludes a feature, with its reason.
struct FeatureCondition {
  bool (*excludes)(const FeatureFacts& facts);
  std::string_view clause; ///< why, as it ends "off: ..."
  /// The lights or volumes on whose account the feature is off; null: none in particular.
  std::string (*culprits)(const FeatureFacts& facts) = nullptr;
};

/// A part of the method that a frame's passes use or leave out: everything that choices, the plan,
/// the report and docs ask about it. The table below lists all of them.
struct Feature {
  std::string_view name;
  std::string_view key;  ///< of the scene file, which forces it; empty: none
  std::string_view help; ///< what it does, one clause
  /// The stage of the plan without which it is left out, with the plan's reason.
  std::optional<Stage> stage;
  std::span<const FeatureCondition> conditions;
  /// Whether it is used where nothing excludes it, by what the pilot measured; null: always.
  bool (*used)(const FeatureFacts& facts, const Choices& choices) = nullptr;
  std::string_view unused = {};         ///< clause for where the pilot leaves it out
  std::string_view whole = "the scene"; ///< what does without it where it is off
  /// What does without it where it is on: lights, volumes, paths or places; null: nothing.
  std::string (*rest)(const FeatureFacts& facts, const Choices& choices) = nullptr;
  /// Work or error that a pilot measured or forecast; null: none does.
  std::string (*cost)(const FeatureFacts& facts, const Choices& choices) = nullptr;
};

/// Every feature, in the order in which the plan lists them. A new one is its file and a line here.
std::span<const Feature* const> feature_table();

extern const Feature view_importance_feature, path_guide_feature, kernel_pilot_feature,
    forward_peak_feature, final_gather_feature, hidden_lights_feature, shadow_lattice_feature,
    boundary_share_feature, edges_feature, branches_feature;

/// Why a feature cannot be used; empty where nothing excludes it.
std::string why_excluded(const Feature& feature, const FeatureFacts& facts);
inline bool is_possible(const Feature& feature, const FeatureFacts& facts) {
  return why_excluded(feature, facts).empty();
}

/// All features with what was chosen, in the order of the table.
std::vector<FeatureChoice> describe_features(const EstimatorInput& input, const EstimatorKind& kind,
                                             const Choices& choices);

} // namespace vdbeam
