#pragma once

#include "math/rng.h"
#include "transport/depth_profile.h"

namespace vdbeam {

/// Radiance that the medium's own light brings to the start of a camera ray, between t_begin and
/// t_end: the integral of Tr j dt, each channel with its own transmittance from `profile`, which
/// belongs to the ray and may be empty. Without noise: exact for the trilinear fields where nothing
/// absorbs, else to a relative error of 2e-5 (docs/physics.md). What lies behind more than
/// -ln(cutoff) optical depths is left out.
Rgb emission_along(const Medium& medium, const Ray& ray, const DepthProfile& profile, float t_begin,
                   float t_end, float cutoff);

/// An unbiased estimate of the integral of j dt over [t_begin, t_end], without transmittance, from
/// a few places in each 8^3 cell: what a path gathers on a flight that ends in a collision at t_end
/// (track-length estimator; the flight's own ending stands for the transmittance).
Rgb sample_emission(const Medium& medium, const Ray& ray, float t_begin, float t_end, Rng& rng);

} // namespace vdbeam
