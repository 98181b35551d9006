#pragma once

#include "vdbeam/image.h"

namespace vdbeam {

/// Converts the R, G and B of every layer to other primaries; variance, which no matrix converts,
/// stays as it is. A picture that has them already is left alone.
void convert_colors(Image& image, const Chromaticities& primaries);

/// Converts the colours of every layer of a scene-linear picture to the colour space of this name:
/// rec709, rec2020, acescg or aces2065_1, or one of the OpenColorIO configuration that the
/// environment variable OCIO names. That finds its way by the configuration's role
/// aces_interchange; the file then has no chromaticities of its own, but the attribute
/// vdbeam:colorSpace. Throws InputError for a name that there is not.
void convert_to_output_space(Image& image, const std::string& name);

/// What is wrong with the name of a colour space, or nothing.
std::string why_no_output_space(const std::string& name);

} // namespace vdbeam
