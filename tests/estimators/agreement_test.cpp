#include "support/memory_scene.h"
#include "support/render_passes.h"
#include "support/temp_folder.h"
#include "vdbeam/image_file.h"

#include <gtest/gtest.h>

#include <map>

// Three estimators, one truth: beam and march against path.
namespace vdbeam {
namespace {

using test::MemoryScene;
using test::PassMeans;

/// Smooth blobs of 24^3 voxels in a unit cube, 0 at the border.
double blobs(int i, int j, int k) {
  const double x = i / 24.0, y = j / 24.0, z = k / 24.0;
  const double border = 64 * x * (1 - x) * y * (1 - y) * z * (1 - z);
  return border * (1 + std::sin(9 * x) * std::cos(7 * y + 1) * std::sin(8 * z + 2));
}

MemoryScene base_scene() {
  MemoryScene scene;
  const Vec3<int> cells{3, 3, 3};
  VolumeSettings& volume =
      scene.add(test::closed_field(cells, blobs), test::box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = 6;
  volume.albedo = Rgb(0.9f);
  scene.look({0.5, 0.6, 2.5}, {0, 0, 0}, 24, 16, 16);
  RenderSettings& render = scene.scene.render;
  render.photons = 20000;
  render.kernel = KernelRadius::fixed;
  render.radius = 0.06; // small beside the blobs: bias far below the noise
  render.step = 1;
  return scene;
}

void add_sun(MemoryScene& scene, double angular_radius = 0) {
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {1, -0.6, -0.2};
  sun.angular_radius = angular_radius;
}

/// Lamps beside the medium.
MemoryScene lamps() {
  MemoryScene scene = base_scene();
  scene.scene.volumes[0].phase = test::henyey_greenstein(0.6);
  scene.add_light(LightType::point).position = {0.8, 0.2, 0.4};
  LightSettings& spot = scene.add_light(LightType::spot);
  spot.position = {0, 1.5, 0.3};
  spot.cone_angle = 20;
  spot.intensity = Rgb(3);
  return scene;
}

/// A lamp in the medium: its bright core in a few pixels makes the noise heavy-tailed.
MemoryScene lamp_inside() {
  MemoryScene scene = base_scene();
  scene.add_light(LightType::point).position = {0.1, 0.05, 0.2};
  return scene;
}

MemoryScene sun_and_sky() {
  MemoryScene scene = base_scene();
  add_sun(scene, 3);
  scene.add_light(LightType::environment).radiance = {0.2f, 0.3f, 0.5f};
  return scene;
}

/// Two volumes that overlap, differing in everything.
MemoryScene overlap() {
  MemoryScene scene = base_scene();
  scene.scene.volumes[0].phase = test::henyey_greenstein(0.5);
  scene.scene.volumes[0].albedo = {0.95f, 0.8f, 0.5f};
  VolumeSettings& second = scene.add(
      test::uniform_field({1, 1, 1}, 1),
      test::turn({1, 2, 0}, 30).after(test::box_map({1, 1, 1}, {0, -0.3, -0.3}, {0.6, 0.3, 0.3})));
  second.extinction = 3;
  second.albedo = {0.4f, 0.9f, 1};
  second.phase = test::henyey_greenstein(-0.3);
  add_sun(scene);
  scene.add_light(LightType::environment).radiance = Rgb(0.2f);
  return scene;
}

/// Blobs in haze, of extinctions so unlike that photons of the two are kept apart.
MemoryScene blobs_in_haze() {
  MemoryScene scene = sun_and_sky();
  scene.scene.volumes[0].phase = test::henyey_greenstein(0.5);
  VolumeSettings& haze = scene.add(test::uniform_field({1, 1, 1}, 1),
                                   test::box_map({1, 1, 1}, {-0.6, -0.5, -0.5}, {0.5, 0.6, 0.6}));
  haze.extinction = 1;
  haze.albedo = {0.4f, 0.9f, 1};
  return scene;
}

/// Grey throughout, but no albedo that all volumes share: one channel, albedo in the rays' weights.
MemoryScene grey_overlap() {
  MemoryScene scene = overlap();
  scene.scene.volumes[0].albedo = Rgb(0.95f);
  scene.scene.volumes[1].albedo = Rgb(0.5f);
  return scene;
}

MemoryScene chromatic() {
  MemoryScene scene = overlap();
  scene.scene.volumes[0].extinction_scale = {1, 0.5f, 0.2f};
  scene.scene.volumes[1].extinction_scale = {0.1f, 0.4f, 1};
  return scene;
}

/// Colours that multiply the albedo: red on the left, blue on the right, dark at the top.
MemoryScene colored() {
  MemoryScene scene = sun_and_sky();
  scene.scene.volumes[0].albedo = {0.95f, 0.9f, 0.8f};
  scene.scene.volumes[0].phase = test::henyey_greenstein(0.5);
  scene.scene.volumes[0].color_grid = "memory";
  DensityGrid& grid = scene.grids[0];
  grid.color = std::make_shared<const ColorField>(grid.field, [](const Vec3d& local) {
    const auto x = static_cast<float>(local.x / 24), y = static_cast<float>(local.y / 24);
    return Rgb{1 - x, 0.6f, x} * (1 - 0.7f * y);
  });
  return scene;
}

/// The same beside a volume of one albedo and another phase function.
MemoryScene colored_overlap() {
  MemoryScene scene = overlap();
  scene.scene.volumes[0].color_grid = "memory";
  scene.grids[0].color = colored().grids[0].color;
  return scene;
}

/// Mean over the image of each output that both estimators mean alike.
PassMeans expect_agreement(const MemoryScene& scene, const PassMeans& truth, EstimatorType type,
                           int passes, double bias, double power = 0.015, bool layers = true) {
  const PassMeans means = test::render_passes(scene, type, passes);
  for (std::size_t c = 0; c < 3; ++c) {
    SCOPED_TRACE(testing::Message() << "channel " << c);
    test::expect_same_mean(means.total[c], truth.total[c], bias * truth.total[c].mean());
    // Single scattering is separated in the same way by every method; where forward peaks are
    // taken out of multiple scattering, the two are parted only roughly.
    if (layers) {
      test::expect_same_mean(means.direct[c], truth.direct[c], bias * truth.total[c].mean());
      test::expect_same_mean(means.indirect[c], truth.indirect[c], bias * truth.total[c].mean());
    }
    test::expect_same_mean(means.background[c], truth.background[c]);
    EXPECT_LT(means.total[c].error(), power * truth.total[c].mean()); // or it would prove little
  }
  // Part by part, so that a picture that is mirrored or shifted is found out.
  EXPECT_EQ(test::regions_apart(means, truth, 6 * bias + 2 * power), 0);
  return means;
}

PassMeans truth_of(const MemoryScene& scene) {
  return test::render_passes(scene, EstimatorType::path, 64);
}

struct Case {
  const char* name;
  MemoryScene (*make)();
  double power = 0.015; ///< standard errors stay below this share of the mean

  friend std::ostream& operator<<(std::ostream& out, const Case& test_case) {
    return out << test_case.name;
  }
};
class Agreement : public testing::TestWithParam<Case> {
protected:
  /// What path finds in the scene, rendered once for all tests of the case.
  static const PassMeans& truth() {
    static std::map<std::string, PassMeans> truths;
    const auto [found, is_new] = truths.try_emplace(GetParam().name);
    if (is_new)
      found->second = truth_of(GetParam().make());
    return found->second;
  }
};

TEST_P(Agreement, BeamAndMarchWithPath) {
  MemoryScene scene = GetParam().make();
  for (const ForwardPeak peak : {ForwardPeak::automatic, ForwardPeak::kept}) {
    scene.scene.render.forward_peak = peak;
    const bool layers = peak == ForwardPeak::kept;
    {
      SCOPED_TRACE("beam");
      expect_agreement(scene, truth(), EstimatorType::beam, 24, 0.005, GetParam().power, layers);
    }
    {
      SCOPED_TRACE("march");
      expect_agreement(scene, truth(), EstimatorType::march, 24, 0.005, GetParam().power, layers);
    }
  }
  {
    SCOPED_TRACE("beam, all from photons");
    scene.scene.render.direct = DirectLight::photons;
    expect_agreement(scene, truth(), EstimatorType::beam, 24, 0.01, GetParam().power);
  }
}

/// Walks that begin on camera rays find the same light, with as little as nothing of the blur.
TEST_P(Agreement, FinalGatheringWithPath) {
  MemoryScene scene = GetParam().make();
  for (const ForwardPeak peak : {ForwardPeak::automatic, ForwardPeak::kept}) {
    scene.scene.render.forward_peak = peak;
    const PassMeans means = expect_agreement(scene, truth(), EstimatorType::gather, 24, 0.005,
                                             GetParam().power, peak == ForwardPeak::kept);
    EXPECT_GT(means.statistics.gather_walks, 0u);
  }
}

/// The guard of the test above: it detects a mirrored image.
TEST(AgreementOfRegions, SeesAMirroredPicture) {
  const PassMeans truth = truth_of(lamps());
  const PassMeans beam = test::render_passes(lamps(), EstimatorType::beam, 24);
  EXPECT_EQ(test::regions_apart(beam, truth, 0.03), 0);
  EXPECT_GE(test::regions_apart(mirrored(beam), truth, 0.03), 4);
}

class SingleBounce : public testing::TestWithParam<Case> {};

TEST_P(SingleBounce, AgreesWithPath) {
  MemoryScene scene = GetParam().make();
  scene.scene.render.max_bounces = 1;
  const PassMeans truth = truth_of(scene);
  expect_agreement(scene, truth, EstimatorType::beam, 24, 0.005, GetParam().power);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_EQ(truth.indirect[c].mean(), 0);
}

std::string case_name(const testing::TestParamInfo<Case>& test_case) {
  return test_case.param.name;
}
INSTANTIATE_TEST_SUITE_P(Scenes, Agreement,
                         testing::Values(Case{"lamps", lamps},
                                         Case{"lamp_inside", lamp_inside, 0.04},
                                         Case{"sun_and_sky", sun_and_sky}, Case{"overlap", overlap},
                                         Case{"grey_overlap", grey_overlap},
                                         Case{"chromatic", chromatic}, Case{"colored", colored},
                                         Case{"colored_overlap", colored_overlap}),
                         case_name);
INSTANTIATE_TEST_SUITE_P(Scenes, SingleBounce,
                         testing::Values(Case{"lamps", lamps},
                                         Case{"lamp_inside", lamp_inside, 0.08},
                                         Case{"sun_and_sky", sun_and_sky}, Case{"overlap", overlap},
                                         Case{"chromatic", chromatic}),
                         case_name);

// Scatter photons blur the density as well, which costs accuracy where it varies within a kernel:
// smaller kernels, and a wider bound.
TEST(AgreementOfStorage, ScatterPhotons) {
  for (MemoryScene scene : {lamps(), overlap(), blobs_in_haze(), colored_overlap()}) {
    const PassMeans truth = truth_of(scene);
    scene.scene.render.store = PhotonStore::scatter;
    scene.scene.render.radius = 0.03;
    expect_agreement(scene, truth, EstimatorType::beam, 24, 0.015);
    expect_agreement(scene, truth, EstimatorType::march, 24, 0.015);
  }
}

TEST(AgreementOfKernels, AdaptiveRadiiAndShapes) {
  MemoryScene scene = sun_and_sky();
  scene.scene.render.kernel = KernelRadius::adaptive;
  scene.scene.render.neighbours = 20;
  const PassMeans truth = truth_of(scene);
  for (const KernelShape shape :
       {KernelShape::constant, KernelShape::epanechnikov, KernelShape::biweight}) {
    scene.scene.render.kernel_shape = shape;
    expect_agreement(scene, truth, EstimatorType::beam, 24, 0.01);
  }
}

TEST(AgreementOfLights, EnvironmentImage) {
  const test::TempFolder folder;
  Image sky;
  sky.width = 16;
  sky.height = 8;
  for (const char* name : {"R", "G", "B"}) {
    ImageChannel channel{name, {}, false};
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x)
        channel.data.push_back(x == 3 && y == 2 ? 20.0f : 0.1f * static_cast<float>(y));
    sky.channels.push_back(channel);
  }
  write_exr(sky, folder.file("sky.exr"));
  MemoryScene scene = base_scene();
  scene.scene.volumes[0].phase = test::henyey_greenstein(0.7);
  scene.add_light(LightType::environment).image = folder.file("sky.exr");
  const PassMeans truth = truth_of(scene);
  for (const DirectLight direct : {DirectLight::automatic, DirectLight::photons}) {
    scene.scene.render.direct = direct;
    const double bias = direct == DirectLight::photons ? 0.01 : 0.005;
    scene.scene.render.forward_peak = ForwardPeak::automatic;
    expect_agreement(scene, truth, EstimatorType::beam, 24, bias, 0.015, false);
    scene.scene.render.forward_peak = ForwardPeak::kept;
    expect_agreement(scene, truth, EstimatorType::beam, 24, bias);
  }
}

// Sampled single scattering against the same light from photons, apart from the rest.
TEST(AgreementOfDirectLight, PhotonsAndShadowRays) {
  MemoryScene scene = overlap();
  scene.scene.render.max_bounces = 1;
  scene.scene.render.direct = DirectLight::sampled;
  const PassMeans sampled = test::render_passes(scene, EstimatorType::beam, 32);
  scene.scene.render.direct = DirectLight::photons;
  const PassMeans photons = test::render_passes(scene, EstimatorType::beam, 32);
  for (std::size_t c = 0; c < 3; ++c) {
    test::expect_same_mean(sampled.total[c], photons.total[c], 0.005 * sampled.total[c].mean());
    test::expect_same_mean(sampled.direct[c], photons.direct[c], 0.005 * sampled.direct[c].mean());
    EXPECT_EQ(photons.indirect[c].mean(), 0);
    EXPECT_EQ(sampled.indirect[c].mean(), 0);
  }
}

/// Cameras whose rays do not start at one point, or go all around: beam queries take them in tiles.
void expect_cameras_agree(const MemoryScene& scene, double power = 0.02) {
  const PassMeans truth = truth_of(scene);
  expect_agreement(scene, truth, EstimatorType::beam, 48, 0.005, power);
  expect_agreement(scene, truth, EstimatorType::march, 48, 0.005, power);
}

TEST(AgreementOfCamera, SlowThinLens) {
  MemoryScene scene = sun_and_sky();
  scene.scene.volumes[0].phase = test::henyey_greenstein(0.4);
  scene.scene.camera.lens_radius = 0.15;
  scene.scene.camera.blades = 5;
  expect_cameras_agree(scene);
  scene.scene.camera.lens_radius = 1; // wider than the medium, focused before it
  scene.scene.camera.focus_distance = 1.5;
  expect_cameras_agree(scene);
}

TEST(AgreementOfCamera, SlowParallelRays) {
  MemoryScene scene = sun_and_sky();
  scene.scene.camera.projection = Projection::orthographic;
  scene.scene.camera.view_height = 1.2;
  expect_cameras_agree(scene);
}

/// Parallel rays are those of a pinhole far away.
TEST(AgreementOfCamera, ParallelRaysAreAFarPinholes) {
  MemoryScene scene = sun_and_sky();
  scene.scene.camera.projection = Projection::orthographic;
  scene.scene.camera.view_height = 1.2;
  const PassMeans parallel = test::render_passes(scene, EstimatorType::beam, 24);
  scene.scene.camera.projection = Projection::perspective;
  const Vec3d towards = normalize(scene.scene.camera.position);
  const double distance = 1e5;
  scene.scene.camera.position = towards * distance;
  scene.scene.camera.fov = 360 / M_PI * std::atan(0.6 / distance);
  const PassMeans far = test::render_passes(scene, EstimatorType::beam, 24);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(parallel.total[c].mean(), far.total[c].mean(), 1e-3 * far.total[c].mean());
}

TEST(AgreementOfCamera, SlowPanorama) {
  MemoryScene scene = sun_and_sky();
  scene.look({0.2, 0.1, 0.4}, {0, 0, 0}, 60, 32, 16);
  scene.scene.camera.projection = Projection::panorama;
  expect_cameras_agree(scene, 0.05);
}

TEST(AgreementOfCamera, ClippedMedium) {
  MemoryScene scene = sun_and_sky();
  scene.scene.camera.near = 2.4;
  scene.scene.camera.far = 2.7;
  expect_cameras_agree(scene);
}

TEST(AgreementOfCamera, InsideTheMedium) {
  MemoryScene scene = sun_and_sky();
  scene.look({0.05, -0.1, 0.1}, {0.4, 0.2, -1}, 60, 16, 16);
  const PassMeans truth = truth_of(scene);
  expect_agreement(scene, truth, EstimatorType::beam, 100, 0.005, 0.025);
  expect_agreement(scene, truth, EstimatorType::march, 100, 0.005, 0.025);
}

} // namespace
} // namespace vdbeam
