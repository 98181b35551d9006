#pragma once

#include "film/film.h"
#include "image/pass_image.h"
#include "vdbeam/pixel_region.h"
#include "vdbeam/scene.h"

#include <functional>

namespace vdbeam {

/// Develops a picture that has one image and no film, by films of a few rows: a whole film
/// would take its memory for nothing, which at 4K takes longer than a draft.
/// `image_of` gives the image of a part of the picture, of that part's size; it is called by
/// several threads at a time. `film_of` gives a film without deep samples, of a width and a height.
/// Adds the number of values that were not finite to `invalid_values`.
Image develop_bands(const PixelRegion& window,
                    const std::function<PassImage(const PixelRegion&)>& image_of,
                    const std::function<Film(int, int)>& film_of,
                    const std::vector<LayerSettings>& layers, std::uint64_t& invalid_values);

} // namespace vdbeam
