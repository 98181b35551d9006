#include "choose/schedule.h"

#include "math/rng.h"
#include "phase/truncated_phase.h"
#include "tuning/constants.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace vdbeam {

namespace {

/// How truncation shrinks from pass to pass.
struct OrderGrowth {
  int passes_of_first_order;
  int factor; ///< the order grows by one when the number of passes has grown by this factor
};
/// Measured on backlit and on Mie clouds (research-log/decisions.md): the bias of order 4 along
/// rays is under the noise of 64 passes; of walks one order more halves the squared bias, so that
/// it falls as fast as the noise.
constexpr OrderGrowth growth_along_rays{64, 3}, growth_of_gather{16, 2};

/// The bits of a number behind the point, in reverse (van der Corput 1935): 0, 1/2, 1/4, 3/4, ...
double radical_inverse(std::uint32_t n) {
  std::uint32_t reversed = 0;
  for (int bit = 0; bit < 32; ++bit)
    reversed |= (n >> bit & 1) << (31 - bit);
  return static_cast<double>(reversed) * 0x1p-32;
}

} // namespace

std::size_t motion_sample(int pass, std::size_t samples, std::uint64_t seed) {
  const double shift = static_cast<double>(mix64(seed) >> 11) * 0x1p-53;
  const double place = radical_inverse(static_cast<std::uint32_t>(pass)) + shift;
  const double part = (place - std::floor(place)) * static_cast<double>(samples);
  return std::min(static_cast<std::size_t>(part), samples - 1);
}

int peak_order(const PeakOrders& first, int pass, bool gathers) {
  if (!first.taken_out)
    return 0;
  // Multiples of the golden ratio spread the pairs of passes of one more evenly.
  const double spread = std::fmod(0.5 + 0.61803398875 * (pass / 2), 1.0);
  int result = static_cast<int>((gathers ? first.of_gather : first.along_rays) + spread);
  const OrderGrowth growth = gathers ? growth_of_gather : growth_along_rays;
  for (std::int64_t until = growth.passes_of_first_order; pass >= until; until *= growth.factor)
    ++result;
  // The lower of the two leaves room for the higher. One pass of each pair has the higher, the
  // first as often as the second (Thue-Morse sequence): the moments of the shutter take turns too.
  result = std::min(result, most_truncation_order - tuning::order_step);
  const bool higher = std::popcount(static_cast<unsigned>(pass)) % 2 == 1;
  return higher ? result + tuning::order_step : result;
}

std::array<float, 2> surface_fit_radii(int pass) {
  struct Row {
    int end;
    std::array<float, 2> radii;
  };
  constexpr std::array<Row, 6> rows{{{4, {2.8f, 2.8f}},
                                     {12, {2, 2.8f}},
                                     {32, {1.4f, 2}},
                                     {80, {1, 1.4f}},
                                     {200, {0.7f, 0}},
                                     {600, {0.5f, 0}}}};
  for (const Row& row : rows)
    if (pass < row.end)
      return row.radii;
  return {0.25f, 0};
}

float radius_scale(int pass, double alpha) {
  double squared = 1;
  for (int i = 1; i <= pass; ++i)
    squared *= (i + alpha) / (i + 1);
  return static_cast<float>(std::sqrt(squared));
}

PassSpec schedule(const Choices& choices, const RenderSettings& settings, int pass) {
  const bool gathers = choices.gather.has_value();
  PassSpec spec;
  spec.pass = pass;
  spec.estimator = choices.estimator;
  spec.peak_order = peak_order(choices.peak, pass, gathers);
  spec.kernel_scale = radius_scale(pass, settings.alpha);
  spec.neighbours = choices.photons.neighbours;
  spec.light_paths = choices.photons.paths;
  spec.expected_passes = expected_passes(pass);
  if (choices.fits_surfaces) {
    const auto [narrow, wide] = surface_fit_radii(pass);
    spec.surface_fit_radius = narrow;
    spec.wide_surface_fit_radius = wide;
  }
  if (choices.motion_samples > 0)
    spec.motion_sample =
        static_cast<int>(motion_sample(pass, choices.motion_samples, settings.seed));
  spec.probe_turn = pass;
  if (!gathers)
    return spec;
  if (settings.neighbours == 0)
    spec.neighbours *= tuning::neighbours_of_gather;
  spec.regression_radius = choices.gather->regression_radius(pass);
  spec.gather_walks = choices.gather->walks(pass);
  return spec;
}

std::vector<PassSpec> list_passes(const Choices& choices, const RenderSettings& settings) {
  constexpr int passes_without_limit = 1024;
  const int last = settings.passes.value_or(passes_without_limit) - 1;
  std::set<int> passes{0, last};
  for (std::int64_t power = 1; power < last; power *= 2) {
    const auto pass = static_cast<int>(power);
    passes.insert({pass, std::min(last, pass + 1)}); // truncation takes turns from pass to pass
  }
  std::vector<PassSpec> list;
  for (const int pass : passes)
    list.push_back(schedule(choices, settings, pass));
  return list;
}

} // namespace vdbeam
