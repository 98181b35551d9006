#pragma once

#include "support/memory_scene.h"

#include <fmt/format.h>

namespace vdbeam::test {

/// Draws scenes from the whole parameter space; a pure function of the seed.
class RandomScene {
public:
  explicit RandomScene(std::uint64_t seed) : rng_({seed, 0, 0}, RngStage::test, 0) {
    size_ = log_uniform(1e-4, 1e4);
    center_ = random_point(chance(0.2) ? 1e4 * size_ : 0.0);
    const int volumes = chance(0.25) ? 2 : 1;
    for (int i = 0; i < volumes; ++i)
      add_volume();
    furnace_ = chance(0.3);
    if (furnace_)
      add_light(LightType::environment).radiance = Rgb(1);
    else
      add_lights();
    choose_camera();
    choose_settings();
    scene_.scene.render.seed = seed;
  }

  const MemoryScene& scene() const { return scene_; }
  /// A sky of 1 and nothing else: no ray may see more than 1.
  bool furnace() const { return furnace_; }
  /// A furnace whose media absorb nothing, with paths of any length: every ray sees 1.
  bool white_furnace() const {
    return furnace_ && !scene_.scene.render.max_bounces &&
           std::all_of(scene_.scene.volumes.begin(), scene_.scene.volumes.end(),
                       [](const VolumeSettings& v) { return v.albedo == Rgb(1); });
  }
  const std::string& description() const { return description_; }

private:
  double uniform(double a, double b) { return a + (b - a) * static_cast<double>(rng_.uniform()); }
  double log_uniform(double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); }
  bool chance(double p) { return static_cast<double>(rng_.uniform()) < p; }
  int pick(int n) { return std::min(n - 1, static_cast<int>(uniform(0, n))); }
  float real(double a, double b) { return static_cast<float>(uniform(a, b)); }
  Vec3d random_point(double extent) {
    const double x = uniform(-extent, extent), y = uniform(-extent, extent);
    return {x, y, uniform(-extent, extent)};
  }
  Vec3d random_direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * std::numbers::pi);
    const double s = std::sqrt(1 - z * z);
    return {s * std::cos(angle), s * std::sin(angle), z};
  }
  Rgb random_colour(double low, double high) {
    if (chance(0.6))
      return Rgb(real(low, high));
    const float r = real(low, high), g = real(low, high);
    return {r, g, real(low, high)};
  }
  template <class... Values>
  void note(fmt::format_string<Values...> format, Values&&... values) {
    description_ += fmt::format(format, std::forward<Values>(values)...) + ", ";
  }

  DensityField random_field(const Vec3<int>& cells) {
    const std::uint64_t noise_seed = rng_.bits();
    const int kind = pick(5);
    note("field {}", kind);
    return closed_field(cells, [=](int i, int j, int k) {
      const double noise = lattice_noise(i, j, k, noise_seed);
      switch (kind) {
      case 0:
        return 1.0;
      case 1:
        return noise;
      case 2:
        return noise > 0.9 ? 1.0 : 0.0;
      case 3:
        return noise > 0.995 ? 1.0 : 1e-3;
      default:
        return static_cast<double>(i + 2 * j) / 64;
      }
    });
  }

  void add_volume() {
    const Vec3<int> cells{1 + pick(2), 1 + pick(2), 1 + pick(2)};
    const Vec3d half =
        Vec3d{log_uniform(0.1, 1), log_uniform(0.1, 1), log_uniform(0.1, 1)} * (size_ * 0.5);
    const Vec3d at = center_ + random_point(0.3 * size_);
    Affine move;
    move.translation = at;
    const Affine map =
        move.after(turn(random_direction(), uniform(0, 360))).after(box_map(cells, -half, half));
    VolumeSettings& volume = scene_.add(random_field(cells), map);
    const double depth = log_uniform(1e-3, 300);
    volume.extinction = depth / max_component(half) / 2;
    if (chance(0.25))
      volume.extinction_scale = {real(0, 1), 1, chance(0.3) ? 0.0f : real(0, 1)};
    volume.albedo = chance(0.4) ? Rgb(1) : chance(0.1) ? Rgb(0) : random_colour(0.2, 1);
    choose_phase(volume.phase);
    note("depth {:.3g}, albedo {:.3g} {:.3g} {:.3g}, scale {:.3g} 1 {:.3g}", depth, volume.albedo.x,
         volume.albedo.y, volume.albedo.z, volume.extinction_scale.x, volume.extinction_scale.z);
  }

  void choose_phase(PhaseSettings& phase) {
    constexpr PhaseType types[] = {PhaseType::isotropic, PhaseType::henyey_greenstein,
                                   PhaseType::rayleigh, PhaseType::two_lobe, PhaseType::mie};
    phase.type = types[pick(5)];
    phase.g = uniform(-0.9, 0.9);
    phase.g2 = uniform(-0.9, 0.9);
    phase.blend = uniform(0, 1);
    phase.droplet_diameter = uniform(5, 50);
    note("phase {} g {:.3g}", phase.type.name, phase.g);
  }

  LightSettings& add_light(LightType type) { return scene_.add_light(type); }

  void add_lights() {
    const int count = 1 + pick(3);
    for (int i = 0; i < count; ++i) {
      constexpr LightType types[] = {LightType::distant, LightType::point, LightType::spot,
                                     LightType::environment};
      LightSettings& light = add_light(types[pick(4)]);
      light.irradiance = light.radiance = random_colour(0, 2);
      light.direction = random_direction();
      light.angular_radius = chance(0.5) ? 0 : uniform(0.1, 60);
      const Vec3d away = random_direction() * (size_ * uniform(1.2, 10));
      light.position = center_ + away;
      if (light.type == LightType::spot)
        light.direction = away * -1.0 + random_point(0.3 * size_);
      light.cone_angle = uniform(10, 80);
      light.cone_falloff = uniform(0, light.cone_angle);
      light.intensity = random_colour(0, 2) * static_cast<float>(dot(away, away));
      note("light {}", light.type.name);
    }
  }

  void choose_camera() {
    const double distance = size_ * (chance(0.15) ? uniform(0.01, 0.3) : log_uniform(1, 1e4));
    const Vec3d position = center_ + random_direction() * distance;
    const double fov =
        std::min(120.0, 2 * std::atan(0.5 * size_ / distance) * 180 / std::numbers::pi);
    scene_.look(position, center_ + random_point(0.1 * size_), fov, 1 + pick(12), 1 + pick(12));
    note("camera {:.3g}", distance / size_);
  }

  void choose_settings() {
    RenderSettings& render = scene_.scene.render;
    render.photons = static_cast<std::uint64_t>(log_uniform(1000, 8000));
    render.store = chance(0.2) ? PhotonStore::scatter : PhotonStore::fluence;
    constexpr DirectLight directs[] = {DirectLight::automatic, DirectLight::sampled,
                                       DirectLight::photons};
    render.direct = directs[pick(3)];
    constexpr KernelShape shapes[] = {KernelShape::constant, KernelShape::epanechnikov,
                                      KernelShape::biweight};
    render.kernel_shape = shapes[pick(3)];
    render.neighbours = chance(0.5) ? 0 : 1 + pick(200);
    if (chance(0.2)) {
      render.kernel = KernelRadius::fixed;
      render.radius = size_ * log_uniform(0.02, 0.3);
    }
    if (chance(0.2))
      render.max_bounces = 1 + pick(4);
    note("store {}, direct {}, kernel {} {}, neighbours {}, photons {}",
         static_cast<int>(render.store), static_cast<int>(render.direct),
         static_cast<int>(render.kernel), static_cast<int>(render.kernel_shape), render.neighbours,
         *render.photons);
  }

  Rng rng_;
  MemoryScene scene_;
  double size_ = 1;
  Vec3d center_;
  bool furnace_ = false;
  std::string description_;
};

} // namespace vdbeam::test
