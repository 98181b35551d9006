#include "choose/pass_renderer.h"
#include "film/film.h"
#include "plan/plan.h"
#include "prepare/prepared_scene.h"
#include "support/statistics.h"
#include "vdbeam/image_file.h"
#include "vdbeam/metrics.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

// The sample scenes against pbrt-v4's images of them (data/reference/README.md).
namespace vdbeam {
namespace {

const std::string data = std::string(VDBEAM_SOURCE_DIR) + "/data/";

struct Subject {
  const char* name;
  int frame;
  double noise;    ///< MRSE of the reference itself
  int path_passes; ///< enough for the power that the test asks for

  friend std::ostream& operator<<(std::ostream& out, const Subject& subject) {
    return out << subject.name;
  }
};

double mean_of(const Image& image) {
  double sum = 0;
  for (const char* name : {"R", "G", "B"})
    for (const float value : image.find(name)->data)
      sum += static_cast<double>(value);
  return sum / (3.0 * static_cast<double>(image.width) * image.height);
}

struct Outcome {
  ImageError error;
  double estimate = 0; ///< the film's own MRSE estimate
  test::Samples means; ///< of the passes, over the reference's mean
};

Outcome render(const Subject& subject, EstimatorType type, int passes) {
  Scene scene = load_scene(data + subject.name + ".toml", subject.frame);
  scene.render.estimator = type;
  const Image reference = read_image(data + "reference/" + subject.name + ".exr");
  const PreparedScenePtr prepared = prepare_scene(scene);
  const World& world = *prepared->world;
  const Camera camera(scene.camera, scene.image, world.space);
  const RenderPlan plan = plan_stages(scene, volume_facts(prepared->facts, world, camera));
  const auto estimator = make_pass_renderer(type, {world, camera, scene.render, plan});
  Film film(scene.image.width, scene.image.height);
  PassImage pass_image;
  RenderStatistics statistics;
  Outcome outcome;
  const double reference_mean = mean_of(reference);
  for (int pass = 0; pass < passes; ++pass) {
    estimator->render_pass(pass, pass_image, statistics);
    film.add(pass_image);
    double sum = 0;
    for (std::size_t i = 0; i < pass_image.direct.size(); ++i)
      sum += static_cast<double>(
          mean_component(pass_image.direct[i] + pass_image.indirect[i] + pass_image.background[i]));
    outcome.means.add(sum / static_cast<double>(pass_image.direct.size()) / reference_mean);
  }
  outcome.error = image_error(film.develop(), reference);
  outcome.estimate = film.mrse_estimate();
  return outcome;
}

class SlowReference : public testing::TestWithParam<Subject> {};

// 0.1 % is what four renderers differ by among themselves.
TEST_P(SlowReference, PathAgrees) {
  const Outcome outcome = render(GetParam(), EstimatorType::path, GetParam().path_passes);
  test::expect_mean(outcome.means, 1, 0.003);
  EXPECT_LT(outcome.means.error(), 0.001);
  // No error but the noise of the two images.
  EXPECT_NEAR(outcome.error.mrse, outcome.estimate + GetParam().noise, 0.15 * outcome.error.mrse);
}

TEST_P(SlowReference, BeamAgrees) {
  const Outcome outcome = render(GetParam(), EstimatorType::automatic, 24);
  test::expect_mean(outcome.means, 1, 0.005);
  EXPECT_LT(outcome.means.error(), 0.002);
  // The noise of both, and the bias of the default's wide kernels: after so few passes up to 2.5 %
  // of a pixel.
  EXPECT_LT(outcome.error.mrse, outcome.estimate + GetParam().noise + 0.025 * 0.025);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SlowReference,
                         testing::Values(Subject{"cloud", 1, 0.00015, 24},
                                         Subject{"smoke", 24, 0.00017, 12}),
                         [](const testing::TestParamInfo<Subject>& subject) {
                           return std::string(subject.param.name);
                         });

} // namespace
} // namespace vdbeam
