#include "phase/phase_function.h"

#include "math/sampling.h"
#include "phase/draine.h"
#include "phase/phase_table.h"
#include "vdbeam/error.h"

#include <fmt/core.h>

#include <algorithm>

namespace vdbeam {

PhaseFunction::PhaseFunction(const PhaseSettings& settings) {
  const PhaseKind& kind = phase_kind(settings.type);
  if (const auto complaint = kind.complaint(settings))
    throw InputError(fmt::format("phase.{} {}", complaint->key, complaint->text));
  const auto [first, second] = kind.lobes(settings);
  const bool same = first.g == second.g && first.alpha == second.alpha;
  if (first.weight > 0 && second.weight > 0 && !same) {
    lobe_count_ = 2;
    set_lobe(0, first);
    set_lobe(1, second);
  } else {
    DraineLobe only = first.weight > 0 ? first : second;
    only.weight = 1;
    set_lobe(0, only);
  }
}

PhaseFunction PhaseFunction::polynomial(const std::vector<double>& coefficients) {
  PhaseFunction result;
  result.lobe_count_ = 0;
  result.coefficient_count_ = static_cast<int>(coefficients.size());
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    result.coefficients_[i] = static_cast<float>(coefficients[i]);
  return result;
}

PhaseFunction PhaseFunction::table(std::vector<float> cosines) {
  PhaseFunction result;
  result.lobe_count_ = 0;
  result.cosines_ = std::make_shared<const std::vector<float>>(std::move(cosines));
  return result;
}

float PhaseFunction::evaluate_table(float cos_theta) const {
  const std::vector<float>& c = *cosines_;
  const auto above = std::upper_bound(c.begin() + 1, c.end() - 1, cos_theta);
  const float share = 1 / static_cast<float>(c.size() - 1);
  return share / (2 * pi * (*above - *(above - 1)));
}

void PhaseFunction::set_lobe(int i, const DraineLobe& lobe) {
  lobes_[i] = lobe;
  const double g = std::abs(static_cast<double>(lobe.g)), alpha = lobe.alpha;
  const double norm = 1 + alpha * (1 + 2 * g * g) / 3;
  terms_[i].scale =
      static_cast<float>(lobe.weight / (4 * 3.14159265358979323846) * (1 - g) * (1 + g) / norm);
  terms_[i].base = static_cast<float>((1 - g) * (1 - g));
  terms_[i].slope = static_cast<float>(2 * g);
  terms_[i].side = lobe.g < 0 ? -1.0f : 1.0f;
  terms_[i].alpha = lobe.alpha;
}

Vec3f PhaseFunction::sample(const Vec3f& direction, float u_lobe, float u, float v) const {
  float x = 0; // 1 - cos
  if (cosines_) {
    const float place = u * static_cast<float>(cosines_->size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place), cosines_->size() - 2);
    const float* c = cosines_->data() + i;
    x = 1 - (c[0] + (c[1] - c[0]) * (place - static_cast<float>(i)));
  } else {
    const DraineLobe& lobe = lobes_[lobe_count_ == 2 && u_lobe >= lobes_[0].weight ? 1 : 0];
    x = sample_draine_one_minus_cos(lobe.g, lobe.alpha, u);
  }
  const float sin_theta = std::sqrt(x * (2 - x)); // exact for small angles, unlike 1 - cos^2
  const float phi = 2 * pi * v;
  Vec3f tangent, bitangent;
  orthonormal_frame(direction, tangent, bitangent);
  return normalize(tangent * (sin_theta * std::cos(phi)) + bitangent * (sin_theta * std::sin(phi)) +
                   direction * (1 - x));
}

bool PhaseFunction::isotropic() const {
  if (coefficient_count_ > 1 || cosines_)
    return false;
  for (int i = 0; i < lobe_count_; ++i)
    if (lobes_[i].g != 0 || lobes_[i].alpha != 0)
      return false;
  return true;
}

} // namespace vdbeam
