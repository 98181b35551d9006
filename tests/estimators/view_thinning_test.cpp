// Photons that the camera does not see are stored rarely, and nothing is lost by it.
#include "photons/view_thinning.h"

#include "photons/view_importance.h"
#include "support/render_passes.h"
#include "transport/photon_tracing.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace vdbeam {
namespace {

using namespace test;

constexpr float least = 1.0f / 1024;

/// A cube of side 1 of 8^3 cells of noise, `depth` mean free paths deep on average, in sunlight
/// from behind the camera. Its cells are a sixteenth of its size or an optical depth of 8 wide.
MemoryScene noisy_cube(double depth) {
  MemoryScene scene;
  const DensityField field = closed_field(
      {8, 8, 8}, [](int i, int j, int k) { return 0.5 + lattice_noise(i / 4, j / 4, k / 4); });
  VolumeSettings& volume = scene.add(field, box_map({8, 8, 8}, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = depth;
  volume.albedo = Rgb(0.98f);
  volume.phase = henyey_greenstein(0.5);
  scene.add_light(LightType::distant).direction = {-0.3, -0.2, -1};
  scene.look({0.4, 0.3, 3}, {0, 0, 0}, 22, 16, 16);
  return scene;
}

/// All collisions of a sample of paths.
TracedPhotons collisions_of(const World& world, std::uint64_t paths = 2000) {
  PhotonPassSettings settings;
  settings.paths = paths;
  settings.skip_first_flight.assign(world.lights.size(), true);
  return trace_photons(world, settings);
}

struct View {
  explicit View(const MemoryScene& scene)
      : world(scene.world()), camera(scene.scene.camera, scene.scene.image, world.space) {}
  CellTables importance(float reach) { return view_importance(world, camera, reach, least, rays); }
  World world;
  Camera camera;
  std::uint64_t rays = 0;
};

TEST(ViewImportance, FallsWithDepth) {
  View view(noisy_cube(60));
  const CellTables tables = view.importance(0.02f);
  ASSERT_EQ(tables.size(), 1u);
  const DensityField& field = view.world.medium.volumes[0].field;
  const auto at = [&](int k) { return tables[0][field.cell_offset(4, 4, k)]; };
  EXPECT_EQ(at(7), 1); // the camera looks along -z
  for (int k = 7; k > 0; --k)
    EXPECT_LE(at(k - 1), at(k)) << k;
  EXPECT_LT(at(6), 0.02f); // behind a cell of optical depth 7.5
  EXPECT_EQ(at(0), least);
  EXPECT_GT(view.rays, 1000u);
}

TEST(ViewImportance, FallsBesideTheView) {
  MemoryScene scene = noisy_cube(60);
  scene.look({0.4, 0.4, 3}, {0.4, 0.4, 0}, 2, 16, 16); // sees a corner, a tenth of the width
  View view(scene);
  const CellTables narrow = view.importance(0.02f), wide = view.importance(0.2f);
  const DensityField& field = view.world.medium.volumes[0].field;
  EXPECT_EQ(narrow[0][field.cell_offset(7, 7, 7)], 1);
  EXPECT_EQ(narrow[0][field.cell_offset(0, 0, 7)], least);
  for (int i = 0; i < 7; ++i) {
    const std::size_t cell = field.cell_offset(i, 7, 7), next = field.cell_offset(i + 1, 7, 7);
    EXPECT_GE(wide[0][cell], narrow[0][cell]);
    // Cells are 1/8 wide: no faster than exp(-1/8 / 0.2) from one to the next.
    EXPECT_GE(wide[0][cell], 0.999f * std::exp(-0.125f / 0.2f) * wide[0][next]);
  }
}

TEST(ViewImportance, LooksAtTheClock) {
  View view(noisy_cube(60));
  const std::atomic<bool> yes = true;
  const StopToken stop(&yes);
  const CellTables tables =
      view_importance(view.world, view.camera, 0.02f, least, view.rays, &stop);
  for (const float value : tables[0])
    ASSERT_EQ(value, least); // as where no ray has come
}

TEST(ViewImportance, IsTheSameForAnyThreads) {
  const MemoryScene scene = noisy_cube(20);
  std::vector<CellTables> tables;
  for (const int threads : {1, 3})
    tbb::task_arena(threads).execute([&] { tables.push_back(View(scene).importance(0.1f)); });
  EXPECT_EQ(tables[0], tables[1]);
}

/// Channels in which nothing scatters do not count, however clear they are.
TEST(ViewImportance, HiddenChannels) {
  MemoryScene scene = noisy_cube(60);
  const CellTables grey = View(scene).importance(0.02f);
  scene.scene.volumes[0].extinction_scale = {1, 1, 0};
  EXPECT_EQ(View(scene).importance(0.02f), grey);
  scene.scene.volumes[0].extinction_scale = {1, 1, 0.01f};
  const CellTables clear = View(scene).importance(0.02f);
  EXPECT_GT(clear[0][clear[0].size() / 2], 10 * grey[0][grey[0].size() / 2]);
}

TEST(ViewThinning, KeepsWhatIsWanted) {
  View view(noisy_cube(60));
  const TracedPhotons pilot = collisions_of(view.world);
  for (const double wanted : {1.0, 4.0}) {
    const ViewThinning thinning = thin_by_view(view.world, view.camera, view.importance(0.05f),
                                               pilot.photons, pilot.mean_collisions, wanted);
    EXPECT_NEAR(thinning.stored_per_path, wanted, 0.01 * wanted);
    PhotonPassSettings settings;
    settings.paths = 4000;
    settings.key = {7, 1, 3};
    settings.skip_first_flight = {true};
    settings.store_probability_by_cell =
        std::make_shared<const CellTables>(thinning.store_probability);
    settings.camera = view.camera;
    const TracedPhotons pass = trace_photons(view.world, settings);
    const double stored = static_cast<double>(pass.photons.size()) / 4000;
    EXPECT_NEAR(stored, wanted, 0.1 * wanted);
  }
}

/// With the same share kept where the camera sees photons best, how many are stored at all, in
/// parts of what thinning evenly would store.
double stored_share(const MemoryScene& scene) {
  View view(scene);
  const TracedPhotons pilot = collisions_of(view.world);
  const CellTables importance = view.importance(0.05f);
  double sum = 0;
  for (const Vec3f& position : pilot.photons.position)
    sum += static_cast<double>(importance[0][view.world.medium.volumes[0].cell_at(position)]);
  return sum / static_cast<double>(pilot.photons.size());
}

TEST(ViewThinning, SavesPhotonsOfADenseMedium) {
  MemoryScene scene = noisy_cube(120);
  scene.scene.lights[0].direction = {0.2, -0.1, 1}; // the far side is lit, the near one seen
  EXPECT_LT(stored_share(scene), 0.05);
  scene.scene.lights[0] = {};
  scene.scene.lights[0].type = LightType::environment; // all six sides are
  EXPECT_LT(stored_share(scene), 0.6);
}

/// Photons more than two kernels beside the view: at most 4 / 1024 + exp(-2) of their share.
TEST(ViewThinning, StoresFewPhotonsOutsideTheView) {
  MemoryScene scene = noisy_cube(30);
  scene.look({0.4, 0.4, 3}, {0.4, 0.4, 0}, 4, 16, 16);
  View view(scene);
  const float reach = 0.04f;
  const TracedPhotons all = collisions_of(view.world, 4000);
  const ViewThinning thinning = thin_by_view(view.world, view.camera, view.importance(reach),
                                             all.photons, all.mean_collisions, 4);
  PhotonPassSettings settings;
  settings.paths = 4000;
  settings.skip_first_flight = {true};
  settings.store_probability_by_cell =
      std::make_shared<const CellTables>(thinning.store_probability);
  const TracedPhotons kept = trace_photons(view.world, settings);
  const auto outside = [&](const PhotonList& photons) {
    std::size_t count = 0;
    for (const Vec3f& position : photons.position) {
      const Vec3d p = Vec3d(position) - view.camera.origin();
      const Vec3d ray = view.camera.direction_towards(Vec3d(position));
      const double beyond = length(p - ray * dot(p, ray)); // 0 in the picture
      // The cells, 1/8 wide, that touch the view count as seen.
      count += beyond > 0.125 + 2 * static_cast<double>(reach);
    }
    return static_cast<double>(count);
  };
  ASSERT_GT(outside(all.photons), 0.5 * static_cast<double>(all.photons.size()));
  EXPECT_LT(outside(kept.photons), 0.02 * outside(all.photons));
  EXPECT_GT(kept.photons.size(), 1000u);
}

/// What photons bring to the camera if they are stored by cell alone, or by direction too: by pass,
/// and its mean square over the square of its mean, by photon.
struct Brought {
  test::Samples passes;
  double uneven = 0;
};

Brought bring(View& view, const ViewThinning& thinning, bool by_direction) {
  Brought brought;
  PhotonPassSettings settings;
  settings.paths = 1000;
  settings.skip_first_flight = {true};
  settings.store_probability_by_cell =
      std::make_shared<const CellTables>(thinning.store_probability);
  if (by_direction)
    settings.camera = view.camera;
  const Volume& volume = view.world.medium.volumes[0];
  double count = 0, sum = 0, squares = 0;
  for (std::uint64_t pass = 1; pass <= 24; ++pass) {
    settings.key = {1, 1, pass};
    const PhotonList photons = trace_photons(view.world, settings).photons;
    double of_pass = 0;
    for (std::size_t i = 0; i < photons.size(); ++i) {
      const Vec3f& position = photons.position[i];
      const Vec3f towards(view.camera.direction_towards(Vec3d(position)));
      const double importance =
          static_cast<double>(thinning.store_probability[0][volume.cell_at(position)]);
      const double value = importance * static_cast<double>(photons.power[i].x) *
                           static_cast<double>(view.world.medium.phases[0].evaluate(
                               -dot(photons.direction[i], towards)));
      of_pass += value;
      squares += value * value;
    }
    count += static_cast<double>(photons.size());
    sum += of_pass;
    brought.passes.add(of_pass);
  }
  brought.uneven = squares * count / (sum * sum);
  return brought;
}

/// Photons of equal contributions are worth most: the same number has less noise.
TEST(ViewThinning, FollowsWhatIsScatteredTowardsTheCamera) {
  View view(noisy_cube(60));
  PhotonPassSettings settings;
  settings.paths = 2000;
  settings.skip_first_flight = {true};
  const TracedPhotons pilot = trace_photons(view.world, settings);
  const ViewThinning thinning = thin_by_view(view.world, view.camera, view.importance(0.05f),
                                             pilot.photons, pilot.mean_collisions, 2);
  const Brought by_cell = bring(view, thinning, false), by_both = bring(view, thinning, true);
  EXPECT_LT(by_both.uneven, 0.7 * by_cell.uneven);
  expect_same_mean(by_cell.passes, by_both.passes, 0);
  expect_power(by_both.passes, 0.03 * by_both.passes.mean());
}

/// With one radius for all kernels both ways of thinning have the same expectation.
TEST(ViewThinning, IsUnbiased) {
  for (const PhotonStore store : {PhotonStore::fluence, PhotonStore::scatter}) {
    MemoryScene scene = noisy_cube(20);
    scene.add_light(LightType::environment).radiance = Rgb(0.3f);
    scene.scene.render.store = store;
    scene.scene.render.kernel = KernelRadius::fixed;
    scene.scene.render.radius = 0.06;
    scene.scene.render.alpha = 1;
    scene.scene.render.photons = 30000;
    PassMeans means[2];
    for (const PhotonThinning thinning : {PhotonThinning::even, PhotonThinning::view}) {
      scene.scene.render.thinning = thinning;
      means[thinning == PhotonThinning::view] = render_passes(scene, EstimatorType::beam, 24);
    }
    expect_same_mean(means[0].indirect[0], means[1].indirect[0], 0);
    EXPECT_LT(means[1].indirect[0].error(), 0.008 * means[1].indirect[0].mean());
  }
}

/// Adaptive radii shrink where photons are seen; the picture stays the same within 3 %.
TEST(ViewThinning, AgreesWithPathInADenseMedium) {
  MemoryScene scene = noisy_cube(60);
  const PassMeans path = render_passes(scene, EstimatorType::path, 128);
  expect_power(path.total[0], 0.005 * path.total[0].mean());
  for (const PhotonThinning thinning : {PhotonThinning::even, PhotonThinning::view}) {
    scene.scene.render.thinning = thinning;
    scene.scene.render.photons = 60000;
    const PassMeans beam = render_passes(scene, EstimatorType::beam, 32);
    expect_power(beam.total[0], 0.005 * path.total[0].mean());
    expect_same_mean(beam.total[0], path.total[0], 0.03 * path.total[0].mean());
  }
}

} // namespace
} // namespace vdbeam
