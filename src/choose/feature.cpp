#include "choose/feature.h"

namespace vdbeam {

std::string why_excluded(const Feature& feature, const FeatureFacts& facts) {
  if (feature.stage)
    for (const PlanStage& stage : facts.input.plan.stages)
      if (stage.stage == *feature.stage && !stage.needed)
        return stage.reason;
  for (const FeatureCondition& condition : feature.conditions)
    if (condition.excludes(facts))
      return std::string(condition.clause);
  return {};
}

std::vector<FeatureChoice> describe_features(const EstimatorInput& input, const EstimatorKind& kind,
                                             const Choices& choices) {
  const FeatureFacts before(input, kind);
  const FeatureFacts facts(input, kind,
                           choices.photons.sampled_lights.empty() ? before.sampled_lights
                                                                  : choices.photons.sampled_lights);
  std::vector<FeatureChoice> described;
  for (const Feature* feature : feature_table()) {
    FeatureChoice choice{feature->name, feature->key, false, why_excluded(*feature, facts)};
    if (choice.reason.empty()) {
      choice.on = !feature->used || feature->used(facts, choices);
      choice.reason = choice.on ? feature->help : feature->unused;
    }
    described.push_back(std::move(choice));
  }
  return described;
}

} // namespace vdbeam
