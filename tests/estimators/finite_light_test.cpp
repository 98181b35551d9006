// A light that rays meet at a finite distance, in the middle of the medium: a hollow sphere that
// shines inwards. It shows that every estimator asks lights where they are met.
#include "lights/light.h"
#include "math/sampling.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

/// Radiance 1 from the inner side of a sphere around the origin of render space.
class HollowSphere final : public Light {
public:
  explicit HollowSphere(float radius) : radius_(radius) {}

  IncidentSample sample_incident(const Vec3f& point, float u, float v) const override {
    const Vec3f wi = sample_sphere(u, v);
    const LightHit hit = emitted_radiance({{point, wi}});
    return {wi, hit.distance, hit.radiance * (4 * pi), density};
  }
  float incident_pdf(const Vec3f&, const Vec3f&) const override { return density; }
  LightHit emitted_radiance(const Segment& segment) const override {
    const Ray& ray = segment.ray;
    const float b = dot(ray.origin, ray.direction);
    const float square = b * b - dot(ray.origin, ray.origin) + radius_ * radius_;
    const float t = square > 0 ? std::sqrt(square) - b : -infinity;
    if (t > segment.t_begin && t <= segment.t_end)
      return {Rgb(1), t};
    return {};
  }
  bool has_extent() const override { return true; }
  EmittedPhoton emit(double place, Rng& rng) const override {
    const Vec3f normal = sample_sphere(static_cast<float>(place), rng.uniform());
    const float radius = std::sqrt(rng.uniform()), phi = 2 * pi * rng.uniform();
    Vec3f u, v;
    orthonormal_frame(normal, u, v);
    const Vec3f direction =
        (u * std::cos(phi) + v * std::sin(phi)) * radius - normal * std::sqrt(1 - radius * radius);
    return {{normal * radius_, direction}, power()};
  }
  Rgb power() const override { return Rgb(4 * pi * pi * radius_ * radius_); }
  bool is_delta() const override { return false; }

private:
  static constexpr float density = 1 / (4 * pi);

  float radius_;
};

/// A box of edge 1 about the origin, seen along z. Render space has its units.
MemoryScene box(const Rgb& albedo) {
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box(Vec3d(-0.5), Vec3d(0.5));
  volume.extinction = 3;
  volume.albedo = albedo;
  volume.phase = henyey_greenstein(0.5);
  scene.look({0, 0, 2}, {0, 0, 0}, 12, 12, 12);
  scene.scene.render.photons = 30000;
  scene.scene.render.max_radius = 0.05;
  return scene;
}

std::array<Samples, 3> render_sphere(MemoryScene scene, EstimatorType type, float radius,
                                     bool shadow_rays, int passes) {
  WorldFacts facts;
  World world = scene.world(&facts);
  EXPECT_EQ(world.space.scale, 1);
  world.lights.add(std::make_unique<HollowSphere>(radius));
  const Camera camera(scene.scene.camera, scene.scene.image, world.space);
  // No scene file can hold such a light: for the plan an environment stands in for it.
  scene.add_light(LightType::environment);
  scene.scene.render.estimator = type;
  RenderPlan plan = plan_stages(scene.scene, volume_facts(facts, world, camera));
  plan.shadow_ray_lights = {shadow_rays};
  const std::unique_ptr<PassRenderer> estimator =
      make_pass_renderer(type, {world, camera, scene.scene.render, plan});
  std::array<Samples, 3> means;
  RenderStatistics statistics;
  for (int pass = 0; pass < passes; ++pass) {
    PassImage image;
    estimator->render_pass(pass, image, statistics);
    std::vector<Rgb> total;
    for (std::size_t i = 0; i < image.direct.size(); ++i)
      total.push_back(image.total(i));
    add_means(means, total);
  }
  return means;
}

TEST(FiniteLight, IsSeenThroughTheMediumInFrontOfIt) {
  MemoryScene scene = box(Rgb(0));
  scene.look({0, 0, 2}, {0, 0, 0}, 0.01, 1, 1);
  const std::array<Samples, 3> means = render_sphere(scene, EstimatorType::path, 0.3f, true, 2);
  // From the face at z = 0.5 to the far side of the sphere.
  EXPECT_NEAR(means[0].mean(), std::exp(-3 * 0.8), 1e-4);
}

TEST(FiniteLight, AroundEverythingIsAFurnace) {
  for (const bool shadow_rays : {false, true})
    for (const std::array<Samples, 3> means =
             render_sphere(box(Rgb(1)), EstimatorType::path, 3, shadow_rays, 32);
         const Samples& samples : means) {
      expect_mean(samples, 1);
      EXPECT_LT(samples.error(), 5e-3);
    }
}

/// Shadow rays with their multiple importance sampling, rays that meet the light by chance, and
/// photons find the same light.
TEST(FiniteLight, IsTheSameHoweverItIsFound) {
  for (const Rgb& scale : {Rgb(1), Rgb(1, 0.5f, 0.2f)}) {
    MemoryScene scene = box({0.9f, 0.8f, 0.7f});
    scene.scene.volumes[0].extinction_scale = scale;
    const auto met = render_sphere(scene, EstimatorType::path, 0.3f, false, 64);
    const auto sampled = render_sphere(scene, EstimatorType::path, 0.3f, true, 64);
    const auto photons = render_sphere(scene, EstimatorType::beam, 0.3f, false, 32);
    const auto mixed = render_sphere(scene, EstimatorType::beam, 0.3f, true, 32);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LT(met[c].error(), 0.01 * met[c].mean());
      expect_same_mean(met[c], sampled[c]);
      expect_same_mean(met[c], photons[c], 0.02 * met[c].mean()); // kernels blur
      expect_same_mean(met[c], mixed[c], 0.02 * met[c].mean());
    }
  }
}

} // namespace
} // namespace vdbeam
