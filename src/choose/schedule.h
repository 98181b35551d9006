#pragma once

#include "choose/choices.h"
#include "vdbeam/pass_spec.h"
#include "vdbeam/render.h"

#include <array>

namespace vdbeam {

/// The specification of pass `pass` (from 0) of a frame. A pure function.
PassSpec schedule(const Choices& choices, const RenderSettings& settings, int pass);

/// The specifications of those passes at which something may change, up to the last that is asked
/// for.
std::vector<PassSpec> list_passes(const Choices& choices, const RenderSettings& settings);

/// The motion sample that a pass renders, of `samples`: in an order that spreads any number of
/// passes over the shutter's time (van der Corput's sequence, shifted by the seed).
std::size_t motion_sample(int pass, std::size_t samples, std::uint64_t seed);

/// The truncation order of a pass; 0 where no peak is taken out. It grows by one whenever the
/// number of passes has tripled, or doubled for final gathering, so that the estimate
/// stays consistent (docs/theory/beam.md, "Forward peaks"). One pass of two takes less out, so that
/// the difference shows the bias that is left.
int peak_order(const PeakOrders& first, int pass, bool gathers);

/// Passes of the render for which a pass balances noise and bias: twice those until its end, since
/// nobody knows the number in advance.
constexpr int expected_passes(int pass) {
  return 2 * (pass + 1);
}

/// Radii of a pass's fits over the pixels of a surface: the narrow one in pixels, the wide one in
/// steps of three of them; 0: none. They shrink, so that the bias vanishes as the noise does.
std::array<float, 2> surface_fit_radii(int pass);

/// Radius factor of a pass: r_p^2 = r_0^2 prod (i + alpha) / (i + 1) (Knaus and Zwicker 2011).
float radius_scale(int pass, double alpha);

} // namespace vdbeam
