#pragma once

#include "medium/bounded_tracking.h"
#include "tuning/constants.h"

namespace vdbeam {

/// Optical depth beyond which a ray counts as opaque: exp(-25) = 1.4e-11 of the light is ignored.
inline constexpr float opaque_optical_depth = 25;

/// Traverses the lattice cubes of one brick along a ray and integrates the density exactly: along a
/// line a trilinear function is a cubic, which two-point Gauss-Legendre integrates without error.
/// The stepping has no branches, because which plane comes next is practically random.
class BrickWalk {
public:
  /// o + t d runs in brick coordinates, from t_begin to t_end inside the brick.
  BrickWalk(const float* brick, const Vec3f& o, const Vec3f& d, float t_begin, float t_end)
      : d_(d), t_(t_begin), t_end_(t_end), p_(brick) {
    constexpr int strides[3] = {brick_width * brick_width, brick_width, 1};
    for (int a = 0; a < 3; ++a) {
      const int last = cell_width - 1;
      const int cell = std::clamp(static_cast<int>(o[a] + t_begin * d[a]), 0, last);
      const bool up = d[a] > 0;
      p_ += cell * strides[a];
      stride_[a] = up ? strides[a] : -strides[a];
      sign_[a] = up ? 1.0f : -1.0f;
      left_[a] = up ? last - cell : cell;
      o_[a] = o[a] - static_cast<float>(cell);
      const float inverse = d[a] != 0 ? 1 / d[a] : 0;
      delta_[a] = std::abs(inverse);
      next_[a] = left_[a] > 0 && d[a] != 0 ? ((up ? 1.0f : 0.0f) - o_[a]) * inverse : infinity;
    }
  }

  float t() const { return t_; }
  bool done() const { return t_ >= t_end_; }

  /// Integrates to the next lattice plane, moves there, and returns the integral.
  float advance() {
    const float t_b =
        std::max(t_, std::min(std::min(next_[0], next_[1]), std::min(next_[2], t_end_)));
    const float sum = integrate(t_b);
    for (int a = 0; a < 3; ++a) {
      const int crossed = next_[a] <= t_b;
      p_ += crossed ? stride_[a] : 0;
      o_[a] -= crossed ? sign_[a] : 0.0f;
      left_[a] -= crossed;
      const float after = left_[a] > 0 ? next_[a] + delta_[a] : infinity;
      next_[a] = crossed ? after : next_[a];
    }
    t_ = t_b;
    return sum;
  }

private:
  float integrate(float t_b) const {
    constexpr int width = brick_width;
    const float* p = p_;
    const float* q = p + width * width;
    const float middle = 0.5f * (t_ + t_b), half = 0.5f * (t_b - t_);
    // In the cube, density = (a0 + a1 z) and so on: differences once, two points with them.
    const float c00 = p[0], z00 = p[1] - p[0], c01 = p[width], z01 = p[width + 1] - p[width];
    const float c10 = q[0], z10 = q[1] - q[0], c11 = q[width], z11 = q[width + 1] - q[width];
    const float offset = half * 0.57735027f;
    const float x = o_[0] + d_.x * middle, y = o_[1] + d_.y * middle, z = o_[2] + d_.z * middle;
    float sum = 0;
    for (const float shift : {-offset, offset}) {
      const float fx = x + d_.x * shift, fy = y + d_.y * shift, fz = z + d_.z * shift;
      const float b00 = c00 + fz * z00, b01 = c01 + fz * z01;
      const float b10 = c10 + fz * z10, b11 = c11 + fz * z11;
      const float b0 = b00 + fy * (b01 - b00), b1 = b10 + fy * (b11 - b10);
      sum += b0 + fx * (b1 - b0);
    }
    return std::max(0.0f, half * sum);
  }

  Vec3f d_;
  float t_, t_end_;
  const float* p_; ///< the present cube's lower corner
  float o_[3];     ///< origin relative to that corner
  float next_[3];  ///< where the next plane of each axis is crossed
  float delta_[3]; ///< between planes
  float sign_[3];
  int stride_[3];
  int left_[3]; ///< cubes to go before the brick ends, per axis
};

/// Exact optical depth, for the strongest channel, of a piece of the ray that lies inside the
/// volume and crosses none of its lattice planes.
inline float cube_optical_depth(const Volume& volume, const Ray& ray, float t_a, float t_b) {
  const float middle = 0.5f * (t_a + t_b), half = 0.5f * (t_b - t_a), offset = half * 0.57735027f;
  return volume.extinction * half *
         (volume.density_inside(ray.at(middle - offset)) +
          volume.density_inside(ray.at(middle + offset)));
}

/// The part of a ray in a volume whose density changes along local y alone.
class LayeredSegment {
public:
  LayeredSegment(const Volume& volume, const Segment& segment);

  bool empty() const { return !(t_begin_ < t_end_); }
  /// Optical depth for the strongest channel, in closed form.
  float optical_depth() const;
  /// The same as for_each_piece, with one piece for each layer.
  template <class Visit>
  void for_each_piece(const Visit& visit) const {
    const bool up = slope_ > 0;
    std::size_t layer = layers_.layer_at(height(t_begin_));
    for (float t = t_begin_; t < t_end_; up ? ++layer : --layer) {
      const bool is_last = up ? layer + 1 == layers_.count() : layer == 0;
      const float plane = up ? layers_.upper(layer) : layers_.lower(layer);
      const auto next = static_cast<float>((plane - origin_) / slope_);
      const float t_b = is_last || slope_ == 0 ? t_end_ : std::clamp(next, t, t_end_);
      if (t_b > t && !layers_.is_empty(layer) && !visit(t, t_b, depth_of(layer, t, t_b)))
        return;
      t = t_b;
    }
  }

private:
  /// Local height, kept inside the field, which rounding may leave.
  double height(float t) const { return std::clamp(origin_ + slope_ * t, 0.0, double{top_}); }
  float depth_of(std::size_t layer, float t_a, float t_b) const {
    const double sum = layers_.density(layer, height(t_a)) + layers_.density(layer, height(t_b));
    return extinction_ * static_cast<float>(0.5 * std::max(sum, 0.0)) * (t_b - t_a);
  }

  const DensityLayers& layers_;
  float extinction_, top_;
  double origin_, slope_; ///< of the local height, as a function of t
  float t_begin_ = 0, t_end_ = 0;
};

/// Calls visit(t_a, t_b, tau) for consecutive pieces of the segment inside `volume`, tau being the
/// exact optical depth of the piece for the strongest channel; empty stretches are skipped. Ends
/// when visit returns false.
template <class Visit>
void for_each_piece(const Volume& volume, const Segment& segment, const Visit& visit) {
  if (volume.field.layers())
    return LayeredSegment(volume, segment).for_each_piece(visit);
  const Vec3f o = volume.local_point(segment.ray.origin);
  const Vec3f d = volume.local_vector(segment.ray.direction);
  constexpr int width = cell_width;
  for (GridTraversal cells(o * (1.0f / width), d * (1.0f / width), volume.field.cell_counts(),
                           segment.t_begin, segment.t_end);
       !cells.done(); cells.advance()) {
    const Vec3<int>& c = cells.cell();
    const std::int32_t entry = volume.field.cell(c.x, c.y, c.z);
    if (entry == DensityField::empty_cell)
      continue;
    if (entry < 0) {
      const float tau =
          volume.field.uniform_value(entry) * volume.extinction * (cells.t_exit() - cells.t());
      if (!visit(cells.t(), cells.t_exit(), tau))
        return;
      continue;
    }
    const float* brick = volume.field.brick(entry);
    const Vec3f brick_origin = o - Vec3f(Vec3<int>{width * c.x, width * c.y, width * c.z});
    for (BrickWalk cubes(brick, brick_origin, d, cells.t(), cells.t_exit()); !cubes.done();) {
      const float t_a = cubes.t();
      const float tau = volume.extinction * cubes.advance();
      if (!visit(t_a, cubes.t(), tau))
        return;
    }
  }
}

/// Transmittance per channel, by the exact integral. `taken_out`: where given, optical depth of the
/// forward peak that was taken out of the medium (PeakTakenOut).
Rgb exact_transmittance(const Medium& medium, const Segment& segment, Rgb* taken_out = nullptr);

/// Unbiased estimate of the same for shadow rays, `u` uniform in [0, 1): exact up to an optical
/// depth of `certain_depth`; beyond, the ray goes on with a chance of exp(-further optical depth)
/// and is weighted by its inverse (Russian roulette), so that it seldom crosses the dark side of a
/// cloud.
Rgb estimate_transmittance(const Medium& medium, const Segment& segment, float u,
                           Rgb* taken_out = nullptr, float certain_depth = tuning::certain_depth);

/// Unbiased estimate of the same by ratio tracking (Novak et al. 2014), with Russian roulette where
/// little is left, a collision at a time, and by the exact integral over what is left of the
/// segment after most_tentative_collisions. Requires a medium that is not empty.
class RatioTracking {
public:
  RatioTracking(const Medium& medium, const Segment& segment)
      : medium_(&medium), segment_(segment), tracker_(medium, segment) {}

  /// Advances to the next tentative collision; false where there is none: the estimate is complete.
  bool advance(Rng& rng) { return tracker_.advance(rng); }
  /// Multiplies by the transmittance factor of that collision; false where the estimate is
  /// complete.
  bool attenuate(Rng& rng);
  const Rgb& transmittance() const { return weight_; }

private:
  const Medium* medium_;
  Segment segment_;
  MediumTracker tracker_;
  Rgb weight_{1, 1, 1};
  int collisions_ = 0;
};

} // namespace vdbeam
