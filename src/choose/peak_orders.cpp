#include "choose/peak_orders.h"

#include "phase/truncated_phase.h"
#include "transport/similar_medium.h"
#include "tuning/constants.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// In thin media the first order is one higher whenever the depth halves, up to this one. There
/// light is scattered but a few times, and the truncation of each scattering shows.
constexpr int most_order_for_thinness = 8;

/// The lowest order that removes at most this fraction of the scattering of any phase function.
int lowest_order(const Medium& medium, float largest_peak) {
  int lowest = least_truncation_order;
  while (lowest < most_truncation_order &&
         std::any_of(medium.phases.begin(), medium.phases.end(), [&](const PhaseFunction& phase) {
           return truncate_peak(phase, lowest).forward > largest_peak;
         }))
    ++lowest;
  return lowest;
}

/// Some phase function has a peak worth taking out.
bool has_peak(const Medium& medium) {
  for (int order = least_truncation_order; order <= most_truncation_order; ++order)
    for (const PhaseFunction& phase : medium.phases)
      if (truncate_peak(phase, order).forward > 0)
        return true;
  return false;
}

/// The order of the first passes that gather along rays.
double first_order(const Medium& medium) {
  const int lowest = lowest_order(medium, tuning::largest_first_peak);
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
  const double more = std::log2(tuning::depth_of_lowest_order / typical_depth(*similar));
  return std::clamp<double>(lowest + more, lowest, highest);
}

} // namespace

PeakOrders choose_peak_orders(const Medium& medium) {
  if (!has_peak(medium))
    return {};
  const double along_rays = first_order(medium);
  return {true, along_rays,
          std::max<double>(along_rays, lowest_order(medium, tuning::largest_peak_of_gather))};
}

} // namespace vdbeam
