#include "report/plan_text.h"

#include <fmt/format.h>

namespace vdbeam {

std::string range_text(const PlanNumber& number) {
  const auto text = [](double value) {
    return value >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
  };
  return number.first == number.last ? text(number.first)
                                     : text(number.first) + " to " + text(number.last);
}

std::string features_text(const RenderPlan& plan) {
  std::string text;
  for (const FeatureChoice& feature : plan.features) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", feature.name,
                        feature.on ? "on" : fmt::format("off ({})", feature.reason));
    if (!feature.scope.empty())
      text += (feature.on ? ", but for " : " for ") + feature.scope;
    if (!feature.cost.empty())
      text += fmt::format(" [{}]", feature.cost);
  }
  return text;
}

std::string numbers_text(const RenderPlan& plan) {
  std::string text;
  for (const PlanNumber& number : plan.numbers)
    text += fmt::format("{}{}: {} ({})", text.empty() ? "" : "; ", number.name, range_text(number),
                        origin_name(number.origin));
  return text;
}

} // namespace vdbeam
