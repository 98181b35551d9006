// Every sample scene is one picture, whichever estimator renders it.
#include "geometry/mesh_reader.h"
#include "materials/material_table.h"
#include "photons/photon_plan.h"
#include "prepare/prepared_scene.h"
#include "support/render_passes.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace vdbeam {
namespace {

namespace fs = std::filesystem;
using test::PassMeans;
using test::Samples;

/// All scene files under data/.
std::vector<fs::path> sample_scenes() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(std::string(VDBEAM_SOURCE_DIR) + "/data"))
    if (entry.path().extension() == ".toml")
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// The first frame for which all files are there.
Scene load_sample(const fs::path& path) {
  constexpr int last = 100;
  for (int frame = 1; frame < last; ++frame)
    try {
      return load_scene(path.string(), frame);
    } catch (const InputError&) {
    }
  return load_scene(path.string(), last);
}

/// Half of the largest side of a surface's bounds, about.
double half_size(const SurfaceSettings& surface) {
  double size = std::cbrt(std::abs(Affine::from_matrix(surface.transform).determinant()));
  if (surface.shape == SurfaceShape::file) {
    Boxf bounds;
    for (const Vec3f& position : read_mesh(surface.file).positions)
      bounds.extend(position);
    size *= 0.5 * static_cast<double>(max_component(bounds.size()));
  }
  return size;
}

/// Half as large again as the largest of what is made of glass or metal; 0 where there is none.
double width_of_lamps(const Scene& scene) {
  double size = 0;
  for (const SurfaceSettings& surface : scene.surfaces)
    if (make_material(surface.material, 1)->shows_surroundings())
      size = std::max(size, 1.5 * half_size(surface));
  return size;
}

/// Path tracing finds light that glass and metal focus where it meets the lamp by chance, and a few
/// passes miss what is rare without knowing it. So lamps become larger than what focuses their
/// light, and send out as much as before; lights without extent, whose focused light it never finds
/// at all, go out.
void widen_lights(Scene& scene) {
  const double size = width_of_lamps(scene);
  if (size == 0)
    return;
  std::erase_if(scene.lights, [](const LightSettings& light) {
    return light.type == LightType::point || light.type == LightType::spot;
  });
  for (LightSettings& light : scene.lights)
    if (light.type == LightType::distant)
      light.angular_radius = std::max(light.angular_radius, 20.0);
  for (SurfaceSettings& surface : scene.surfaces) {
    if (!shines(surface.material) || half_size(surface) >= size)
      continue;
    const double factor = size / half_size(surface);
    for (const int row : {0, 4, 8})
      for (int column = 0; column < 3; ++column)
        surface.transform[static_cast<std::size_t>(row + column)] *= factor;
    surface.material.radiance *= static_cast<float>(1 / (factor * factor));
  }
}

/// What the camera would see in a pixel or two, and lamps, would hide all else in their noise.
void hide_small_surfaces(Scene& scene) {
  const double pixel = 2 * std::tan(scene.camera.fov * std::numbers::pi / 360) / scene.image.height;
  for (SurfaceSettings& surface : scene.surfaces) {
    const auto& map = surface.transform;
    const double distance = length(Vec3d{map[3], map[7], map[11]} - scene.camera.position);
    if (shines(surface.material) || half_size(surface) < pixel * distance)
      surface.visible = false;
  }
}

/// A scene, small and with few photons, ready for each estimator.
class Sample {
public:
  explicit Sample(const fs::path& path) : scene_(load_sample(path)) {
    constexpr int width = 32;
    scene_.image.height = std::max(4, scene_.image.height * width / scene_.image.width);
    scene_.image.width = width;
    scene_.render.photons = 10000;
    widen_lights(scene_);
    hide_small_surfaces(scene_);
    prepared_ = prepare_scene(scene_);
  }

  PassMeans render(const EstimatorType& type, int first, int count) const {
    Scene scene = scene_;
    scene.render.estimator = type;
    const World& world = *prepared_->world;
    const Camera camera(scene.camera, scene.image, world.space);
    const RenderPlan plan = plan_stages(scene, volume_facts(prepared_->facts, world, camera));
    const auto estimator = make_pass_renderer(type, {world, camera, scene.render, plan});
    return test::means_of(*estimator, first, count);
  }

  const RenderSettings& settings() const { return scene_.render; }

private:
  Scene scene_;
  PreparedScenePtr prepared_;
};

/// How wide kernels are in the mean over some passes, relative to those of the first.
double kernel_width(const RenderSettings& settings, int first, int count) {
  double sum = 0;
  for (int pass = first; pass < first + count; ++pass)
    sum += static_cast<double>(radius_scale(pass, settings.alpha));
  return sum / count;
}

constexpr int passes = 20, path_passes = 128, late = 1000;

class SlowSampleScenes : public testing::TestWithParam<fs::path> {};

/// Late passes have kernels a third as wide as early ones. What they still blur is bounded by how
/// much early ones differ from them: blur goes at least as the kernels' width (docs/theory/beam.md,
/// "Errors"). Whatever else the estimators differ by must be chance, at 4 standard errors for the
/// whole and for each region.
TEST_P(SlowSampleScenes, LookTheSameWithEveryEstimator) {
  const Sample sample(GetParam());
  const PassMeans path = sample.render(EstimatorType::path, 0, path_passes);
  test::expect_power(path.total[1], 0.03 * path.total[1].mean());
  const double share =
      kernel_width(sample.settings(), late, passes) / kernel_width(sample.settings(), 0, passes);
  EXPECT_LT(share, 0.4);
  for (const EstimatorType type : {EstimatorType::beam, EstimatorType::march}) {
    SCOPED_TRACE(std::string(type.name));
    const PassMeans wide = sample.render(type, 0, passes);
    const PassMeans narrow = sample.render(type, late, passes);
    test::expect_power(narrow.total[1], 0.03 * path.total[1].mean());
    const auto blur = [&](const Samples& a, const Samples& b) {
      return std::abs(a.mean() - b.mean()) * share / (1 - share);
    };
    for (std::size_t c = 0; c < 3; ++c)
      test::expect_same_mean(narrow.total[c], path.total[c], blur(wide.total[c], narrow.total[c]));
    for (std::size_t i = 0; i < path.regions.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "region " << i);
      test::expect_same_mean(narrow.regions[i], path.regions[i],
                             blur(wide.regions[i], narrow.regions[i]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Data, SlowSampleScenes, testing::ValuesIn(sample_scenes()),
                         [](const testing::TestParamInfo<fs::path>& path) {
                           return path.param.stem().string();
                         });

} // namespace
} // namespace vdbeam
