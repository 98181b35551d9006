#include "film/clamp.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

double sum_of(const Rgb& c) {
  return static_cast<double>(c.x) + static_cast<double>(c.y) + static_cast<double>(c.z);
}

} // namespace

ClampTally clamp_pass(PassImage& pass, double limit) {
  ClampTally tally;
  for (std::size_t i = 0; i < pass.direct.size(); ++i) {
    const Rgb medium = pass.direct[i] + pass.indirect[i];
    const double glow = pass.emission.empty() ? 0 : sum_of(pass.emission[i]);
    const double light = sum_of(medium), all = light + sum_of(pass.background[i]) + glow;
    if (!std::isfinite(all))
      continue; // the film counts it as 0 and reports it
    tally.total += all;
    const double largest = static_cast<double>(std::max({medium.x, medium.y, medium.z}));
    if (!(largest > limit))
      continue;
    const double factor = limit / largest;
    pass.direct[i] *= static_cast<float>(factor);
    pass.indirect[i] *= static_cast<float>(factor);
    tally.removed += light * (1 - factor);
    ++tally.pixels;
  }
  return tally;
}

} // namespace vdbeam
