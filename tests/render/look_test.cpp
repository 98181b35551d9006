#include "grids/edited_field.h"
#include "prepare/read_volumes.h"
#include "support/ball_scene.h"
#include "vdbeam/error.h"
#include "vdbeam/memory_plan.h"

namespace vdbeam {
namespace {

/// The ball, seen by parallel rays.
class Look : public test::BallTest {
protected:
  Scene load(const std::vector<std::string>& more = {}) {
    std::vector<std::string> overrides{"render.passes=4"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return load_ball(parallel_rays, overrides);
  }
  static std::vector<float> opacity(const Image& image) { return image.find("A")->data; }
  static float at(const std::vector<float>& values, double x, double y) {
    const int px = static_cast<int>((x + 3) * 4), py = static_cast<int>((3 - y) * 4);
    return values[static_cast<std::size_t>(py * 24 + px)];
  }
  static void expect_near(const std::vector<float>& a, const std::vector<float>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      ASSERT_NEAR(a[i], b[i], 1e-5) << i;
  }
};

TEST_F(Look, DensityScaleIsAFactorOfTheExtinction) {
  const Image scaled = render(load({"volume.0.density_scale=3"})).image;
  expect_near(opacity(scaled), opacity(render(load({"volume.0.extinction=1.5"})).image));
  const Image limited = render(load({"volume.0.density_scale=8", "volume.0.density_max=3"})).image;
  // At the ball's border the density falls over a voxel, from 3 there and from 3 here.
  EXPECT_NEAR(at(opacity(limited), 0, 0), at(opacity(scaled), 0, 0), 1e-3);
}

TEST_F(Look, TheBoxCutsAndStaysWhereItIs) {
  const std::vector<std::string> box{"volume.0.box_lower=[-2, -2, -6]",
                                     "volume.0.box_upper=[0.3, 2, 6]"};
  const std::vector<float> whole = opacity(render(load()).image);
  const std::vector<float> cut = opacity(render(load(box)).image);
  EXPECT_NEAR(at(cut, -0.4, 0.1), at(whole, -0.4, 0.1), 1e-5);
  EXPECT_GT(at(whole, 0.6, 0.1), 0.1);
  EXPECT_EQ(at(cut, 0.6, 0.1), 0);
  // The ball moves half a unit to the right and one up; the box does not.
  std::vector<std::string> moved = box;
  moved.insert(moved.end(), {"camera.shutter_open=0.4999", "camera.shutter_close=0.5001",
                             "camera.shutter_times=1"});
  const std::vector<float> later = opacity(render(load(moved)).image);
  // Between voxels the moved ball is interpolated: its border is a little softer.
  EXPECT_NEAR(at(later, 0.1, 1.1), at(whole, -0.4, 0.1), 0.02);
  EXPECT_EQ(at(later, 0.6, 1.1), 0);
}

/// Each grid of a moving volume is read once, whatever is done to it at each moment; the picture is
/// that of moments that read for themselves.
TEST_F(Look, MomentsDoNotReadFilesAgain) {
  const std::vector<std::string> open{"camera.shutter_open=-0.2", "camera.shutter_close=0.4",
                                      "camera.shutter_times=2"};
  const std::vector<std::string> box{"volume.0.box_lower=[-2, -2, -6]",
                                     "volume.0.box_upper=[0.3, 2, 6]"};
  const std::vector<std::string> scaled{"volume.0.density_scale=2", "volume.0.interpolation=cubic"};
  const std::vector<std::string> glowing{"volume.0.emission.intensity=density",
                                         "volume.0.noise_amplitude=0.05"};
  const std::vector<std::string> turning{"volume.0.translate={keys=[[1,[0,0,0]],[2,[0.5,0,0]]]}"};
  struct Case {
    std::vector<std::vector<std::string>> settings;
    std::uint64_t grids; ///< velocity, density and emission
  };
  for (const Case& which : {Case{{}, 2}, Case{{box}, 2}, Case{{scaled}, 2}, Case{{glowing}, 3},
                            Case{{box, scaled, glowing}, 3}, Case{{box, turning}, 2}}) {
    std::vector<std::string> more = open;
    for (const std::vector<std::string>& settings : which.settings)
      more.insert(more.end(), settings.begin(), settings.end());
    const Scene scene = load(more);
    const RenderResult result = render(scene);
    EXPECT_EQ(result.statistics.grids_read, which.grids) << testing::PrintToString(more);
    // The moments one by one: each is the scene's own picture at its time.
    PreparedScenePtr prepared = prepare_scene(scene);
    auto without = std::make_shared<PreparedScene>(*prepared);
    for (ReadVolume& volume : without->volumes)
      volume.sources.clear();
    for (const std::size_t m : {std::size_t{0}, scene.moments.size() - 1}) {
      const PreparedScenePtr kept = prepare_scene(scene.moments[m], prepared),
                             read = prepare_scene(scene.moments[m], without);
      EXPECT_EQ(kept->grids_read, 0u);
      EXPECT_EQ(kept->world->medium.volumes[0].field.maximum(),
                read->world->medium.volumes[0].field.maximum());
      const DensityField &a = kept->world->medium.volumes[0].field,
                         &b = read->world->medium.volumes[0].field;
      double sum = 0;
      for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j)
          for (int k = -20; k <= 20; k += 2) {
            const Vec3d at(0.5 + i, 0.5 + j, k);
            const float value = a.sample(Vec3f(at - Vec3d(a.origin())));
            ASSERT_NEAR(value, b.sample(Vec3f(at - Vec3d(b.origin()))), 2e-5) << at.x;
            sum += static_cast<double>(value);
          }
      EXPECT_GT(sum, 100);
    }
  }
}

/// Only the part of the file that can come into the box is read, whatever brings it there, and the
/// plan knows.
TEST_F(Look, TheBoxIsAllThatIsRead) {
  VolumeOptions options;
  options.size = 96;
  options.extent = 2;
  write_volume("staggered", folder_.file("ball.vdb"), options);
  const std::vector<std::string> box{"volume.0.box_lower=[0.21, -0.29, -0.29]",
                                     "volume.0.box_upper=[0.49, 0.09, 0.19]",
                                     "volume.0.translate=[0.1, 0, 0]"};
  const auto with = [](std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  const PreparedScenePtr whole = prepare_scene(load()), part = prepare_scene(load(box));
  EXPECT_LT(part->facts.volumes[0].density, whole->facts.volumes[0].density / 4);
  const MemoryPlan all = plan_memory(load()), cut = plan_memory(load(box));
  EXPECT_LT(cut.kept, all.kept / 4);
  EXPECT_FALSE(make_plan(load({"volume.0.box_lower=[5, 5, 5]", "volume.0.box_upper=[6, 6, 6]"}))
                   .needs(Stage::majorants));
  // The values in the box are those of the whole volume, cut afterwards.
  options.size = 40;
  write_volume("staggered", folder_.file("ball.vdb"), options);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{},
        {"volume.0.noise_amplitude=0.25", "volume.0.noise_size=0.2"},
        {"volume.0.interpolation=cubic", "volume.0.noise_amplitude=0.1"}})
    for (const double time : {0.0, 0.2}) {
      Scene boxed = load(with(box, more));
      VolumeSettings volume = boxed.volumes[0];
      volume.velocity.time = time;
      const auto take = [&](const VolumeSettings& wanted) {
        ReadVolume read;
        if (time != 0)
          read.velocity = read_velocity(wanted.file, wanted.velocity);
        return take_grid(wanted, nullptr, StopToken(), read);
      };
      const DensityGrid found = take(volume);
      volume.box_lower = volume.box_upper = {};
      DensityGrid expected = take(volume);
      GridEdits edits;
      edits.to_world = Affine::from_matrix(volume.transform).after(expected.index_to_world);
      edits.box = Boxd{*boxed.volumes[0].box_lower, *boxed.volumes[0].box_upper};
      expected.field = edited_field(expected.field, edits);
      const auto value = [](const DensityGrid& grid, const Vec3d& index) {
        return grid.field.sample(Vec3f(index - Vec3d(grid.field.origin())));
      };
      double sum = 0;
      const Boxd lattice = edits.to_world.inverse().bounds(*edits.box);
      for (double i = std::floor(lattice.lower.x) - 2; i <= lattice.upper.x + 2; ++i)
        for (double j = std::floor(lattice.lower.y) - 2; j <= lattice.upper.y + 2; ++j)
          for (double k = std::floor(lattice.lower.z) - 2; k <= lattice.upper.z + 2; ++k) {
            ASSERT_NEAR(value(found, {i, j, k}), value(expected, {i, j, k}), 2e-5)
                << i << " " << j << " " << k << " time " << time;
            sum += static_cast<double>(value(found, {i, j, k}));
          }
      EXPECT_GT(sum, 100);
      EXPECT_LT(found.active_voxels, expected.active_voxels);
    }
}

TEST_F(Look, FramesDoNotTakeOverOtherEdits) {
  const Scene plain = load(), scaled = load({"volume.0.density_scale=3"});
  const PreparedScenePtr first = prepare_scene(plain), second = prepare_scene(scaled, first);
  EXPECT_EQ(opacity(render(scaled, second).image), opacity(render(scaled).image));
  EXPECT_EQ(opacity(render(plain, prepare_scene(plain, second)).image),
            opacity(render(plain).image));
}

TEST_F(Look, AMaskMultiplies) {
  // The ball as its own mask: the density is 1 in it.
  const std::vector<float> masked = opacity(render(load({"volume.0.mask=density"})).image);
  EXPECT_NEAR(at(masked, 0, 0), at(opacity(render(load()).image), 0, 0), 1e-5);
  EXPECT_THROW(render(load({"volume.0.mask=nothing"})), InputError);
}

TEST_F(Look, SeveralMasksMultiply) {
  write("colored", "box.vdb"); // tints of 1/4 and 3/4 in all of it
  const std::string file = "volume.0.file=" + folder_.file("box.vdb");
  expect_near(opacity(render(load({file, "volume.0.mask=tint_g, tint_b"})).image),
              opacity(render(load({file, "volume.0.density_scale=0.1875"})).image));
  EXPECT_THROW(render(load({file, "volume.0.mask=tint_g, nothing"})), InputError);
}

TEST_F(Look, NamesTheMistake) {
  const auto error = [&](const std::vector<std::string>& overrides) {
    try {
      load(overrides);
    } catch (const InputError& problem) {
      const std::string text = problem.what();
      return text.substr(text.find(": ") + 2);
    }
    return std::string();
  };
  EXPECT_EQ(error({"volume.0.box_lower=[0,0,0]"}),
            "volume.0.box_lower needs the other corner too: box_lower and box_upper");
  EXPECT_EQ(error({"volume.0.box_lower=[0,0,0]", "volume.0.box_upper=[1,1,0]"}),
            "volume.0.box_upper must be greater than box_lower along all three axes");
}

/// Colours of the file multiply the albedo where they are, move with the volume, and are forgotten
/// by frames that do not ask for them.
TEST_F(Look, ColorsMultiplyTheAlbedo) {
  write("colored", "box.vdb");
  const std::vector<std::string> white{"volume.0.file=" + folder_.file("box.vdb"),
                                       "volume.0.extinction=0.01", "render.max_bounces=1",
                                       "render.passes=64"};
  std::vector<std::string> painted = white;
  painted.push_back("volume.0.color_grid=auto");
  const Image plain = render(load(white)).image;
  const auto colors_at = [&](const Image& image, double x, double y) {
    Vec3d ratio;
    for (int c = 0; c < 3; ++c)
      ratio[c] = at(image.find(std::string(1, "RGB"[c]))->data, x, y) /
                 at(plain.find(std::string(1, "RGB"[c]))->data, x, y);
    return ratio;
  };
  const Image tinted = render(load(painted)).image;
  for (const double x : {-0.6, -0.1, 0.4, 0.65}) {
    const double middle = (std::floor(x * 4) + 0.5) / 4; // of the pixel
    EXPECT_LT(length(colors_at(tinted, x, 0.1) - Vec3d(0.5 + middle / 2, 0.25, 0.75)), 0.01) << x;
  }
  painted.push_back("volume.0.translate=[0.25, 0, 0]");
  EXPECT_LT(length(colors_at(render(load(painted)).image, 0.4, 0.1) -
                   Vec3d(0.5 + (0.375 - 0.25) / 2, 0.25, 0.75)),
            0.01);
  painted.pop_back();
  std::vector<std::string> moved = painted; // by (1, 1, 1) a second, seen after a quarter
  moved.insert(moved.end(),
               {"volume.0.velocity=density,density,density", "camera.shutter_open=0.2499",
                "camera.shutter_close=0.2501", "camera.shutter_times=1"});
  EXPECT_LT(length(colors_at(render(load(moved)).image, 0.4, 0.1) -
                   Vec3d(0.5 + (0.375 - 0.25) / 2, 0.25, 0.75)),
            0.01);
  const PreparedScenePtr first = prepare_scene(load(painted)),
                         second = prepare_scene(load(white), first);
  EXPECT_EQ(render(load(white), second).image.find("R")->data, plain.find("R")->data);
  EXPECT_EQ(render(load(painted), prepare_scene(load(painted), first)).image.find("R")->data,
            tinted.find("R")->data);
  EXPECT_THROW(render(load({"volume.0.color_grid=nothing"})), InputError);
  EXPECT_EQ(opacity(tinted), opacity(plain));
}

TEST_F(Look, GridsAreAdded) {
  const std::vector<float> twice = opacity(render(load({"volume.0.add=density"})).image);
  expect_near(twice, opacity(render(load({"volume.0.density_scale=2"})).image));
  EXPECT_THROW(render(load({"volume.0.add=nothing"})), InputError);
}

TEST_F(Look, NoiseDisplacesByItsSeed) {
  const std::vector<float> plain = opacity(render(load()).image);
  std::vector<std::vector<float>> pictures;
  for (const char* seed : {"1", "1", "2"})
    pictures.push_back(opacity(
        render(load({"volume.0.noise_amplitude=0.3", std::string("volume.0.noise_seed=") + seed}))
            .image));
  EXPECT_EQ(pictures[0], pictures[1]);
  EXPECT_NE(pictures[0], pictures[2]);
  EXPECT_NE(pictures[0], plain);
  EXPECT_EQ(opacity(render(load({"volume.0.noise_seed=9"})).image), plain); // amplitude 0
  // With a radius of 0.9 nothing comes farther than 0.9 + 0.3 along an axis, and a voxel.
  EXPECT_EQ(at(pictures[0], 1.4, 0), 0);
  // It moves with the volume.
  const std::vector<float> moved =
      opacity(render(load({"volume.0.noise_amplitude=0.3", "volume.0.translate=[1, 0, 0]"})).image);
  double difference = 0, sum = 0;
  for (double x = -1.2; x < 1.2; x += 0.25) {
    difference += std::abs(at(moved, x + 1, 0.1) - at(pictures[0], x, 0.1));
    sum += at(pictures[0], x, 0.1);
  }
  EXPECT_LT(difference, 0.1 * sum); // rays of other pixels are spread otherwise
}

} // namespace
} // namespace vdbeam
