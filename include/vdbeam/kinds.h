#pragma once

#include <string_view>

namespace vdbeam {

/// A kind of light, by its name in the table of lights (src/lights/light_table.cpp). The name is
/// not copied: a literal, or the table's own.
struct LightType {
  std::string_view name;
  static const LightType distant, point, spot, environment, sky, atmosphere, sun;
  bool operator==(const LightType&) const = default;
};
inline constexpr LightType LightType::distant{"distant"}, LightType::point{"point"},
    LightType::spot{"spot"}, LightType::environment{"environment"}, LightType::sky{"sky"},
    LightType::atmosphere{"atmosphere"}, LightType::sun{"sun"};

/// A phase function, by its name in the table of phase functions (src/phase/phase_table.cpp). The
/// name is not copied: a literal, or the table's own.
struct PhaseType {
  std::string_view name;
  static const PhaseType isotropic, henyey_greenstein, rayleigh, two_lobe, mie;
  bool operator==(const PhaseType&) const = default;
};
inline constexpr PhaseType PhaseType::isotropic{"isotropic"},
    PhaseType::henyey_greenstein{"henyey_greenstein"}, PhaseType::rayleigh{"rayleigh"},
    PhaseType::two_lobe{"two_lobe"}, PhaseType::mie{"mie"};

/// A material, by its name in the table of materials (src/materials/material_table.cpp); its model
/// is in docs/theory/surfaces.md. The name is not copied: a literal, or the table's own.
struct MaterialType {
  std::string_view name;
  static const MaterialType diffuse, standard, mirror, conductor, dielectric, emissive, holdout,
      shadow_catcher;
  bool operator==(const MaterialType&) const = default;
};
inline constexpr MaterialType MaterialType::diffuse{"diffuse"}, MaterialType::standard{"standard"},
    MaterialType::mirror{"mirror"}, MaterialType::conductor{"conductor"},
    MaterialType::dielectric{"dielectric"}, MaterialType::emissive{"emissive"},
    MaterialType::holdout{"holdout"}, MaterialType::shadow_catcher{"shadow_catcher"};

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
