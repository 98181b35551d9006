#pragma once

#include "image/pass_image.h"
#include "vdbeam/pixel_region.h"

namespace vdbeam {

/// Whether all of a pass's tiles that meet the window are finished.
bool is_finished(const PassImage& pass, const PixelRegion& window);

/// The part of a pass that lies in the window.
PassImage cut_out(const PassImage& pass, const PixelRegion& window);

} // namespace vdbeam
