#pragma once

namespace vdbeam {

/// One minus the cosine of a scattering angle drawn from Draine's phase function, by inversion of
/// its distribution; `u` in [0, 1) grows with the angle for g >= 0 and falls with it for g < 0.
/// Small angles keep their full relative precision. alpha = 0 is Henyey-Greenstein.
float sample_draine_one_minus_cos(float g, float alpha, float u);

} // namespace vdbeam
