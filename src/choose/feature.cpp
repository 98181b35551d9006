#include "choose/feature.h"

namespace vdbeam {

namespace {

/// The reason why a feature cannot be used, and the lights, volumes or paths that lack it then.
struct Exclusion {
  std::string reason, scope;
};

std::optional<Exclusion> find_exclusion(const Feature& feature, const FeatureFacts& facts) {
  if (feature.stage)
    for (const PlanStage& stage : facts.input.plan.stages)
      if (stage.stage == *feature.stage && !stage.needed)
        return Exclusion{stage.reason, "the scene"};
  for (const FeatureCondition& condition : feature.conditions)
    if (condition.excludes(facts)) {
      std::string scope(feature.whole);
      if (condition.culprits)
        scope += ", because of " + condition.culprits(facts);
      return Exclusion{std::string(condition.clause), scope};
    }
  return std::nullopt;
}

} // namespace

std::string why_excluded(const Feature& feature, const FeatureFacts& facts) {
  const std::optional<Exclusion> exclusion = find_exclusion(feature, facts);
  return exclusion ? exclusion->reason : std::string();
}

std::vector<FeatureChoice> describe_features(const EstimatorInput& input, const EstimatorKind& kind,
                                             const Choices& choices) {
  const FeatureFacts before(input, kind);
  const FeatureFacts facts(input, kind,
                           choices.photons.sampled_lights.empty() ? before.sampled_lights
                                                                  : choices.photons.sampled_lights);
  std::vector<FeatureChoice> described;
  for (const Feature* feature : feature_table()) {
    FeatureChoice choice{feature->name, feature->key, false, {}, {}, {}};
    if (const std::optional<Exclusion> exclusion = find_exclusion(*feature, before)) {
      choice.reason = exclusion->reason;
      choice.scope = exclusion->scope;
    } else {
      choice.on = !feature->used || feature->used(facts, choices);
      choice.reason = choice.on ? feature->help : feature->unused;
      if (!choice.on)
        choice.scope = feature->whole;
      else if (feature->rest)
        choice.scope = feature->rest(facts, choices);
      if (feature->cost)
        choice.cost = feature->cost(facts, choices);
    }
    described.push_back(std::move(choice));
  }
  return described;
}

} // namespace vdbeam
