// The white furnace: in a medium of albedo 1 under a sky of radiance 1 every ray sees 1, whatever
// the geometry, the optical depth and the phase function. So one oracle serves every extreme.
#include "stability/stability_scene.h"

namespace vdbeam {
namespace {

using namespace test;

struct Extreme {
  std::string name;
  MemoryScene (*make)();
  /// What beam may lack or have too much: the kernel reaches beyond the medium.
  double beam_bias = 0.03;
  std::uint64_t photons = 40000;
  /// Not where photons cannot resolve the scene and render() says so
  /// (docs/developer/extreme-scenes.md).
  bool beam = true;
  int beam_passes = 24, path_passes = 24;
  /// Standard errors stay below these, or the test would see no defect.
  double beam_power = 0.02, path_power = 0.01;
};

template <int exponent>
MemoryScene depth() {
  MemoryScene scene = box_scene(std::pow(10.0, exponent));
  add_sky(scene);
  // Hardly a photon meets a medium that thin: shadow rays, or there is only noise.
  if (exponent < -3)
    scene.scene.render.direct = DirectLight::sampled;
  return scene;
}

template <class Value>
MemoryScene field_scene(const Vec3<int>& cells, double extinction, Value value) {
  MemoryScene scene;
  scene.add(closed_field(cells, value), box_map(cells, Vec3d(-0.5), Vec3d(0.5))).extinction =
      extinction;
  scene.look({0, 0, 3}, {0, 0, 0}, 12, 8, 8);
  add_sky(scene);
  return scene;
}

MemoryScene one_dense_voxel() {
  return field_scene({2, 2, 2}, 1,
                     [](int i, int j, int k) { return i == 5 && j == 7 && k == 9 ? 1e6 : 1.0; });
}

MemoryScene spikes_beside_vacuum() {
  return field_scene({2, 2, 2}, 1,
                     [](int i, int j, int k) { return lattice_noise(i, j, k) > 0.98 ? 1e4 : 0.0; });
}

template <int thousandths>
MemoryScene phase() {
  MemoryScene scene = box_scene(10);
  scene.scene.volumes[0].phase = henyey_greenstein(thousandths / 1000.0);
  add_sky(scene);
  return scene;
}

/// The unit box and its camera, scaled about the origin, then moved.
MemoryScene placed(double size, const Vec3d& at) {
  MemoryScene scene;
  scene.add_box(at - Vec3d(0.5 * size), at + Vec3d(0.5 * size)).extinction = 5 / size;
  scene.look(at + Vec3d{0, 0, 3 * size}, at, 12, 8, 8);
  add_sky(scene);
  return scene;
}
MemoryScene tiny() {
  return placed(8e-6, Vec3d(0));
}
MemoryScene huge() {
  return placed(8e6, Vec3d(0));
}
MemoryScene far_from_origin() {
  return placed(1, {1e6, -1e6, 1e6});
}

MemoryScene one_voxel() {
  MemoryScene scene;
  DensityField field = DensityField({0, 0, 0}, {1, 1, 1}, {0},
                                    [] {
                                      std::vector<float> values(DensityField::brick_size, 0.0f);
                                      values[(4 * 9 + 4) * 9 + 4] = 1;
                                      return values;
                                    }(),
                                    {});
  scene.add(std::move(field), box_map({1, 1, 1}, Vec3d(-4), Vec3d(4))).extinction = 10;
  scene.look({0, 0, 9}, {0, 0, 0}, 8, 8, 8);
  add_sky(scene);
  return scene;
}

MemoryScene flat_voxels() {
  MemoryScene scene;
  scene
      .add(closed_field({1, 1, 1}, [](int i, int j, int k) { return lattice_noise(i, j, k); }),
           box_map({1, 1, 1}, {-0.5, -0.5, -0.0005}, {0.5, 0.5, 0.0005}))
      .extinction = 2000;
  // From straight above: under slanting rays kernels wider than the sheet is thick reach beyond it.
  scene.look({0, 0, 3}, {0, 0, 0}, 1, 8, 8);
  add_sky(scene);
  return scene;
}

MemoryScene camera_inside() {
  MemoryScene scene = box_scene(5);
  scene.look({0.1, 0.05, -0.07}, {1, 0.3, 0.2}, 60, 8, 8);
  add_sky(scene);
  return scene;
}

/// The middle column's rays run in the plane x = 0, a face of cells and of voxels.
MemoryScene camera_on_a_face() {
  MemoryScene scene =
      field_scene({2, 2, 2}, 5, [](int i, int j, int k) { return 0.5 + lattice_noise(i, j, k); });
  scene.look({0, 0, -0.5}, {0, 0, 1}, 1e-6, 8, 8);
  return scene;
}

MemoryScene one_pixel() {
  MemoryScene scene = box_scene(3);
  add_sky(scene);
  scene.scene.image = {1, 1};
  return scene;
}

MemoryScene wide_view() {
  MemoryScene scene = box_scene(3);
  scene.look({0, 0, 0.4}, {0, 0, 0}, 170, 16, 16);
  add_sky(scene);
  return scene;
}

MemoryScene nearly_white() {
  MemoryScene scene = box_scene(10, 1 - 1e-6);
  add_sky(scene);
  return scene;
}

MemoryScene overlapping() {
  MemoryScene scene = box_scene(1e3);
  scene.add_box({-0.4, -0.6, -0.3}, {0.7, 0.6, 0.3}).extinction = 1e-3;
  scene.scene.volumes[1].phase = henyey_greenstein(0.9);
  add_sky(scene);
  return scene;
}

const Extreme extremes[] = {
    // In a medium that thin a pass has 40 photons, and kernels are as wide as the medium: 10 % too
    // bright, a ten-thousandth of what the picture shows.
    //
    // name, scene, bias of beam, photons, whether beam is held to it, passes, standard errors
    {"OpticalDepth1e_6", depth<-6>},
    {"OpticalDepth1e_3", depth<-3>, 0.15, 40000, true, 24, 24, 0.03},
    {"OpticalDepth1", depth<0>},
    {"OpticalDepth1e2", depth<2>, 0.03, 40000, true, 24, 24, 0.04},
    {"OpticalDepth1e4", depth<4>, 0, 2000, false, 4, 40},
    {"OpticalDepth1e7", depth<7>, 0, 2000, false, 4, 16, 0, 0.015},
    {"OneVoxelAMillionTimesDenser", one_dense_voxel, 0.05, 1000, true, 24, 8, 0.12, 0.04},
    {"SpikesBesideVacuum", spikes_beside_vacuum, 0.05, 4000, true, 24, 8, 0.12, 0.03},
    {"PhaseForwards", phase<999>, 0, 2000, false},
    {"PhaseBackwards", phase<-999>, 0, 2000, false},
    {"VoxelsOf1e_6", tiny},
    {"VoxelsOf1e6", huge},
    {"FarFromOrigin", far_from_origin},
    {"OneVoxel", one_voxel, 0.05, 40000, true, 24, 64},
    {"VoxelsThousandTimesWiderThanThick", flat_voxels, 0.05, 40000, true, 24, 24, 0.06},
    {"CameraInside", camera_inside},
    {"CameraOnAVoxelFace", camera_on_a_face},
    {"OnePixel", one_pixel, 0.03, 40000, true, 24, 640, 0.04},
    {"WideView", wide_view},
    {"AlbedoNearlyOne", nearly_white},
    {"OverlapOfThickAndThin", overlapping, 0.03, 10000, true, 24, 8, 0.08},
};

using Case = std::tuple<Extreme, EstimatorType>;
class Furnace : public ::testing::TestWithParam<Case> {};

TEST_P(Furnace, EveryRaySeesOne) {
  const auto& [extreme, type] = GetParam();
  MemoryScene scene = extreme.make();
  scene.scene.render.photons = extreme.photons;
  const bool path = type == EstimatorType::path;
  const PassMeans means = render_sound(scene, type,
                                       path           ? extreme.path_passes
                                       : extreme.beam ? extreme.beam_passes
                                                      : 4,
                                       extreme.name);
  if (!path && !extreme.beam)
    return;
  // The medium sends as much light as it hides, so thin media are tested as sharply as thick ones.
  const double opacity = means.opacity.mean();
  ASSERT_GT(opacity, 0);
  for (std::size_t c = 0; c < 3; ++c) {
    const Samples &direct = means.direct[c], &indirect = means.indirect[c];
    const double error = std::hypot(direct.error(), indirect.error());
    const double bias = path ? 1e-4 : extreme.beam_bias;
    EXPECT_NEAR((direct.mean() + indirect.mean()) / opacity, 1,
                student_limit(direct.count()) * error / opacity + bias)
        << "standard error " << error / opacity;
    EXPECT_LT(error / opacity, path ? extreme.path_power : extreme.beam_power);
  }
}

std::string case_name(const ::testing::TestParamInfo<Case>& info) {
  return std::get<0>(info.param).name + "_" + name_of(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Extremes, Furnace,
                         ::testing::Combine(::testing::ValuesIn(extremes),
                                            ::testing::Values(EstimatorType::beam,
                                                              EstimatorType::path)),
                         case_name);

} // namespace
} // namespace vdbeam
