#pragma once

#include "medium/medium.h"

namespace vdbeam {

/// By which truncation of phase functions the forward peak is taken out of a medium
/// (similar_medium), for the first passes.
struct PeakOrders {
  bool taken_out = false;
  /// Of passes that gather along rays, and of passes that gather finally, whose kernels blur so
  /// little that truncation would be most of the bias. What is beyond a whole number is the share
  /// of passes of one order more.
  double along_rays = 0, of_gather = 0;
};

/// At first one that leaves enough of each phase function, higher where the medium is thin.
PeakOrders choose_peak_orders(const Medium& medium);

} // namespace vdbeam
