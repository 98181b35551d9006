#pragma once

#include "math/stop_token.h"

#include <cstdint>

namespace vdbeam {

/// Limits of making a field.
struct FieldLimits {
  FieldLimits(std::uint64_t maximum_bytes, const StopToken* stop_token = nullptr)
      : bytes(maximum_bytes), stop(stop_token) {}

  /// Throws Stopped where the work should end; asked once for each brick or so.
  void check() const {
    if (stop)
      stop->check();
  }

  std::uint64_t bytes;
  const StopToken* stop; ///< or null
};

} // namespace vdbeam
