#include "photons/photon_cache.h"
#include "prepare/prepared_scene.h"
#include "support/temp_folder.h"
#include "vdbeam/metrics.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <cstring>
#include <gtest/gtest.h>
#include <numeric>

namespace vdbeam {
namespace {

/// The sample cloud at a frame, small and quick.
Scene cloud_in_frame(int frame = 1, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"image.width=40", "image.height=23", "render.photons=3000",
                                     "render.passes=3", "render.estimator=beam"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml", frame, overrides);
}

RenderResult render_frame(Scene scene, int frame, const PreparedScenePtr& prepared) {
  scene.frame = frame;
  return render(scene, prepared);
}
Image render_alone(const Scene& scene, int frame) {
  return render_frame(scene, frame, prepare_scene(scene)).image;
}

bool same_pixels(const Image& a, const Image& b) {
  if (a.channels.size() != b.channels.size())
    return false;
  for (std::size_t c = 0; c < a.channels.size(); ++c)
    if (a.channels[c].data.size() != b.channels[c].data.size() ||
        std::memcmp(a.channels[c].data.data(), b.channels[c].data.data(),
                    a.channels[c].data.size() * sizeof(float)) != 0)
      return false;
  return true;
}

TEST(Seeds, CorrelatedFramesDrawTheSameNumbers) {
  for (const char* estimator : {"beam", "march", "path"}) {
    const std::string choice = std::string("render.estimator=") + estimator;
    const Scene correlated = cloud_in_frame(1, {choice, "render.seeds=correlated"});
    const Scene per_frame = cloud_in_frame(1, {choice, "render.seeds=per_frame"});
    const Image first = render_alone(correlated, 1);
    EXPECT_TRUE(same_pixels(first, render_alone(correlated, 7))) << estimator;
    EXPECT_TRUE(same_pixels(first, render_alone(per_frame, 1))) << estimator;
    EXPECT_FALSE(same_pixels(first, render_alone(per_frame, 7))) << estimator;
    const Scene other = cloud_in_frame(1, {choice, "render.seeds=correlated", "render.seed=2"});
    EXPECT_FALSE(same_pixels(first, render_alone(other, 7))) << estimator;
  }
}

/// The cloud grows denser by 2 % from the first frame to the second.
std::vector<Image> render_pair(const char* policy, int seed, int passes) {
  std::vector<Image> images;
  for (int frame = 1; frame <= 2; ++frame)
    images.push_back(render_alone(
        cloud_in_frame(frame, {std::string("render.seeds=") + policy,
                               "render.seed=" + std::to_string(seed),
                               "render.passes=" + std::to_string(passes), "render.photons=20000",
                               frame == 1 ? "volume.0.extinction=40" : "volume.0.extinction=40.8"}),
        frame));
  return images;
}

/// Mean temporal error of three seeds.
double flicker(const std::vector<Image>& truth, const char* policy) {
  double sum = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    const std::vector<Image> images = render_pair(policy, seed, 3);
    sum += temporal_error(images[0], images[1], truth[0], truth[1]) / 3;
  }
  return sum;
}

TEST(Seeds, TheDefaultFlickersLess) {
  EXPECT_EQ(cloud_in_frame().render.seeds, SeedPolicy::correlated);
  const std::vector<Image> truth = render_pair("correlated", 99, 60);
  const double correlated = flicker(truth, "correlated"), per_frame = flicker(truth, "per_frame");
  EXPECT_GT(correlated, 0);
  // With single seeds on similar scenes the ratio was 0.3 to 0.6.
  EXPECT_LT(correlated, 0.75 * per_frame) << correlated << " " << per_frame;
}

/// Renders a moving camera over a still cloud, each frame after the other, and compares with frames
/// rendered alone. Returns how many passes of each frame took the photons of an earlier one.
std::vector<std::uint64_t> reused_maps(const std::vector<std::string>& more) {
  std::vector<std::uint64_t> counts;
  PreparedScenePtr prepared;
  for (int frame = 1; frame <= 4; ++frame) {
    Scene scene = cloud_in_frame(frame, more);
    scene.camera.position.x += 0.1 * frame;
    scene.camera.fov += frame;
    prepared = prepare_scene(scene, prepared);
    const RenderResult result = render_frame(scene, frame, prepared);
    counts.push_back(result.statistics.maps_reused);
    EXPECT_EQ(result.statistics.trace == 0, counts.back() == 3);
    EXPECT_EQ(result.statistics.light_paths == 0, counts.back() == 3);
    EXPECT_GT(result.statistics.photons_stored, 0u);
    EXPECT_TRUE(same_pixels(result.image, render_alone(scene, frame))) << frame;
  }
  return counts;
}

using Counts = std::vector<std::uint64_t>;

/// With a floor, a ball of glass and a lamp, photons lie on surfaces too.
TEST(PhotonReuse, WorksOnSurfacesToo) {
  PreparedScenePtr prepared;
  Counts counts;
  for (int frame = 1; frame <= 4; ++frame) {
    Scene scene = cloud_in_frame(frame, {"render.thinning=even"});
    SurfaceSettings& floor = scene.surfaces.emplace_back();
    floor.shape = SurfaceShape::quad;
    floor.transform = {4, 0, 0, 0, 0, 0, 4, -0.9, 0, -4, 0, 0};
    SurfaceSettings& ball = scene.surfaces.emplace_back();
    ball.shape = SurfaceShape::sphere;
    ball.transform = {0.4, 0, 0, -1, 0, 0.4, 0, -0.4, 0, 0, 0.4, 1};
    ball.material.type = MaterialType::dielectric;
    scene.camera.position.x += 0.1 * frame;
    prepared = prepare_scene(scene, prepared);
    const RenderResult result = render_frame(scene, frame, prepared);
    counts.push_back(result.statistics.maps_reused);
    EXPECT_TRUE(same_pixels(result.image, render_alone(scene, frame))) << frame;
  }
  EXPECT_EQ(counts, (Counts{0, 0, 3, 3}));
}

TEST(PhotonReuse, OfAStillVolumeUnderAMovingCameraIsExact) {
  // The second frame is the first that is known to share its world with another.
  EXPECT_EQ(reused_maps({"render.thinning=even"}), (Counts{0, 0, 3, 3}));
  EXPECT_EQ(reused_maps({"render.estimator=march"}), (Counts{0, 0, 3, 3}));
  EXPECT_EQ(reused_maps({"render.kernel=fixed", "render.radius=0.2", "render.store=scatter",
                         "render.thinning=even"}),
            (Counts{0, 0, 3, 3}));
}

TEST(PhotonReuse, IsNotDoneWherePhotonsFollowTheView) {
  EXPECT_EQ(reused_maps({}), (Counts{0, 0, 0, 0}));
}

TEST(PhotonReuse, IsNotDoneWhereFramesHaveTheirOwnNumbers) {
  EXPECT_EQ(reused_maps({"render.seeds=per_frame"}), (Counts{0, 0, 0, 0}));
}

TEST(PhotonReuse, IsNotDoneWhereTheNumberOfPhotonsFollowsTheView) {
  // A camera so close that many more rays meet the cloud wants more light paths.
  PreparedScenePtr prepared;
  std::vector<std::uint64_t> counts;
  for (int frame = 1; frame <= 4; ++frame) {
    Scene scene = cloud_in_frame(
        frame, {"image.width=160", "image.height=92", "render.passes=1", "render.photons=auto"});
    scene.camera.fov = frame == 3 ? 10 : 24;
    prepared = prepare_scene(scene, prepared);
    const RenderResult result = render_frame(scene, frame, prepared);
    counts.push_back(result.statistics.maps_reused);
    EXPECT_TRUE(same_pixels(result.image, render_alone(scene, frame))) << frame;
  }
  EXPECT_EQ(counts, (Counts{0, 0, 0, 0}));
}

/// A volume that stands still is read once, whatever becomes of the settings; photons that were
/// found with other settings serve no more.
TEST(PhotonReuse, SettingsMayChangeOverOneWorld) {
  PreparedScenePtr first, prepared;
  for (int frame = 1; frame <= 4; ++frame) {
    Scene scene = cloud_in_frame(frame, {"render.thinning=even"});
    scene.render.kernel_shape = frame < 4 ? KernelShape::biweight : KernelShape::constant;
    prepared = prepare_scene(scene, prepared);
    first = first ? first : prepared;
    EXPECT_EQ(prepared->world, first->world) << frame;
    const RenderResult result = render_frame(scene, frame, prepared);
    EXPECT_EQ(result.statistics.maps_reused, frame == 3 ? 3u : 0u) << frame;
    EXPECT_TRUE(same_pixels(result.image, render_alone(scene, frame))) << frame;
  }
}

TEST(PhotonReuse, EndsWhenALightOrTheVolumeChanges) {
  PreparedScenePtr prepared;
  for (int frame = 1; frame <= 5; ++frame) {
    Scene scene = cloud_in_frame(frame);
    scene.lights[0].irradiance = Rgb(frame == 4 ? 2.0f : 1.0f);
    prepared = prepare_scene(scene, prepared);
    const RenderResult result = render_frame(scene, frame, prepared);
    EXPECT_EQ(result.statistics.maps_reused, frame == 3 ? 3u : 0u) << frame;
    EXPECT_TRUE(same_pixels(result.image, render_alone(scene, frame))) << frame;
  }
}

TEST(PhotonCache, KeepsNoMoreThanItMay) {
  PhotonList photons;
  for (int i = 0; i < 64; ++i) {
    photons.position.push_back(Vec3f(static_cast<float>(i)));
    photons.power.push_back(Rgb(1));
  }
  const PhotonMaps map{PhotonMap::build(photons, 1, {}, KernelShape::biweight), {}, {}};
  PhotonCache cache(2 * map.bytes());
  PhotonPassSettings settings;
  settings.paths = 10;
  RadiusSettings radii;
  radii.neighbours = 10;
  for (std::uint64_t pass = 0; pass < 5; ++pass) {
    settings.key.pass = pass;
    cache.keep(settings, radii, map);
  }
  EXPECT_EQ(cache.bytes(), 2 * map.bytes());
  settings.key.pass = 1;
  ASSERT_NE(cache.find(settings, radii), nullptr);
  EXPECT_EQ(cache.find(settings, radii)->medium.size(), 64u);
  settings.key.pass = 2;
  EXPECT_EQ(cache.find(settings, radii), nullptr);
  // Other photons of a pass replace those that are there.
  settings.key.pass = 1;
  settings.paths = 11;
  EXPECT_EQ(cache.find(settings, radii), nullptr);
  cache.keep(settings, radii, map);
  EXPECT_EQ(cache.bytes(), 2 * map.bytes());
  EXPECT_NE(cache.find(settings, radii), nullptr);
}

} // namespace
} // namespace vdbeam
