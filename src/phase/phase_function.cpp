#include "phase/phase_function.h"

#include "math/sampling.h"
#include "phase/draine.h"
#include "vdbeam/error.h"

#include <fmt/core.h>

#include <algorithm>

namespace vdbeam {
namespace {

void require(bool valid, const char* key, const char* range, double value) {
  if (!valid)
    throw InputError(fmt::format("phase.{} must lie in {}, got {}", key, range, value));
}

DraineLobe henyey_greenstein(const char* key, double g, double weight) {
  // Single precision must not round g to 1, where the lobe is a delta function.
  require(std::abs(g) < 1 && std::abs(static_cast<float>(g)) < 1, key, "(-1, 1)", g);
  return {static_cast<float>(g), 0, static_cast<float>(weight)};
}

struct LobePair {
  std::array<DraineLobe, 2> lobes;
};

// Jendersie and d'Eon, "An Approximate Mie Scattering Function for Fog and Cloud Rendering",
// SIGGRAPH 2023 Talks, eqs. 4-7: fits for water droplets of 5 to 50 micrometres.
LobePair mie(double diameter) {
  require(diameter >= 5 && diameter <= 50, "droplet_diameter", "[5, 50]", diameter);
  const double g_hg = std::exp(-0.0990567 / (diameter - 1.67154));
  const double g_d = std::exp(-2.20679 / (diameter + 3.91029) - 0.428934);
  const double alpha = std::exp(3.62489 - 8.29288 / (diameter + 5.52825));
  const double w_d = std::exp(-0.599085 / (diameter - 0.641583) - 0.665888);
  return {
      {DraineLobe{static_cast<float>(g_hg), 0, static_cast<float>(1 - w_d)},
       DraineLobe{static_cast<float>(g_d), static_cast<float>(alpha), static_cast<float>(w_d)}}};
}

LobePair lobes_of(const PhaseSettings& settings) {
  constexpr DraineLobe none{0, 0, 0};
  switch (settings.type) {
  case PhaseType::isotropic:
    return {{DraineLobe{0, 0, 1}, none}};
  case PhaseType::henyey_greenstein:
    return {{henyey_greenstein("g", settings.g, 1), none}};
  case PhaseType::rayleigh:
    return {{DraineLobe{0, 1, 1}, none}};
  case PhaseType::two_lobe:
    require(settings.blend >= 0 && settings.blend <= 1, "blend", "[0, 1]", settings.blend);
    return {{henyey_greenstein("g", settings.g, 1 - settings.blend),
             henyey_greenstein("g2", settings.g2, settings.blend)}};
  case PhaseType::mie:
    return mie(settings.droplet_diameter);
  }
  return {{DraineLobe{0, 0, 1}, none}};
}

} // namespace

PhaseFunction::PhaseFunction(const PhaseSettings& settings) {
  auto [lobes] = lobes_of(settings);
  const bool same = lobes[0].g == lobes[1].g && lobes[0].alpha == lobes[1].alpha;
  if (lobes[0].weight <= 0 || same)
    lobes[0] = lobes[1], lobes[0].weight = 1, lobes[1].weight = 0;
  if (lobes[1].weight <= 0)
    lobes[0].weight = 1;
  else
    lobe_count_ = 2;
  for (int i = 0; i < lobe_count_; ++i)
    set_lobe(i, lobes[i]);
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
