// Plastic and metal have not much more noise than matt surfaces.
#include "support/render_passes.h"
#include "support/surface_scene.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;
using surfaces::add_surface;
using surfaces::moved;
using surfaces::scaled;

MaterialSettings standard(double roughness, double metal) {
  MaterialSettings material = surfaces::of_type(MaterialType::standard);
  material.albedo = Rgb(0.5f, 0.4f, 0.3f);
  material.roughness = roughness;
  material.metal = metal;
  return material;
}

/// A corner of a room, lit by a lamp and by a sky that is bright on one side, with thin smoke.
MemoryScene room_of(const MaterialSettings& material) {
  MemoryScene scene;
  scene.add_box({-1, -1, -1}, {1, 1, 1}).extinction = 0.05;
  scene.add_light(LightType::environment).radiance = Rgb(0.3f);
  add_surface(scene, SurfaceShape::quad, {4, 0, 0, 0, 0, 0, 4, -1.2, 0, -4, 0, 0}, material);
  add_surface(scene, SurfaceShape::quad, moved(scaled(4), {0, 0, -2}), material);
  add_surface(scene, SurfaceShape::quad, {0, 0, 4, -3, 0, 4, 0, 0, -4, 0, 0, 0}, material);
  add_surface(scene, SurfaceShape::disk, moved(scaled(0.3), {1, 1, 1}, true),
              surfaces::shining(20));
  scene.look({1.5, 0.5, 5}, {-0.5, -0.3, -1}, 50, 32, 32);
  scene.scene.render.photons = 2000;
  return scene;
}

std::vector<Rgb> render(const MemoryScene& scene, int first, int passes) {
  const TestFrame frame(scene);
  FramePasses renderer(EstimatorType::gather, frame.input());
  return means_of(renderer, first, passes).pixels;
}

/// Mean squared relative error of a few passes.
double error_of(const MaterialSettings& material) {
  const MemoryScene scene = room_of(material);
  const std::vector<Rgb> truth = render(scene, 4, 40), pixels = render(scene, 0, 4);
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Rgb off = pixels[i] - truth[i];
    const double wanted = static_cast<double>(mean_component(truth[i])) + 0.01;
    sum += static_cast<double>(mean_component(off * off)) / (wanted * wanted);
  }
  return sum / static_cast<double>(pixels.size());
}

/// Measured: 1.1 and 1.3 for plastic, 3.1 and 2.2 for metal; the limit leaves room for the tenth by
/// which such errors scatter. Where the glossy light was not fitted over pixels, metal had 11
/// and 14.
TEST(Glossy, HasHardlyMoreNoiseThanMatt) {
  const double matt = error_of(surfaces::diffuse(0.4));
  for (const auto& [roughness, metal] :
       {std::array{0.5, 0.0}, std::array{0.8, 0.0}, std::array{0.4, 1.0}, std::array{0.7, 1.0}})
    EXPECT_LT(error_of(standard(roughness, metal)), 5 * matt) << roughness << " " << metal;
}

} // namespace
} // namespace vdbeam
