#include "film/film_file.h"
#include "photonmap/map_queries.h"
#include "support/image_checks.h"
#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <cstring>
#include <limits>

namespace vdbeam {
namespace {

using test::expect_same_pixels;

/// The sample cloud, small and quick.
Scene cloud_of_six_passes(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"image.width=40", "image.height=23", "render.photons=1500",
                                     "render.passes=6"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml", 1, overrides);
}

class Partial : public ::testing::Test {
protected:
  std::string render_range(int first, int last, const Scene& scene = cloud_of_six_passes()) {
    return test::render_parts(scene, folder_, {{first, last}}).front();
  }
  std::string error_of(const std::vector<std::string>& paths, const MergeSettings& settings = {}) {
    try {
      merge_partials(paths, settings);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  test::TempFolder folder_;
};

TEST_F(Partial, MergesToTheUndividedImage) {
  const Image whole = render(cloud_of_six_passes()).image;
  const std::string a = render_range(0, 0), b = render_range(1, 3), c = render_range(4, 5);
  expect_same_pixels(merge_partials({c, a, b}), whole);
  // In a tree: (b + c) + a.
  const MergeSettings inner{true, std::nullopt, folder_.file("bc.exr"), ""};
  merge_partials({b, c}, inner);
  expect_same_pixels(merge_partials({a, inner.partial}, {false, 6, "", ""}), whole);
}

TEST_F(Partial, OpensInAViewer) {
  const Image image = read_image(render_range(0, 1));
  for (const char* name : {"R", "G", "B", "A"})
    ASSERT_TRUE(image.find(name)) << name;
  const Image rendered = render(cloud_of_six_passes({"render.passes=2"})).image;
  EXPECT_EQ(image.find("R")->data, rendered.find("R")->data);
}

TEST_F(Partial, FilmComesBackBitForBit) {
  const std::string path = render_range(0, 3);
  const FilmFileInfo info = read_film_info(path);
  Film film = read_film(path, info);
  write_film(info, film, folder_.file("again.exr"));
  Film again = read_film(folder_.file("again.exr"), read_film_info(folder_.file("again.exr")));
  EXPECT_EQ(again.passes(), 4);
  EXPECT_EQ(again.mrse_estimate(), film.mrse_estimate());
  EXPECT_TRUE(again.mrse_estimate() > 0);
  expect_same_pixels(again.develop(), film.develop());
}

TEST_F(Partial, RefusesWhatDoesNotBelongTogether) {
  const std::string a = render_range(0, 1), b = render_range(1, 2), d = render_range(4, 4);
  EXPECT_NE(error_of({a, b}).find("passes 1 are there twice"), std::string::npos);
  EXPECT_NE(error_of({a, d}).find("passes 2,3 are missing"), std::string::npos);
  EXPECT_NE(error_of({b}).find("passes 0 are missing"), std::string::npos);
  EXPECT_NE(error_of({a}, {false, 6, "", ""}).find("passes 2-5 are missing"), std::string::npos);
  EXPECT_NE(error_of({a}, {false, 1, "", ""}).find("passes 1 are more than"), std::string::npos);
  EXPECT_TRUE(error_of({a, d}, {true, std::nullopt, "", ""}).empty());
  const std::string other = render_range(2, 3, cloud_of_six_passes({"render.seed=9"}));
  EXPECT_NE(error_of({a, other}).find("the scenes differ"), std::string::npos);
  const std::string smaller = render_range(3, 3, cloud_of_six_passes({"image.width=39"}));
  EXPECT_NE(error_of({a, smaller}).find("the scenes differ"), std::string::npos);
  // Only the stop rule differs: they are passes of one picture.
  const std::string longer = render_range(2, 3, cloud_of_six_passes({"render.passes=64"}));
  EXPECT_TRUE(error_of({a, longer}).empty());
}

/// A pass that no --pass-range could name: a list of all passes up to it would take gigabytes.
TEST_F(Partial, PassesOfFilesAreBoundedLikeThoseOfOptions) {
  const std::string path = render_range(0, 0), far = folder_.file("far.exr");
  FilmFileInfo info = read_film_info(path);
  Film film = read_film(path, info);
  for (const int pass : {std::numeric_limits<int>::max(), most_passes}) {
    info.passes = {pass};
    write_film(info, film, far);
    EXPECT_EQ(error_of({far}),
              far + ": is a damaged partial image; delete it and render its passes again");
  }
  info.passes = {most_passes - 1};
  write_film(info, film, far);
  EXPECT_TRUE(error_of({far}, {true, std::nullopt, "", ""}).empty());
}

/// Confines this machine to a SIMD target without fused multiply-add, as an old one would have.
struct OldMachine {
  OldMachine() {
    for (const std::int64_t target : simd_targets()) {
      confine_simd_targets(target);
      if (!simd_is_fused())
        return;
    }
  }
  ~OldMachine() { confine_simd_targets(0); }
};

TEST_F(Partial, OfMachinesThatRoundDifferentlyAreRefused) {
  const std::string a = render_range(0, 1);
  std::string b;
  {
    const OldMachine old;
    ASSERT_FALSE(simd_is_fused());
    b = render_range(2, 3);
  }
  EXPECT_NE(error_of({a, b}).find("round differently"), std::string::npos);
  // Newer machines agree, whatever their vectors' width.
  for (const std::int64_t target : simd_targets()) {
    confine_simd_targets(target);
    if (!simd_is_fused())
      continue;
    const std::string c = render_range(2, 3);
    confine_simd_targets(0);
    expect_same_pixels(merge_partials({a, c}),
                       render(cloud_of_six_passes({"render.passes=4"})).image);
  }
  confine_simd_targets(0);
}

TEST_F(Partial, DamagedAndForeignFilesAreRefusedInOneLine) {
  const std::string path = render_range(0, 0), bytes = test::read_bytes(path);
  const std::string broken = folder_.file("broken.exr");
  for (const double share : {0.0, 0.01, 0.3, 0.9, 0.999}) {
    test::write_bytes(broken, bytes.substr(0, static_cast<std::size_t>(
                                                  share * static_cast<double>(bytes.size()))));
    const std::string error = error_of({broken});
    EXPECT_FALSE(error.empty()) << share;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
  write_exr(render(cloud_of_six_passes({"render.passes=1"})).image, broken);
  EXPECT_NE(error_of({broken}).find("not a partial image"), std::string::npos);
  EXPECT_FALSE(error_of({folder_.file("absent.exr")}).empty());
}

TEST(Region, PixelsAreThoseOfTheWholeImage) {
  const std::vector<std::vector<std::string>> ways = {{"render.estimator=beam"},
                                                      {"render.estimator=gather"},
                                                      {"render.estimator=march"},
                                                      {"render.estimator=path"}};
  for (std::vector<std::string> way : ways) {
    way.push_back("render.passes=2");
    const Scene scene = cloud_of_six_passes(way);
    const Image whole = render(scene).image;
    FrameSettings frame;
    frame.region = PixelRegion{9, 5, 31, 19};
    const Image part = render(scene, frame).image;
    ASSERT_EQ(part.width, 22);
    ASSERT_EQ(part.height, 14);
    for (const char* name : {"R", "volume_indirect.G", "depth.Z"})
      for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
          ASSERT_EQ(part.find(name)->data[static_cast<std::size_t>(y * part.width + x)],
                    whole.find(name)->data[static_cast<std::size_t>((y + 5) * 40 + x + 9)])
              << way[0] << " " << name << " " << x << " " << y;
  }
}

TEST(Region, IsADataWindowInTheFile) {
  const test::TempFolder folder;
  FrameSettings frame;
  frame.region = PixelRegion{9, 5, 31, 19};
  const Image part = render(cloud_of_six_passes({"render.passes=1"}), frame).image;
  write_exr(part, folder.file("a.exr"));
  const Image read = read_image(folder.file("a.exr"));
  ASSERT_EQ(read.width, 40);
  ASSERT_EQ(read.height, 23);
  EXPECT_EQ(read.find("A")->data[4 * 40 + 20], 0);
  EXPECT_EQ(read.find("depth.Z")->data[12 * 40 + 20], part.find("depth.Z")->data[7 * 22 + 11]);
  frame.region = PixelRegion{9, 5, 41, 19};
  EXPECT_THROW(render(cloud_of_six_passes(), frame), InputError);
}

/// Ends a render after some passes, as a signal does.
struct Stopper {
  explicit Stopper(int passes) : passes_(passes) {}
  RenderResult render(const Scene& scene, const std::string& checkpoint) {
    FrameSettings frame;
    frame.checkpoint.path = checkpoint;
    RenderHooks hooks;
    hooks.stop = &stop_;
    hooks.on_pass = [this](const PassRecord& record, const RenderStatistics&) {
      stop_ = record.pass >= passes_;
    };
    return vdbeam::render(scene, frame, hooks);
  }

private:
  int passes_;
  std::atomic<bool> stop_{false};
};

TEST(Checkpoint, ResumesBitForBit) {
  const test::TempFolder folder;
  const std::string path = folder.file("c.exr");
  const RenderResult whole = render(cloud_of_six_passes());
  for (const int passes : {2, 5}) {
    Stopper stopper(passes);
    const RenderResult stopped = stopper.render(cloud_of_six_passes(), path);
    EXPECT_EQ(stopped.stopped_by, "stop");
    EXPECT_EQ(read_film_info(path).passes.size(), static_cast<std::size_t>(passes));
  }
  FrameSettings frame;
  frame.checkpoint.path = path;
  const RenderResult resumed = render(cloud_of_six_passes(), frame);
  EXPECT_EQ(resumed.resumed_passes, 5);
  EXPECT_EQ(resumed.passes.back().pass, 6);
  EXPECT_EQ(resumed.passes.back().error_estimate, whole.passes.back().error_estimate);
  expect_same_pixels(resumed.image, whole.image);
}

TEST(Checkpoint, IsWrittenAtIntervalsOfPassesAndOfSeconds) {
  const test::TempFolder folder;
  for (const bool by_time : {false, true}) {
    FrameSettings frame;
    frame.checkpoint.path = folder.file("c.exr");
    frame.checkpoint.passes = by_time ? 0 : 4;
    frame.checkpoint.seconds = by_time ? 1e-9 : 0;
    frame.checkpoint.resume = false;
    render(cloud_of_six_passes(), frame);
    EXPECT_EQ(read_film_info(frame.checkpoint.path).passes.size(), by_time ? 6u : 4u);
  }
}

TEST(Checkpoint, OfAMachineThatRoundsDifferentlyIsNotUsed) {
  const test::TempFolder folder;
  const std::string path = folder.file("c.exr");
  {
    const OldMachine old;
    Stopper stopper(2);
    stopper.render(cloud_of_six_passes(), path);
  }
  FrameSettings frame;
  frame.checkpoint.path = path;
  const RenderResult resumed = render(cloud_of_six_passes(), frame);
  EXPECT_EQ(resumed.resumed_passes, 0);
  ASSERT_FALSE(resumed.notes.empty());
  EXPECT_NE(resumed.notes.back().find("rounds differently"), std::string::npos);
  expect_same_pixels(resumed.image, render(cloud_of_six_passes()).image);
}

TEST(Checkpoint, OfAnotherSceneOrBrokenIsNotUsed) {
  const test::TempFolder folder;
  const std::string path = folder.file("c.exr");
  Stopper stopper(2);
  stopper.render(cloud_of_six_passes({"render.seed=9"}), path);
  FrameSettings frame;
  frame.checkpoint.path = path;
  const RenderResult whole = render(cloud_of_six_passes()),
                     other = render(cloud_of_six_passes(), frame);
  EXPECT_EQ(other.resumed_passes, 0);
  ASSERT_FALSE(other.notes.empty());
  EXPECT_NE(other.notes.back().find("another scene"), std::string::npos);
  expect_same_pixels(other.image, whole.image);
  test::write_bytes(path, test::read_bytes(path).substr(0, 5000));
  const RenderResult broken = render(cloud_of_six_passes(), frame);
  EXPECT_EQ(broken.resumed_passes, 0);
  expect_same_pixels(broken.image, whole.image);
}

TEST(PreparedScene, IsTakenOverWhereNothingChanged) {
  const Scene scene = cloud_of_six_passes();
  const PreparedScenePtr first = prepare_scene(scene);
  Scene moved = scene;
  moved.camera.position.x += 0.5;
  const PreparedScenePtr second = prepare_scene(moved, first);
  EXPECT_EQ(render(moved, second).statistics.read, 0);
  expect_same_pixels(render(moved, second).image, render(moved).image);
  // A light that changes needs a new world, but not a new volume.
  Scene lit = moved;
  lit.lights[0].irradiance = Rgb(1);
  lit.volumes[0].extinction *= 2;
  const PreparedScenePtr third = prepare_scene(lit, second);
  expect_same_pixels(render(lit, third).image, render(lit).image);
}

} // namespace
} // namespace vdbeam
