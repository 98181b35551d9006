#pragma once

#include "vdbeam/image.h"

#include <vector>

namespace vdbeam {

/// The LDR-FLIP difference of two images, per pixel, in [0, 1]: Andersson, Nilsson, Akenine-Moller,
/// Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proceedings
/// of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020.
///
/// Linear R, G, B are clamped to [0, 1] (what an sRGB display at exposure 0 shows; the paper
/// decodes sRGB first, which undoes the encoding); NaN is black. `pixels_per_degree` is of visual
/// angle: 67 is a 0.7 m wide 3840-pixel monitor seen from 0.7 m, the paper's default. Both images
/// have R, G, B and the same size.
std::vector<float> flip_map(const Image& image, const Image& reference,
                            double pixels_per_degree = 67);

/// The mean of flip_map.
double mean_flip(const Image& image, const Image& reference, double pixels_per_degree = 67);

} // namespace vdbeam
