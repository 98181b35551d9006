#pragma once

#include "math/rng.h"
#include "medium/depth_profile.h"

namespace vdbeam {

/// Radiance at the start of a ray due to the medium's emission on a segment: the integral of Tr j
/// dt over it, each channel with its own transmittance from `profile`, which belongs to the ray and
/// may be empty; the air of the profile dims it. Deterministic: exact for trilinear fields where
/// nothing absorbs, otherwise with a relative error of 2e-5 (docs/theory/transport.md). Emission
/// behind an optical depth of more than -ln(cutoff) is left out. `of_emitters`, unless it is null,
/// gets the part of each.
Rgb emission_along(const Medium& medium, const Segment& segment, const DepthProfile& profile,
                   float cutoff, std::vector<Rgb>* of_emitters = nullptr);

/// An unbiased estimate of the integral of j dt over a segment, without transmittance, from a few
/// points in each 8^3 cell: what a path adds on a flight that ends in a collision at its end
/// (track-length estimator; the distribution of the flight's length gives the transmittance).
Rgb sample_emission(const Medium& medium, const Segment& segment, Rng& rng);

} // namespace vdbeam
