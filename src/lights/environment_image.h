#pragma once

#include "lights/light_table.h"
#include "vdbeam/image.h"

#include <array>

namespace vdbeam {

/// A light-probe image all around, in latitude and longitude as OpenEXR lays it out (ImfEnvmap.h):
/// the top row is `up`; for up = +y the middle column is +z and a quarter from the left is +x. For
/// any other `up` the whole is turned by the smallest rotation that takes +y there. `rotation` then
/// turns it about `up`, counter-clockwise seen from above. Radiance is interpolated bilinearly.
///
/// `name` is for messages. Throws InputError where the image has neither R, G, B nor Y.
std::unique_ptr<Light> make_environment_image(const Image& image, const std::string& name,
                                              const LightSettings& settings,
                                              const LightContext& context);

/// The axes of such an image, as directions in render space: where the turn is 0, where it is a
/// quarter, and up. `rotation` in degrees.
std::array<Vec3d, 3> environment_axes(const Vec3d& up, double rotation);

} // namespace vdbeam
