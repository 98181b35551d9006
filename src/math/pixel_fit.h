#pragma once

namespace vdbeam {

// Planes fitted to pixels (PlaneFit) within a radius [pixels]: 0 fits nothing, 1 takes the 8 pixels
// around.

/// By how many pixels the fit reaches to each side.
int fit_reach(float radius);

/// Weight in the fit of a pixel at this offset.
float fit_weight(float dx, float dy, float radius);

/// Growth of the squared bias with the radius, as measured on clouds: m^2 / sqrt(1 + m^2), m
/// [pixels^2] being the mean square distance of what is shared. It is m^2 for narrow radii, as for
/// any light that is smooth, but m for wide ones, since light is rough at the scale of pixels.
double fit_blur(float radius);

/// The radius of a narrow fit, which shows how much one of this radius blurs: half of it, so that
/// both have much of their noise in common; 0, the pixel's own light, where half would change
/// little.
inline float narrower_fit(float radius) {
  return radius <= 1 ? 0 : radius / 2;
}

/// All that the fit blurs over what it blurs beyond the narrow one; 0 where nothing is fitted.
float blur_over_difference(float radius);

} // namespace vdbeam
