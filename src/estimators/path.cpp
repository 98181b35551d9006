#include "estimators/path.h"

#include "estimators/camera_ray.h"
#include "estimators/pixel_tiles.h"
#include "transport/optical_depth.h"
#include "transport/scattering.h"

#include <chrono>

namespace vdbeam {

struct PathEstimator::Outputs {
  Rgb direct, indirect, background;
  float opacity = 0;
  float depth = 0; ///< of the first collision, render units; 0 if none
};

struct PathEstimator::State {
  Ray ray;
  Rgb throughput{1, 1, 1};
  int bounces = 0;
  float phase_pdf = 0; ///< of ray.direction, after a scattering
  Vec3f scatter_point;
};

/// Light that a ray meets where it leaves the scene, weighted against next-event estimation
/// (balance heuristic, Veach and Guibas 1995).
Rgb PathEstimator::escape(const State& state) const {
  Rgb sum;
  for (std::size_t i = 0; i < input_.world.lights.size(); ++i) {
    const Light& light = input_.world.lights[i];
    if (light.is_delta())
      continue;
    float weight = 1;
    if (state.bounces > 0 && light.wants_shadow_rays())
      weight = state.phase_pdf /
               (state.phase_pdf + light.incident_pdf(state.scatter_point, state.ray.direction));
    sum += light.escaped_radiance(state.ray.direction) * weight;
  }
  return sum * state.throughput;
}

/// Next-event estimation at state.scatter_point, from all lights that want it.
Rgb PathEstimator::light(const State& state, const PhaseFunction& phase, Rng& rng) const {
  Rgb sum;
  for (std::size_t i = 0; i < input_.world.lights.size(); ++i) {
    const Light& light = input_.world.lights[i];
    if (!light.wants_shadow_rays())
      continue;
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample sample = light.sample_incident(state.scatter_point, u, v);
    if (max_component(sample.value) <= 0)
      continue;
    const float p = phase.evaluate(dot(state.ray.direction, sample.wi));
    const float weight = sample.pdf > 0 ? sample.pdf / (sample.pdf + p) : 1;
    const Ray shadow{state.scatter_point, sample.wi};
    sum += sample.value * (p * weight) *
           ratio_transmittance(input_.world.medium, shadow, sample.distance, rng);
  }
  return sum * state.throughput;
}

void PathEstimator::trace(const CameraRay& camera_ray, Rng& rng, Outputs& out) const {
  const World& world = input_.world;
  State state;
  state.ray = camera_ray.ray;
  while (true) {
    const Collision hit = next_scattering(world.medium, state.ray, state.throughput, rng);
    if (hit.volume == nullptr) {
      Rgb& target =
          state.bounces == 0 ? out.background : (state.bounces == 1 ? out.direct : out.indirect);
      target += escape(state);
      return;
    }
    if (state.bounces == 0) {
      out.opacity = 1;
      out.depth = hit.t;
    }
    if (world.settings.max_bounces && state.bounces >= *world.settings.max_bounces)
      return;
    if (!survive_scattering(hit.volume->albedo, state.throughput, rng))
      return;
    const PhaseFunction& phase = world.medium.phases[hit.volume->group];
    state.scatter_point = state.ray.at(hit.t);
    (state.bounces == 0 ? out.direct : out.indirect) += light(state, phase, rng);
    const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    const Vec3f direction = phase.sample(state.ray.direction, u_lobe, u, v);
    state.phase_pdf = phase.evaluate(dot(state.ray.direction, direction));
    state.ray = {state.scatter_point, direction};
    ++state.bounces;
  }
}

void PathEstimator::render_pass(int pass, PassImage& image, RenderStatistics& statistics) {
  const auto start = std::chrono::steady_clock::now();
  const Camera& camera = input_.camera;
  const RngKey key{input_.world.settings.seed, input_.frame, static_cast<std::uint64_t>(pass)};
  image.resize(camera.width(), camera.height());
  for_each_tile(camera.width(), camera.height(), [&](int x0, int y0, int x1, int y1) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * camera.width() + x;
        Rng rng(key, RngStage::path, pixel);
        const double px = x + static_cast<double>(rng.uniform());
        const double py = y + static_cast<double>(rng.uniform());
        const CameraRay ray = camera_ray(input_.world, camera, px, py);
        Outputs out;
        trace(ray, rng, out);
        image.direct[pixel] = out.direct;
        image.indirect[pixel] = out.indirect;
        image.background[pixel] = out.background;
        image.opacity[pixel] = out.opacity;
        if (out.opacity > 0)
          image.depth[pixel] =
              static_cast<float>((out.depth + ray.shift) / input_.world.space.scale);
      }
  });
  statistics.camera_rays += static_cast<std::uint64_t>(image.width) * image.height;
  statistics.path +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace vdbeam
