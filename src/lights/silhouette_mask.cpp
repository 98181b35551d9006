#include "lights/silhouette_mask.h"

#include "math/sampling.h"

#include <bit>

namespace vdbeam {
namespace {

constexpr double largest_raster = 512; // pixels along the longer side
constexpr double pixel_budget = 4e6;   // pixels touched by all cells together

struct Vec2 {
  double x = 0, y = 0;
};
double dot(const Vec2& a, const Vec2& b) {
  return a.x * b.x + a.y * b.y;
}

// The shadow of a parallelepiped: a zonogon (sum of three segments), and its range of depths.
struct Shadow {
  Vec2 center;
  std::array<Vec2, 3> edges;
  double margin = 0; // all around, for lines that deviate
  double depth = 0;  // nearest
  Vec2 half;         // of the bounding box, margin included

  // Half the width of the shadow along n, times |n|.
  double reach(const Vec2& n) const {
    double sum = 0;
    for (const Vec2& e : edges)
      sum += std::abs(dot(e, n));
    return sum / 2 + margin * std::sqrt(dot(n, n));
  }
};

struct Frame {
  Vec3d origin, x, y, axis;

  Shadow shadow(const Parallelepiped& box, double tan_spread, double slack) const {
    Shadow s;
    Vec3d center = Vec3d(box.corner) - origin;
    double half_depth = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3d e(box.edges[i]);
      center += e * 0.5;
      half_depth += std::abs(vdbeam::dot(e, axis)) / 2;
      s.edges[i] = {vdbeam::dot(e, x), vdbeam::dot(e, y)};
    }
    const double depth = vdbeam::dot(center, axis);
    s.center = {vdbeam::dot(center, x), vdbeam::dot(center, y)};
    s.margin = slack + tan_spread * (std::abs(depth) + half_depth);
    s.depth = depth - half_depth - slack;
    s.half = {s.reach({1, 0}), s.reach({0, 1})};
    return s;
  }
};

// A raster of the nearest depth per pixel, infinite where nothing is.
class Raster {
public:
  Raster(const Vec2& lower, const Vec2& upper, double pixel)
      : lower_(lower), pixel_(pixel), width_(count(upper.x - lower.x)),
        height_(count(upper.y - lower.y)),
        depth_(static_cast<std::size_t>(width_) * height_, infinity) {}

  int width() const { return width_; }
  int height() const { return height_; }
  float depth(int x, int y) const { return depth_[static_cast<std::size_t>(y) * width_ + x]; }

  // Every pixel that the shadow touches. Two convex shapes are apart exactly where the normal of an
  // edge of one of them separates them; each normal bounds the centres of a row's touched pixels.
  void draw(const Shadow& shadow) {
    const double half = pixel_ / 2;
    const int first = index(shadow.center.y - shadow.half.y - lower_.y, height_);
    const int last = index(shadow.center.y + shadow.half.y - lower_.y, height_);
    for (int row = first; row <= last; ++row) {
      const double y = lower_.y + (row + 0.5) * pixel_ - shadow.center.y;
      double begin = -shadow.half.x - half, end = shadow.half.x + half;
      for (const Vec2& e : shadow.edges) {
        const Vec2 n = e.y > 0 ? Vec2{e.y, -e.x} : Vec2{-e.y, e.x}; // n.x >= 0
        const double reach = shadow.reach(n) + half * (std::abs(n.x) + std::abs(n.y));
        if (n.x > 0) {
          begin = std::max(begin, (-reach - n.y * y) / n.x);
          end = std::min(end, (reach - n.y * y) / n.x);
        } else if (std::abs(n.y * y) > reach) {
          end = begin - 1;
        }
      }
      if (begin <= end)
        fill(row, begin + shadow.center.x - lower_.x, end + shadow.center.x - lower_.x,
             static_cast<float>(shadow.depth));
    }
  }

private:
  int count(double extent) const {
    return std::max(1, static_cast<int>(std::ceil(extent / pixel_)));
  }
  int index(double offset, int limit) const {
    return static_cast<int>(std::clamp(std::floor(offset / pixel_), 0.0, limit - 1.0));
  }
  // The pixels whose centres lie in [begin, end].
  void fill(int row, double begin, double end, float depth) {
    float* line = depth_.data() + static_cast<std::size_t>(row) * width_;
    const int first =
        static_cast<int>(std::clamp(std::ceil(begin / pixel_ - 0.5), 0.0, 1.0 * width_));
    const int last =
        static_cast<int>(std::clamp(std::floor(end / pixel_ - 0.5), -1.0, width_ - 1.0));
    for (int i = first; i <= last; ++i)
      line[i] = std::min(line[i], depth);
  }

  Vec2 lower_;
  double pixel_;
  int width_, height_;
  std::vector<float> depth_;
};

/// Every second bit of a number, from the lowest on.
int even_bits(std::uint32_t v) {
  v &= 0x55555555u;
  v = (v | v >> 1) & 0x33333333u;
  v = (v | v >> 2) & 0x0f0f0f0fu;
  v = (v | v >> 4) & 0x00ff00ffu;
  return static_cast<int>((v | v >> 8) & 0x0000ffffu);
}

} // namespace

SilhouetteMask::SilhouetteMask(const Vec3f& axis, float tan_spread, const OccupiedRegion& region) {
  const std::vector<Parallelepiped>& cells = region.cells.empty() ? region.boxes : region.cells;
  if (cells.empty())
    return;
  Frame frame{Vec3d(region.center), {}, {}, normalize(Vec3d(axis))};
  orthonormal_frame(frame.axis, frame.x, frame.y);
  const double slack = 1e-6 * (static_cast<double>(region.radius) + length(frame.origin));
  std::vector<Shadow> shadows;
  shadows.reserve(cells.size());
  Vec2 lower{1e300, 1e300}, upper{-1e300, -1e300};
  double work = 0; // summed area of all shadows' bounding boxes
  for (const Parallelepiped& cell : cells) {
    const Shadow& s = shadows.emplace_back(frame.shadow(cell, tan_spread, slack));
    lower = {std::min(lower.x, s.center.x - s.half.x), std::min(lower.y, s.center.y - s.half.y)};
    upper = {std::max(upper.x, s.center.x + s.half.x), std::max(upper.y, s.center.y + s.half.y)};
    work += 4 * s.half.x * s.half.y;
  }
  const double extent = std::max(upper.x - lower.x, upper.y - lower.y);
  const double pixel = std::max(extent / largest_raster, std::sqrt(work / pixel_budget));
  if (!(pixel > 0))
    return;
  Raster raster(lower, upper, pixel);
  for (const Shadow& s : shadows)
    raster.draw(s);
  // Along a Morton curve, so that a run of pixels is compact.
  const auto side =
      std::bit_ceil(static_cast<std::uint32_t>(std::max(raster.width(), raster.height())));
  for (std::uint32_t code = 0; code < side * side; ++code) {
    const int x = even_bits(code), y = even_bits(code >> 1);
    if (x < raster.width() && y < raster.height() && raster.depth(x, y) < infinity)
      pixels_.push_back(
          {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), raster.depth(x, y)});
  }
  corner_ = frame.origin + frame.x * lower.x + frame.y * lower.y;
  step_x_ = frame.x * pixel;
  step_y_ = frame.y * pixel;
  area_ = static_cast<float>(static_cast<double>(pixels_.size()) * pixel * pixel);
}

SilhouetteMask::Point SilhouetteMask::sample(std::uint32_t pixel, float u, float v) const {
  const Pixel& p = pixels_[(static_cast<std::uint64_t>(pixel) * pixels_.size()) >> 32];
  const double x = p.x + static_cast<double>(u), y = p.y + static_cast<double>(v);
  return {Vec3f(corner_ + step_x_ * x + step_y_ * y), p.depth};
}

} // namespace vdbeam
