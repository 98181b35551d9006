// The render plan as a value, and counters that prove that what is left out did not run.
#include "render/plan_outcome.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/memory_plan.h"
#include "vdbeam/scene_file.h"
#include "volume_factory.h"

#include <filesystem>

namespace vdbeam {
namespace {

using namespace test;
TEST(Plan, SunlitVolume) {
  const Outcome r = run(base());
  EXPECT_EQ(r.needed,
            (Stages{Stage::read, Stage::majorants, Stage::photons, Stage::photon_importance,
                    Stage::kernel_pilot, Stage::map, Stage::neighbours, Stage::photon_directions,
                    Stage::depth_profiles, Stage::shadow_rays, Stage::beam_query, Stage::bias}));
  expect_plan_kept(r);
}

TEST(Plan, AbsorptionOnly) {
  MemoryScene scene = base();
  scene.scene.volumes[0].albedo = Rgb(0);
  scene.add_light(LightType::environment);
  const Outcome r = run(scene);
  EXPECT_EQ(r.needed,
            (Stages{Stage::read, Stage::majorants, Stage::depth_profiles, Stage::environment}));
  expect_plan_kept(r);
  scene.scene.render.estimator = EstimatorType::path;
  const Outcome path = run(scene);
  EXPECT_EQ(path.needed,
            (Stages{Stage::read, Stage::majorants, Stage::depth_profiles, Stage::environment}));
  expect_plan_kept(path);
}

TEST(Plan, NoLight) {
  MemoryScene scene = base();
  scene.scene.lights.clear();
  for (const EstimatorType type :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
    scene.scene.render.estimator = type;
    const Outcome r = run(scene);
    EXPECT_EQ(r.needed, (Stages{Stage::read, Stage::majorants, Stage::depth_profiles}));
    expect_plan_kept(r);
  }
}

TEST(Plan, Isotropic) {
  MemoryScene scene = base();
  scene.scene.volumes[0].phase = {};
  const Outcome r = run(scene);
  EXPECT_FALSE(r.plan.needs(Stage::photon_directions));
  expect_plan_kept(r);
  EXPECT_LT(r.statistics.bytes_per_photon, run(base()).statistics.bytes_per_photon);
}

TEST(Plan, SingleBounceOfASun) {
  MemoryScene scene = base();
  scene.scene.render.max_bounces = 1;
  const Outcome r = run(scene);
  EXPECT_EQ(r.needed,
            (Stages{Stage::read, Stage::majorants, Stage::depth_profiles, Stage::shadow_rays}));
  expect_plan_kept(r);
}

TEST(Plan, SingleBounceOfASkyNeedsPhotons) {
  MemoryScene scene = base();
  scene.scene.lights.clear();
  scene.add_light(LightType::environment);
  scene.scene.render.max_bounces = 1;
  const Outcome r = run(scene);
  EXPECT_TRUE(r.plan.needs(Stage::photons));
  EXPECT_FALSE(r.plan.needs(Stage::shadow_rays));
  expect_plan_kept(r);
}

TEST(Plan, FixedKernel) {
  MemoryScene scene = base();
  scene.scene.render.kernel = KernelRadius::fixed;
  scene.scene.render.radius = 0.1;
  const Outcome r = run(scene);
  EXPECT_TRUE(r.plan.needs(Stage::map));
  EXPECT_FALSE(r.plan.needs(Stage::neighbours));
  expect_plan_kept(r);
}

TEST(Plan, PhotonsKeptEvenly) {
  MemoryScene scene = base();
  scene.scene.render.thinning = PhotonThinning::even;
  const Outcome even = run(scene);
  EXPECT_FALSE(even.plan.needs(Stage::photon_importance));
  expect_plan_kept(even);
}

TEST(Plan, NoEnvironment) {
  EXPECT_FALSE(run(base()).plan.needs(Stage::environment));
  MemoryScene scene = base();
  scene.add_light(LightType::environment);
  EXPECT_TRUE(run(scene).plan.needs(Stage::environment));
}

TEST(Plan, DirectByPhotons) {
  MemoryScene scene = base();
  scene.scene.render.direct = DirectLight::photons;
  const Outcome r = run(scene);
  EXPECT_FALSE(r.plan.needs(Stage::shadow_rays));
  expect_plan_kept(r);
}

TEST(Plan, GreyNeedsOneChannel) {
  const Outcome grey = run(base());
  EXPECT_FALSE(grey.plan.needs(Stage::photon_color));
  MemoryScene scene = base();
  scene.scene.lights[0].irradiance = {1, 2, 3};
  const Outcome coloured = run(scene);
  EXPECT_TRUE(coloured.plan.needs(Stage::photon_color));
  EXPECT_LT(grey.statistics.bytes_per_photon, coloured.statistics.bytes_per_photon);
  EXPECT_LT(grey.plan.photon_bytes, coloured.plan.photon_bytes);
}

TEST(Plan, ChromaticExtinction) {
  EXPECT_FALSE(run(base()).plan.needs(Stage::spectral_tracking));
  MemoryScene scene = base();
  scene.scene.volumes[0].extinction_scale = {1, 0.5f, 0.25f};
  EXPECT_TRUE(run(scene).plan.needs(Stage::spectral_tracking));
}

TEST(Plan, EmptyFrame) {
  MemoryScene scene = base();
  scene.grids[0].field = {};
  scene.grids[0].active_voxels = 0;
  scene.add_light(LightType::environment);
  for (const EstimatorType type :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
    scene.scene.render.estimator = type;
    const Outcome r = run(scene);
    EXPECT_EQ(r.needed, (Stages{Stage::read, Stage::environment}));
    expect_plan_kept(r);
    EXPECT_EQ(r.image.background[0].x, 1);
  }
}

TEST(Plan, ZeroExtinction) {
  MemoryScene scene = base();
  scene.scene.volumes[0].extinction = 0;
  const Outcome r = run(scene);
  EXPECT_EQ(r.needed, (Stages{Stage::read}));
  expect_plan_kept(r);
}

TEST(Plan, NoVolumes) {
  MemoryScene scene = base();
  scene.scene.volumes.clear();
  scene.grids.clear();
  const Outcome r = run(scene);
  EXPECT_EQ(r.needed, Stages{});
  expect_plan_kept(r);
}

TEST(Plan, ThinMedium) {
  MemoryScene scene = base();
  scene.scene.volumes[0].extinction = 1e-2;
  scene.add_light(LightType::environment); // first flights hit more often than second ones
  expect_plan_kept(run(scene));
}

TEST(Plan, OpaqueMedium) {
  MemoryScene scene = base();
  scene.scene.volumes[0].extinction = 1e4;
  expect_plan_kept(run(scene));
}

TEST(Plan, PathEstimator) {
  MemoryScene scene = base();
  scene.scene.render.estimator = EstimatorType::path;
  const Outcome r = run(scene);
  EXPECT_EQ(r.needed, (Stages{Stage::read, Stage::majorants, Stage::depth_profiles,
                              Stage::shadow_rays, Stage::paths}));
  expect_plan_kept(r);
}

TEST(Plan, MarchEstimator) {
  MemoryScene scene = base();
  scene.scene.render.estimator = EstimatorType::march;
  const Outcome r = run(scene);
  EXPECT_TRUE(r.plan.needs(Stage::march));
  EXPECT_FALSE(r.plan.needs(Stage::beam_query));
  expect_plan_kept(r);
}

TEST(Plan, CameraThatSeesNoMedium) {
  MemoryScene scene = base();
  scene.add_light(LightType::environment);
  for (const Vec3d& away : {Vec3d{0, 0, 6}, {3, 0, 3}, {-3, 0, 2}, {0, 3, 2.5}, {0.1, -3, 2.5}})
    for (const EstimatorType type :
         {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
      scene.look({0, 0, 3}, away, 12, 8, 8);
      scene.scene.render.estimator = type;
      const Outcome r = run(scene);
      EXPECT_EQ(r.needed, (Stages{Stage::read, Stage::majorants, Stage::environment}));
      expect_plan_kept(r);
      EXPECT_EQ(r.image.background[0].x, 1);
    }
}

/// Half of the medium beyond the picture's edge is in view all the same.
TEST(Plan, CameraThatSeesAnEdge) {
  MemoryScene scene = base();
  scene.look({0, 0, 3}, {0.75, 0, 0}, 12, 8, 8);
  expect_plan_kept(run(scene));
}

TEST(Plan, EstimatesMemory) {
  const Outcome r = run(base());
  EXPECT_GT(r.plan.photon_bytes, 2000 * r.statistics.bytes_per_photon / 2);
  EXPECT_GE(r.plan.film_bytes, 64u * 156);
}

/// Measured with a picture of 1280 x 720 pixels: 28 bytes a pixel more with a reference, 57 more
/// with two.
TEST(PlanMemory, HoldsReferences) {
  Scene scene = load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml");
  scene.image.width = 1280;
  scene.image.height = 720;
  scene.render.estimator = EstimatorType::path;
  const double pixels = 1280 * 720;
  const double none = static_cast<double>(plan_memory(scene).peak());
  EXPECT_NEAR((static_cast<double>(plan_memory(scene, 1).peak()) - none) / pixels, 28, 8);
  EXPECT_NEAR((static_cast<double>(plan_memory(scene, 2).peak()) - none) / pixels, 57, 12);
}

TEST(MakePlan, ForetellsTheMemoryOfSurfaces) {
  const TempFolder folder;
  Scene scene;
  SurfaceSettings surface;
  surface.file = folder.file("big.ply");
  test::write_bytes(surface.file,
                    "ply\nformat ascii 1.0\nelement vertex 5000000\nelement face 10000000\n"
                    "end_header\n");
  scene.surfaces = {surface, surface};
  const auto bytes = [&] { return static_cast<double>(make_plan(scene).surface_bytes); };
  EXPECT_NEAR(bytes(), 3.7e9, 0.2e9) << "as measured";
  const double flat = bytes();
  scene.surfaces[1].smooth_angle = 40;
  EXPECT_EQ(bytes(), flat + 36 * 1e7);
  scene.surfaces[1].smooth_angle = 0;
  test::write_bytes(surface.file,
                    "ply\nformat ascii 1.0\nelement vertex 5000000\nproperty float nx\n"
                    "element face 10000000\nend_header\n");
  EXPECT_EQ(bytes(), flat + 36 * 1e7);
  for (SurfaceSettings& each : scene.surfaces)
    each.file_normals = false;
  EXPECT_EQ(bytes(), flat);
}

/// make_plan needs the files' headers only, and says of the view what the renderer says.
TEST(MakePlan, ReadsHeadersOnly) {
  const TempFolder folder;
  Scene scene;
  VolumeSettings volume;
  volume.file = folder.file("noise.vdb");
  VolumeOptions options;
  options.size = 32;
  write_volume("noise", volume.file, options); // 2 world units wide, about 0
  std::filesystem::resize_file(volume.file, std::filesystem::file_size(volume.file) / 2);
  scene.volumes.push_back(volume);
  scene.lights.resize(1);
  const RenderPlan plan = make_plan(scene);
  EXPECT_TRUE(plan.needs(Stage::photons));
  EXPECT_TRUE(plan.needs(Stage::depth_profiles));

  scene.camera.look_at = {5, 0, 5};
  const RenderPlan away = make_plan(scene);
  EXPECT_FALSE(away.needs(Stage::photons));
  EXPECT_FALSE(away.needs(Stage::depth_profiles));
  EXPECT_TRUE(away.needs(Stage::majorants));

  scene.volumes[0].transform[3] = 5; // moves it into view
  EXPECT_FALSE(make_plan(scene).needs(Stage::photons));
  scene.volumes[0].transform[11] = 5;
  scene.camera.look_at = {2, 0, 5};
  EXPECT_TRUE(make_plan(scene).needs(Stage::photons));

  scene.volumes[0].density = "flame";
  EXPECT_THROW(make_plan(scene), InputError);
  // Emission alone needs no density grid, and no other grid than its own.
  scene.volumes[0].extinction = 0;
  scene.volumes[0].emission.intensity = "density";
  const RenderPlan glow = make_plan(scene);
  EXPECT_TRUE(glow.needs(Stage::emission));
  EXPECT_FALSE(glow.needs(Stage::majorants));
  EXPECT_FALSE(glow.needs(Stage::photons));
  scene.volumes[0].emission.temperature = "temperature";
  EXPECT_THROW(make_plan(scene), InputError);
  scene.volumes[0].present = false;
  EXPECT_FALSE(make_plan(scene).needs(Stage::majorants));
}

} // namespace
} // namespace vdbeam
