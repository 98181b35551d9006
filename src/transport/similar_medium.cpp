#include "transport/similar_medium.h"

#include "math/sampling.h"
#include "medium/optical_depth.h"
#include "phase/truncated_phase.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vdbeam {

namespace {

/// How truncation shrinks from pass to pass.
struct OrderGrowth {
  int passes_of_first_order;
  int factor; ///< the order grows by one when the number of passes has grown by this factor
};
/// Measured on backlit and on Mie clouds (docs/decisions.md): the bias of order 4 along rays is
/// under the noise of 64 passes; of walks one order more halves the squared bias, so that it falls
/// as fast as the noise.
constexpr OrderGrowth growth_along_rays{64, 3}, growth_of_walks{16, 2};

/// The first order takes no larger share than this for a peak. With more, light that is scattered
/// twice by small angles, towards which one looks at a sun through the medium, is too dark.
constexpr float largest_first_peak = 0.6f;
/// The same of passes that gather photons by walks (docs/decisions.md).
constexpr float largest_peak_of_walks = 0.55f;

/// The order of one pass of two is so much higher. A greater step would tell the bias of
/// truncation with less noise, and cost more noise of the picture.
constexpr int order_step = 2;

/// In media of this typical depth without the peak or more, the first order is the lowest; in
/// thinner ones it is one higher whenever the depth halves, up to 8. There light is scattered but a
/// few times, and the truncation of each scattering shows (docs/decisions.md).
constexpr double depth_of_lowest_order = 24;
constexpr int most_order_for_thinness = 8;

/// The volume with the share `f` of its scattering taken for no scattering; adds to `peak` what
/// leads back.
Volume similar_volume(const Volume& volume, float f, PeakTakenOut& peak) {
  Volume similar = volume;
  const Rgb scale = volume.channel_scale * (Rgb(1) - volume.albedo * f);
  const float strongest = max_component(scale);
  similar.extinction = volume.extinction * strongest;
  similar.channel_scale = scale / strongest;
  for (int c = 0; c < 3; ++c)
    similar.albedo[c] = volume.albedo[c] * (1 - f) / (1 - volume.albedo[c] * f);
  peak.extinction_factor.push_back(1 / strongest);
  peak.excess.push_back(volume.channel_scale / strongest - similar.channel_scale);
  return similar;
}

/// The lowest order that takes no larger share than this of any phase function for a peak.
int lowest_order(const Medium& medium, float largest_peak) {
  int lowest = least_truncation_order;
  while (lowest < most_truncation_order &&
         std::any_of(medium.phases.begin(), medium.phases.end(), [&](const PhaseFunction& phase) {
           return truncate_peak(phase, lowest).forward > largest_peak;
         }))
    ++lowest;
  return lowest;
}

/// The order of the first passes; what is beyond a whole number is the share of passes of one more.
double first_order(const Medium& medium) {
  const int lowest = lowest_order(medium, largest_first_peak);
  int highest = most_order_for_thinness;
  // Not so high that there is no peak to take out.
  while (highest > lowest &&
         std::all_of(medium.phases.begin(), medium.phases.end(), [&](const PhaseFunction& phase) {
           return truncate_peak(phase, highest).forward == 0;
         }))
    --highest;
  const auto similar = highest > lowest ? similar_medium(medium, lowest) : nullptr;
  if (!similar)
    return lowest;
  const double more = std::log2(depth_of_lowest_order / typical_depth(*similar));
  return std::clamp<double>(lowest + more, lowest, highest);
}

} // namespace

std::shared_ptr<const Medium> similar_medium(const Medium& medium, int order) {
  auto peak = std::make_shared<PeakTakenOut>();
  peak->order = order;
  auto similar = std::make_shared<Medium>(medium);
  bool any = false;
  for (PhaseFunction& phase : similar->phases) {
    TruncatedPhase truncated = truncate_peak(phase, order);
    any = any || truncated.forward > 0;
    peak->original.push_back(phase);
    peak->forward.push_back(truncated.forward);
    peak->aureoles.push_back(truncated.forward > 0 ? Aureole(phase, truncated, order) : Aureole());
    peak->gathered.push_back(truncated.gathered);
    phase = truncated.traced;
  }
  if (!any)
    return nullptr;
  for (Volume& volume : similar->volumes) {
    volume =
        similar_volume(volume, peak->forward[static_cast<std::size_t>(volume.phase_index)], *peak);
    const Rgb& scale = volume.channel_scale;
    similar->chromatic = similar->chromatic || scale.x != scale.y || scale.y != scale.z;
  }
  similar->peak = std::move(peak);
  return similar;
}

float truncation(const Medium& medium) {
  float most = 0;
  for (std::size_t i = 0; medium.peak && i < medium.peak->original.size(); ++i) {
    if (!(medium.peak->forward[i] > 0))
      continue;
    const auto order = static_cast<std::size_t>(medium.peak->order);
    const std::vector<double> moments =
        legendre_moments(medium.peak->original[i], medium.peak->order + 3);
    const double widened = std::max(0.0, moments[order] - moments[order + 2]);
    most = std::max(most, static_cast<float>(widened * widened));
  }
  return most;
}

double typical_depth(const Medium& medium) {
  constexpr std::uint64_t lines = 512;
  if (medium.empty())
    return 0;
  const Vec3f centre = medium.bounds.center();
  const float radius = length(medium.bounds.upper - centre);
  double sum = 0, squares = 0;
  for (std::uint64_t line = 0; line < lines; ++line) {
    Rng rng({}, RngStage::line, line);
    const float u = rng.uniform(), v = rng.uniform();
    const Vec3f direction = sample_sphere(u, v);
    Vec3f across, up;
    orthonormal_frame(direction, across, up);
    const float r = radius * std::sqrt(rng.uniform()), phi = 2 * pi * rng.uniform();
    const Vec3f origin =
        centre + across * (r * std::cos(phi)) + up * (r * std::sin(phi)) - direction * radius;
    const double through =
        max_component(exact_transmittance(medium, {{origin, direction}, 0, 2 * radius}));
    const double depth =
        std::min<double>(opaque_optical_depth, -std::log(std::max(1e-30, through)));
    sum += depth;
    squares += depth * depth;
  }
  return sum > 0 ? squares / sum : 0;
}

PassWorlds::PassWorlds(const World& world, bool take_out)
    : world_(world), take_out_(take_out),
      first_order_(take_out ? first_order(world.medium) : least_truncation_order),
      first_order_of_walks_(std::max<double>(
          first_order_,
          take_out ? lowest_order(world.medium, largest_peak_of_walks) : least_truncation_order)) {}

int PassWorlds::order(int pass, bool walks) const {
  // Multiples of the golden ratio spread the pairs of passes of one more evenly.
  const double spread = std::fmod(0.5 + 0.61803398875 * (pass / 2), 1.0);
  int result = static_cast<int>((walks ? first_order_of_walks_ : first_order_) + spread);
  const OrderGrowth growth = walks ? growth_of_walks : growth_along_rays;
  for (std::int64_t until = growth.passes_of_first_order; pass >= until; until *= growth.factor)
    ++result;
  // The lower of the two leaves room for the higher. One pass of each pair has the higher, the
  // first as often as the second (Thue-Morse sequence): the moments of the shutter take turns too.
  result = std::min(result, most_truncation_order - order_step);
  const bool higher = std::popcount(static_cast<unsigned>(pass)) % 2 == 1;
  return higher ? result + order_step : result;
}

const World& PassWorlds::of(int pass, bool walks) {
  if (!take_out_)
    return world_;
  const auto [at, is_new] = similar_.try_emplace(order(pass, walks));
  if (is_new)
    if (const auto medium = similar_medium(world_.medium, at->first)) {
      at->second = std::make_unique<World>(world_);
      at->second->medium = *medium;
    }
  return at->second ? *at->second : world_;
}

} // namespace vdbeam
