// Random scenes against the laws: every pixel finite and not negative, no energy created, beam =
// march = path within their errors. Every scene is a pure function of its seed, which is printed:
//   vdbeam_stress --seconds 600            scenes of seeds 1, 2, ... for ten minutes
//   vdbeam_stress --seed 17                that scene alone, in words
// Exit status: 0, or 1 where a law is broken.
#include "stress/random_scene.h"
#include "support/render_passes.h"

#include <CLI/CLI.hpp>

#include <chrono>

namespace {

using namespace vdbeam;
using namespace vdbeam::test;

constexpr EstimatorType types[] = {EstimatorType::path, EstimatorType::beam, EstimatorType::march};
constexpr const char* names[] = {"path", "beam", "march"};

/// A mean with its standard error.
struct Measured {
  double mean = 0, error = 0;
  std::size_t count = 0;
};

Measured measured(const Samples& samples) {
  return {samples.mean(), samples.error(), samples.count()};
}

class SceneCheck {
public:
  explicit SceneCheck(std::uint64_t seed) : random_(seed) {}

  const std::string& description() const { return random_.description(); }
  /// What is wrong; empty where nothing is.
  std::string complaint() {
    // Rare bright samples may break a limit once; a broken law breaks it again with more passes.
    const std::string first = attempt(8, 0);
    return first.empty() ? first : attempt(48, 1);
  }

private:
  std::string attempt(int passes, std::uint64_t shift) {
    const MemoryScene& scene = random_.scene();
    std::array<PassMeans, 3> means;
    for (std::size_t i = 0; i < 3; ++i) {
      means[i] = render(scene, types[i], passes, shift);
      const std::string unsound = check_pixels(means[i], names[i]);
      if (!unsound.empty())
        return unsound;
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const Measured path = measured(means[0].total[c]), other = measured(means[i].total[c]);
        const double error = student_limit(path.count) * std::hypot(path.error, other.error);
        const double allowed = error + (i > 0 ? 0.05 * path.mean : 1e-4) + 1e-12;
        // Path has none to agree with but where the answer is known.
        const double truth = i == 0 && random_.white_furnace() ? 1 : path.mean;
        const bool agrees = std::abs(other.mean - truth) <= allowed;
        const bool creates = random_.furnace() && other.mean > 1 + allowed;
        if ((agrees && !creates) || (i > 0 && converges(means[i], means[0], i, passes, shift, c)))
          continue;
        return fmt::format("channel {}: {} gives {} +- {}, path {} +- {}, allowed {}{}", c,
                           names[i], other.mean, other.error, path.mean, path.error, allowed,
                           random_.furnace() ? ", in a furnace of 1" : "");
      }
    return {};
  }

  /// What is beyond the rest must be bias, which narrower kernels lower: with eight times the
  /// photons in kernels of the same number, radii are half as large. Where kernels are narrow, bias
  /// goes as their square and at most twice what they change is left; where they are tens of mean
  /// free paths wide, since the scene has fewer photons than its depth needs, it must at least
  /// become less, with 64 times the photons if not before.
  bool converges(const PassMeans& coarse, const PassMeans& path, std::size_t type, int passes,
                 std::uint64_t shift, std::size_t channel) const {
    const Measured truth = measured(path.total[channel]), wide = measured(coarse.total[channel]);
    const double error = student_limit(wide.count) * std::hypot(wide.error, truth.error);
    const double bias = std::abs(wide.mean - truth.mean);
    for (const int factor : {2, 4}) {
      MemoryScene scene = random_.scene();
      RenderSettings& settings = scene.scene.render;
      settings.photons = *settings.photons * static_cast<std::uint64_t>(factor * factor * factor);
      settings.neighbours = static_cast<int>(std::lround(coarse.statistics.neighbours));
      settings.radius /= factor;
      const PassMeans narrower = render(scene, types[type], passes, shift);
      const Measured narrow = measured(narrower.total[channel]);
      const double doubt = student_limit(wide.count) * std::hypot(wide.error, narrow.error);
      if (bias <= error + 2 * std::abs(wide.mean - narrow.mean) + 0.05 * truth.mean ||
          std::abs(narrow.mean - truth.mean) < bias - doubt)
        return true;
    }
    return false;
  }

  static PassMeans render(MemoryScene scene, EstimatorType type, int passes, std::uint64_t shift) {
    scene.scene.render.seed += shift << 32;
    return render_passes(scene, type, passes);
  }

  static std::string check_pixels(const PassMeans& means, const char* name) {
    for (std::size_t i = 0; i < means.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c)
        if (!(std::isfinite(means.pixels[i][c]) && means.pixels[i][c] >= 0))
          return fmt::format("{}: pixel {} channel {} is {}", name, i, c, means.pixels[i][c]);
    return {};
  }

  RandomScene random_;
};

struct Options {
  std::uint64_t seed = 0, first = 1;
  double seconds = 20;
};

double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

/// True where the scene keeps the laws.
bool check(std::uint64_t seed, bool talk) {
  const double start = now();
  SceneCheck scene(seed);
  const std::string complaint = scene.complaint();
  const double seconds = now() - start;
  constexpr double slow = 30;
  if (talk || !complaint.empty() || seconds > slow)
    fmt::print("seed {}: {}\n  {}({:.1f} s)\n", seed,
               complaint.empty() ? "keeps the laws" : complaint, scene.description(), seconds);
  return complaint.empty();
}

int run(const Options& options) {
  if (options.seed > 0)
    return check(options.seed, true) ? 0 : 1;
  const double end = now() + options.seconds;
  std::uint64_t seed = options.first, broken = 0;
  for (; now() < end; ++seed)
    broken += check(seed, false) ? 0 : 1;
  fmt::print("scenes of seeds {} to {}: {} break a law\n", options.first, seed - 1, broken);
  return broken == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app("Renders random scenes and checks the laws of light");
  Options options;
  app.add_option("--seed", options.seed, "Only the scene of this seed");
  app.add_option("--first", options.first, "First seed of a run");
  app.add_option("--seconds", options.seconds, "How long a run lasts");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
