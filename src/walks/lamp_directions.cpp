#include "walks/lamp_directions.h"

#include "math/sampling.h"
#include "tuning/constants.h"
#include "walks/brightest.h"

#include <cmath>
#include <numbers>

namespace vdbeam {

LampDirections::LampDirections(const World& world, const LampShells& shells)
    : medium_(world.medium) {
  const auto power = [&](std::size_t l) { return max_component(world.lights[l].power()); };
  float all = 0;
  for (std::size_t l = 0; shells.any() && l < world.lights.size(); ++l)
    all += power(l);
  for (std::size_t l = 0; all > 0 && l < world.lights.size(); ++l)
    if (const double far = reach(shells, l); far > 0)
      lamps_.push_back({*world.lights[l].position(), far,
                        tuning::branches_per_scattering * power(l) / all,
                        static_cast<double>(world.lights[l].typical_intensity())});
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

LampDirections::Vertex::Vertex(const LampDirections& directions, const Vec3f& point)
    : medium_(directions.medium_), point_(point) {
  if (!directions.any())
    return;
  const auto irradiance = [&](const Lamp& lamp) {
    return irradiance_from(lamp.intensity, lamp.position - Vec3d(point));
  };
  find_brightest(directions.lamps_, irradiance, lamps_);
  std::erase_if(lamps_, [&](const Lamp* lamp) { return !lamp->reaches(point); });
}

std::optional<Vec3f> LampDirections::Vertex::sample(Rng& rng) const {
  float place = rng.uniform();
  for (const Lamp* lamp : lamps_) {
    if (place < lamp->chance) {
      const float u = rng.uniform(), v = rng.uniform();
      return sample_about(medium_, lamp->from(point_), u, v);
    }
    place -= lamp->chance;
  }
  return std::nullopt;
}

float LampDirections::Vertex::chance() const {
  float sum = 0;
  for (const Lamp* lamp : lamps_)
    sum += lamp->chance;
  return sum;
}

float LampDirections::Vertex::density(const Vec3f& direction) const {
  float sum = 0;
  for (const Lamp* lamp : lamps_)
    sum += lamp->chance * density_about(medium_, lamp->from(point_), direction);
  return sum;
}

} // namespace vdbeam
