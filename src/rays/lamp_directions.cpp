#include "rays/lamp_directions.h"

#include "math/sampling.h"
#include "tuning/constants.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {

LampDirections::LampDirections(const World& world, const LampShells& shells)
    : medium_(world.medium) {
  for (std::size_t l = 0; l < world.lights.size(); ++l)
    if (const double far = reach(shells, l); far > 0)
      lamps_.push_back({*world.lights[l].position(), far});
}

double LampDirections::reach(const LampShells& shells, std::size_t light) {
  return tuning::reach_of_branches * shells.radius_of(light);
}

Vec3f LampDirections::sample_about(const Medium& medium, const Vec3f& to_lamp, float u, float v) {
  const double share{u};
  const double angle = medium.angles ? medium.angles->inverse(share) : share * std::numbers::pi;
  Vec3f tangent, bitangent;
  orthonormal_frame(to_lamp, tangent, bitangent);
  const auto sine = static_cast<float>(std::sin(angle)), phi = 2 * pi * v;
  return normalize(tangent * (sine * std::cos(phi)) + bitangent * (sine * std::sin(phi)) +
                   to_lamp * static_cast<float>(std::cos(angle)));
}

float LampDirections::density_about(const Medium& medium, const Vec3f& to_lamp,
                                    const Vec3f& direction) {
  // By the cross product: near the lamp the cosine has no digits left for the sine.
  const double sine = std::max(1e-7, double{length(cross(to_lamp, direction))});
  const double angle = std::atan2(sine, double{dot(to_lamp, direction)});
  const double of_angle = medium.angles ? medium.angles->density(angle) : 1 / std::numbers::pi;
  return static_cast<float>(of_angle / (2 * std::numbers::pi * sine));
}

std::size_t LampDirections::count_near(const Vec3f& point) const {
  return static_cast<std::size_t>(
      std::count_if(lamps_.begin(), lamps_.end(), [&](const Lamp& l) { return l.reaches(point); }));
}

std::optional<Vec3f> LampDirections::sample(const Vec3f& point, Rng& rng) const {
  const std::size_t count = count_near(point);
  if (count == 0)
    return std::nullopt;
  const auto drawn = static_cast<std::size_t>(rng.uniform() * static_cast<float>(count));
  std::size_t skipped = std::min(drawn, count - 1);
  const auto lamp = std::find_if(lamps_.begin(), lamps_.end(),
                                 [&](const Lamp& l) { return l.reaches(point) && skipped-- == 0; });
  const float u = rng.uniform(), v = rng.uniform();
  return sample_about(medium_, lamp->from(point), u, v);
}

float LampDirections::density(const Vec3f& point, const Vec3f& direction) const {
  const std::size_t count = count_near(point);
  float sum = 0;
  for (const Lamp& lamp : lamps_)
    if (lamp.reaches(point))
      sum += density_about(medium_, lamp.from(point), direction);
  return count > 0 ? sum / static_cast<float>(count) : 0;
}

} // namespace vdbeam
