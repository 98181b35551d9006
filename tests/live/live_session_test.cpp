// What a live session shows after edits is what a render of the edited scene gives.
#include "live/light_mix.h"
#include "vdbeam/live.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace vdbeam {
namespace {

Scene base_scene() {
  return parse_scene(R"(
[image]
width = 32
height = 24
[camera]
position = [0, 0.5, 5]
look_at = [0, 0, 0]
fov = 34
[[volume]]
shape = "sphere"
extinction = 4
albedo = 0.9
phase = { type = "henyey_greenstein", g = 0.5 }
[[light]]
type = "distant"
direction = [-1, -1, -0.5]
irradiance = [3, 2, 1]
[[mesh]]
type = "quad"
scale = 6
translate = [0, -1.5, 0]
rotate = [-90, 0, 0]
material = { type = "diffuse", albedo = 0.4 }
[render]
passes = 3
photons = 2000
estimator = "beam"
)",
                     "fog.toml");
}

/// A session that remembers the last image, and waits for it.
class Watched {
public:
  Watched()
      : session_({.on_image =
                      [this](LiveImage& image) {
                        const std::lock_guard lock(mutex_);
                        last_ = image;
                      },
                  .on_edit = {},
                  .on_error =
                      [this](int, const std::string& line) {
                        const std::lock_guard lock(mutex_);
                        error_ = line;
                        changed_.notify_all();
                      },
                  .on_finished =
                      [this](int edit) {
                        const std::lock_guard lock(mutex_);
                        finished_ = edit;
                        changed_.notify_all();
                      }}) {}

  void show(const Scene& scene) { session_.show(scene); }
  LiveImage image_of(int edit) {
    std::unique_lock lock(mutex_);
    constexpr std::chrono::minutes patience{5};
    changed_.wait_for(lock, patience, [&] { return finished_ == edit || !error_.empty(); });
    EXPECT_EQ(error_, "");
    EXPECT_EQ(finished_, edit);
    return last_;
  }

private:
  std::mutex mutex_;
  std::condition_variable changed_;
  LiveImage last_;
  int finished_ = 0;
  std::string error_;
  LiveSession session_; ///< the last member: it calls back
};

TEST(LiveSession, ShowsWhatARenderOfTheEditedSceneGives) {
  const std::vector<std::pair<const char*, std::function<void(Scene&)>>> edits{
      {"camera", [](Scene& s) { s.camera.position.x = 0.7; }},
      {"extinction", [](Scene& s) { s.volumes[0].extinction = 6; }},
      {"albedo", [](Scene& s) { s.volumes[0].albedo = Rgb(0.8f, 0.7f, 0.6f); }},
      {"phase", [](Scene& s) { s.volumes[0].phase.g = -0.2; }},
      {"direction",
       [](Scene& s) {
         s.lights[0].direction = {1, -1, 0};
       }},
      {"material", [](Scene& s) { s.surfaces[0].material.albedo = Rgb(0.9f); }},
      {"transform", [](Scene& s) { s.surfaces[0].transform[7] = -1.2; }},
  };
  Watched session;
  Scene scene = base_scene();
  session.show(scene);
  int number = 1;
  session.image_of(number);
  for (const auto& [name, edit] : edits) {
    edit(scene);
    session.show(scene);
    const LiveImage shown = session.image_of(++number);
    const Image fresh = render(LightMix::with_groups(scene)).image;
    for (const char* channel : {"R", "G", "B", "A"})
      EXPECT_EQ(shown.image.find(channel)->data, fresh.find(channel)->data) << name;
  }
}

} // namespace
} // namespace vdbeam
