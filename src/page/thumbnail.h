#pragma once

#include "vdbeam/image.h"

#include <optional>
#include <string>

namespace vdbeam {

/// Facts about the image of a frame. Numbers are those of the file's attributes; a PNG and
/// images by other programs have none.
struct ThumbnailFacts {
  int width = 0, height = 0;                                ///< of the thumbnail [pixels]
  double brightness = 0;                                    ///< mean luminance, linear
  std::optional<double> error{}, error_low{}, error_high{}; ///< MRSE and its 95 % interval
  std::optional<double> seconds{};                          ///< of rendering
};

/// The image with box filtering at no more than `side` pixels in width and height: every pixel is
/// the mean of the area that it stands for, so means are kept. R, G and B alone, in Rec.709 where
/// the primaries are known. Values that are not finite count as 0.
Image thumbnail_of(const Image& image, int side);

/// Reads the image of a frame and writes its thumbnail, an 8-bit PNG of at most 320 x 320 pixels.
/// `exposure` [stops] and `view` are those of a preview; a PNG is shown as it is. Throws InputError
/// where the image cannot be read and FrameError where the thumbnail cannot be written.
ThumbnailFacts make_thumbnail(const std::string& image, const std::string& thumbnail,
                              double exposure, const std::string& view);

} // namespace vdbeam
