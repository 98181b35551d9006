#pragma once

#include "medium/medium.h"

namespace vdbeam {

/// Orders of the delta-M truncation of a medium's phase functions (similar_medium) in the first
/// passes.
struct PeakOrders {
  bool taken_out = false;
  /// For passes that gather along rays, and for passes of final gathering, whose kernels blur so
  /// little that truncation would be most of the bias. What is beyond a whole number is the share
  /// of passes of one order more.
  double along_rays = 0, of_gather = 0;
};

/// None where no phase function has a peak. At first one that leaves enough of each phase function,
/// higher where the medium is thin.
PeakOrders choose_peak_orders(const Medium& medium);

} // namespace vdbeam
