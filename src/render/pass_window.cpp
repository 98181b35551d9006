#include "render/pass_window.h"

#include <algorithm>

namespace vdbeam {

bool is_finished(const PassImage& pass, const PixelRegion& window) {
  if (pass.finished_tiles.empty())
    return false;
  constexpr int tile = PassImage::tile_width;
  for (int y = window.y0 / tile * tile; y < window.y1; y += tile)
    for (int x = window.x0 / tile * tile; x < window.x1; x += tile)
      if (!pass.finished_tiles[pass.tile_of(x, y)])
        return false;
  return true;
}

PassImage cut_out(const PassImage& pass, const PixelRegion& window) {
  PassImage part;
  part.resize(window.width(), window.height(), !pass.emission.empty());
  part.coverage.assign(pass.coverage.size(), std::vector<float>(part.direct.size()));
  part.planes.assign(pass.planes.size(), std::vector<float>(part.direct.size()));
  part.groups.assign(pass.groups.size(), std::vector<Rgb>(part.direct.size()));
  for (int y = 0; y < window.height(); ++y) {
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(window.y0 + y) * pass.width + window.x0;
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(y) * part.width;
    const auto copy = [&](const auto& source, auto& target) {
      std::copy_n(source.begin() + from, part.width, target.begin() + to);
    };
    copy(pass.direct, part.direct);
    copy(pass.indirect, part.indirect);
    copy(pass.background, part.background);
    if (!pass.emission.empty())
      copy(pass.emission, part.emission);
    for (std::size_t g = 0; g < pass.groups.size(); ++g)
      copy(pass.groups[g], part.groups[g]);
    for (std::size_t i = 0; i < pass.coverage.size(); ++i)
      copy(pass.coverage[i], part.coverage[i]);
    for (std::size_t i = 0; i < pass.planes.size(); ++i)
      copy(pass.planes[i], part.planes[i]);
    copy(pass.opacity, part.opacity);
    copy(pass.depth, part.depth);
  }
  part.deep = pass.deep; // no pixel beyond the window has any pieces
  for (const PixelValue& value : pass.blur) {
    const int x = static_cast<int>(value.pixel % pass.width) - window.x0;
    const int y = static_cast<int>(value.pixel / pass.width) - window.y0;
    if (x >= 0 && x < part.width && y >= 0 && y < part.height)
      part.blur.push_back({static_cast<std::size_t>(y) * part.width + x, value.radiance});
  }
  return part;
}

} // namespace vdbeam
