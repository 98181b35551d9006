#pragma once

#include "vdbeam/scene.h"

#include <array>
#include <memory>
#include <vector>

namespace vdbeam {

/// Draine's phase function (Draine 2003, eq. 4; as in Jendersie and d'Eon 2023, eq. 3):
///   p(cos) = 1 / (4 pi) * (1 - g^2) / (1 + g^2 - 2 g cos)^(3/2)
///            * (1 + alpha cos^2) / (1 + alpha (1 + 2 g^2) / 3)
/// alpha = 0 is Henyey-Greenstein, g = 0 and alpha = 1 Rayleigh, both 0 isotropic.
struct DraineLobe {
  float g = 0;
  float alpha = 0;
  float weight = 1; ///< weight of this lobe; the weights add up to 1
};

/// A blend of two lobes; the weight 0: there is only the other one.
struct PhaseLobes {
  DraineLobe first, second{.weight = 0};
};

/// A lobe with its constants precomputed, for scalar and SIMD evaluation. 1 + g^2 - 2 g cos is
/// computed as (1 - |g|)^2 + 2 |g| (1 -+ cos), a sum of positive terms, since the plain form loses
/// all digits where |g| is near 1.
struct PhaseTerm {
  float scale = 0.0795774715f; ///< weight / (4 pi) * (1 - g^2) / (1 + alpha (1 + 2 g^2) / 3)
  float base = 1;              ///< (1 - |g|)^2
  float slope = 0;             ///< 2 |g|
  float side = 1;              ///< sign of g
  float alpha = 0;

  float distance(float cos_theta) const {
    return base + slope * std::max(0.0f, 1 - side * cos_theta);
  }
  float value(float cos_theta) const {
    const float d = distance(cos_theta);
    return scale * (1 + alpha * cos_theta * cos_theta) / (d * std::sqrt(d));
  }
};

/// A phase function as a blend of at most two Draine lobes: every model of the table (PhaseKind)
/// has this form, so that the beam query needs one formula. cos_theta is between the directions of
/// travel before and after; 1 is straight ahead. For media without their forward peak
/// (truncate_peak) a phase function may also be a polynomial of the cosine, for evaluation in
/// integrals only, or a table, to draw directions from.
class PhaseFunction {
public:
  PhaseFunction() = default;
  /// Throws InputError for settings that the kind rejects, and for an unknown kind.
  explicit PhaseFunction(const PhaseSettings& settings);

  /// From the coefficients of the powers of the cosine, most_coefficients of them at most. Has no
  /// lobes and cannot be sampled.
  static PhaseFunction polynomial(const std::vector<double>& coefficients);
  static constexpr int most_coefficients = 12;
  /// From a table of equal shares: scattering has a cosine between cosines[i] and cosines[i + 1]
  /// with the same chance for every i, uniformly. `cosines`: increasing, from -1 to 1.
  static PhaseFunction table(std::vector<float> cosines);

  /// Value [1/sr]; integrates to 1 over the sphere.
  float evaluate(float cos_theta) const {
    if (coefficient_count_ > 0)
      return evaluate_polynomial(cos_theta);
    if (cosines_)
      return evaluate_table(cos_theta);
    const float first = terms_[0].value(cos_theta);
    return lobe_count_ == 1 ? first : first + terms_[1].value(cos_theta);
  }
  /// A direction of travel after scattering, distributed exactly as `evaluate`.
  /// u_lobe, u, v lie in [0, 1).
  Vec3f sample(const Vec3f& direction, float u_lobe, float u, float v) const;
  bool isotropic() const;

  /// Number of coefficients of a polynomial; 0: the function is given by lobes.
  int coefficient_count() const { return coefficient_count_; }
  float coefficient(int power) const { return coefficients_[power]; }

  /// Cosines of a tabulated function; null for others.
  const std::vector<float>* cosines() const { return cosines_.get(); }

  int lobe_count() const { return lobe_count_; }
  const DraineLobe& lobe(int i) const { return lobes_[i]; }
  const PhaseTerm& term(int i) const { return terms_[i]; }

private:
  void set_lobe(int i, const DraineLobe& lobe);
  float evaluate_table(float cos_theta) const;
  float evaluate_polynomial(float cos_theta) const {
    float value = 0;
    for (int i = coefficient_count_ - 1; i >= 0; --i)
      value = value * cos_theta + coefficients_[i];
    return value;
  }

  std::array<DraineLobe, 2> lobes_;
  std::array<PhaseTerm, 2> terms_;
  int lobe_count_ = 1;
  int coefficient_count_ = 0;
  std::array<float, most_coefficients> coefficients_{};
  std::shared_ptr<const std::vector<float>> cosines_;
};

} // namespace vdbeam
