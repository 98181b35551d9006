#pragma once

#include "math/rng.h"
#include "transport/depth_profile.h"

namespace vdbeam {

/// Radiance that the medium's own light on a segment brings to the start of its ray: the integral
/// of Tr j dt over it, each channel with its own transmittance from `profile`, which
/// belongs to the ray and may be empty. Without noise: exact for the trilinear fields where nothing
/// absorbs, else to a relative error of 2e-5 (docs/physics.md). What lies behind more than
/// -ln(cutoff) optical depths is left out.
Rgb emission_along(const Medium& medium, const Segment& segment, const DepthProfile& profile,
                   float cutoff);

/// An unbiased estimate of the integral of j dt over a segment, without transmittance, from
/// a few places in each 8^3 cell: what a path gathers on a flight that ends in a collision at its
/// end (track-length estimator; the flight's own ending stands for the transmittance).
Rgb sample_emission(const Medium& medium, const Segment& segment, Rng& rng);

} // namespace vdbeam
