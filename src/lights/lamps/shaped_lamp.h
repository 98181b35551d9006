#pragma once

#include "lights/light.h"
#include "lights/light_context.h"

#include <memory>

namespace vdbeam {

/// It is a point or spot light with a photometric profile or an image.
bool is_shaped(const LightSettings& settings);

/// A point or spot light whose intensity is the product of a spot's cone, a photometric profile and
/// an image, where it has these. Photons are drawn in proportion to it. Throws InputError for
/// files that cannot be used.
///
/// Seen from behind the lamp, along its direction, the camera's `up` is up, or +z where the two are
/// parallel, and `rotation` turns counter-clockwise. The image covers the cone's circle as a
/// slide that is projected: its shorter side is as long as the circle is wide. The profile's plane
/// C0 is to the right, C90 above.
std::unique_ptr<Light> make_shaped_lamp(const LightSettings& settings, const LightContext& context);

} // namespace vdbeam
