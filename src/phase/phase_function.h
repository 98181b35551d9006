#pragma once

#include "vdbeam/scene.h"

#include <array>

namespace vdbeam {

/// Draine's phase function (Draine 2003, eq. 4; as in Jendersie and d'Eon 2023, eq. 3):
///   p(cos) = 1/(4 pi) * (1 - g^2) / (1 + g^2 - 2 g cos)^(3/2) * (1 + alpha cos^2) / (1 + alpha (1 + 2 g^2) / 3)
/// alpha = 0 is Henyey-Greenstein, g = 0 and alpha = 1 Rayleigh, both 0 isotropic.
struct DraineLobe {
  float g = 0;
  float alpha = 0;
  float weight = 1; ///< share of this lobe; the shares add up to 1
};

/// A phase function as a blend of at most two Draine lobes: every model that the scene file offers
/// has this form, so that the beam query needs one formula.
/// cos_theta is between the directions of travel before and after; 1 is straight on.
class PhaseFunction {
public:
  PhaseFunction() = default;
  explicit PhaseFunction(const PhaseSettings& settings);

  /// Value [1/sr]; integrates to 1 over the sphere.
  float evaluate(float cos_theta) const;
  /// A direction of travel after scattering, distributed exactly as `evaluate`.
  Vec3f sample(const Vec3f& direction, float u_lobe, float u, float v) const;
  /// Mean cosine.
  float mean_cosine() const;
  bool isotropic() const;

  int lobe_count() const { return lobe_count_; }
  const DraineLobe& lobe(int i) const { return lobes_[i]; }

private:
  std::array<DraineLobe, 2> lobes_;
  int lobe_count_ = 1;
};

} // namespace vdbeam
