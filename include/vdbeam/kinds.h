#pragma once

#include <string_view>

namespace vdbeam {

/// A kind of light, by its name in the table of lights (src/lights/light_table.cpp). The name is
/// not copied: a literal, or the table's own.
struct LightType {
  std::string_view name;
  static const LightType distant, point, spot, environment, sky;
  bool operator==(const LightType&) const = default;
};
inline constexpr LightType LightType::distant{"distant"}, LightType::point{"point"},
    LightType::spot{"spot"}, LightType::environment{"environment"}, LightType::sky{"sky"};

/// An estimator, by its name in the table of estimators (src/estimators/estimator_table.cpp). The
/// name is not copied: a literal, or the table's own.
struct EstimatorType {
  std::string_view name;
  static const EstimatorType automatic, beam, gather, march, path;
  bool operator==(const EstimatorType&) const = default;
};
inline constexpr EstimatorType EstimatorType::automatic{"auto"}, EstimatorType::beam{"beam"},
    EstimatorType::gather{"gather"}, EstimatorType::march{"march"}, EstimatorType::path{"path"};

} // namespace vdbeam
