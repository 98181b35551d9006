#include "medium/emission.h"

#include <limits>

namespace vdbeam {

namespace {

/// Calls visit(cell, entry, t_a, t_b) for the pieces of the ray in the emitter's cells that are not
/// empty, in order, until it returns false. `o` and `d` are the ray in local coordinates.
template <class Visit>
void walk_emitter(const Emitter& emitter, const Vec3f& o, const Vec3f& d, float t_begin,
                  float t_end, const Visit& visit) {
  const EmissionField& field = *emitter.field;
  constexpr float inverse = 1.0f / cell_width;
  for (GridTraversal cells(o * inverse, d * inverse, field.cell_counts(), t_begin, t_end);
       !cells.done(); cells.advance()) {
    const Vec3<int>& c = cells.cell();
    const std::int32_t entry = field.cell(c.x, c.y, c.z);
    if (entry != DensityField::empty_cell && !visit(c, entry, cells.t(), cells.t_exit()))
      return;
  }
}

/// Exact optical depth per channel at places that do not decrease.
class DepthReader {
public:
  DepthReader(const Medium& medium, const Ray& ray, const DepthProfile& profile)
      : medium_(medium), ray_(ray), profile_(profile) {}

  /// Goes to the piece between two knots that holds what comes next after t, and says where it
  /// ends.
  float enter(float t) {
    if (profile_.empty())
      return infinity;
    while (knot_ + 1 < profile_.knots() && profile_.t(knot_ + 1) <= t)
      ++knot_;
    if (t < profile_.front())
      return profile_.front();
    return knot_ + 1 < profile_.knots() ? profile_.t(knot_ + 1) : infinity;
  }

  /// At t in the piece that was entered last.
  Rgb at(float t) const {
    Rgb sum;
    if (profile_.empty() || t <= profile_.front())
      return sum;
    const bool last = knot_ + 1 == profile_.knots();
    if (last || t >= profile_.t(knot_ + 1))
      return profile_.channels(medium_, last ? knot_ : knot_ + 1);
    for (std::size_t v = 0; v < profile_.volume_count(); ++v) {
      const Volume& volume = medium_.volumes[profile_.volume(v)];
      const float begin = profile_.tau(knot_, v), end = profile_.tau(knot_ + 1, v);
      float tau = begin;
      if (end > begin && t > profile_.t(knot_))
        tau = std::min(tau + cube_optical_depth(volume, ray_, profile_.t(knot_), t), end);
      sum += volume.channel_scale * tau;
    }
    return sum;
  }

private:
  const Medium& medium_;
  const Ray& ray_;
  const DepthProfile& profile_;
  std::size_t knot_ = 0;
};

Rgb transmittance(const Rgb& tau) {
  const float first = std::exp(-tau.x);
  return {first, tau.y == tau.x ? first : std::exp(-tau.y),
          tau.z == tau.x ? first : std::exp(-tau.z)};
}

/// The integral of Tr j over pieces in which j is a polynomial of degree 3 and the optical depth is
/// smooth: Gauss-Legendre quadrature with two or three points, of pieces that are cut in halves
/// until they are thin.
class EmissionIntegral {
public:
  EmissionIntegral(const Medium& medium, const Ray& ray, const DepthProfile& profile, float limit)
      : depth_(medium, ray, profile), air_(profile.air()), limit_(limit) {}

  /// From t_a to t_b, `value(t)` being j. False where nothing that follows can be seen.
  template <class Value>
  bool add(float t_a, float t_b, const Value& value) {
    // Planes that two lattices share are found at places that differ by rounding.
    const float same = std::min(2e-6f, 0.01f * (t_b - t_a));
    for (float t = t_a; t < t_b;) {
      const float knot = depth_.enter(t + same), end = knot < t_b - same ? knot : t_b;
      const Rgb before = depth_.at(t);
      if (opaque(before))
        return false;
      add_piece(t, end, before, depth_.at(end), most_cuts, value);
      t = end;
    }
    return true;
  }
  const Rgb& sum() const { return sum_; }

private:
  static constexpr float thin = 0.25f, thick = 1;
  /// Halves of halves: enough for any optical depth in single precision.
  static constexpr int most_cuts = 32;

  bool opaque(const Rgb& tau) const { return std::min(tau.x, std::min(tau.y, tau.z)) > limit_; }
  /// Optical depth of a piece, of those channels in which it can be seen.
  float thickness(const Rgb& before, const Rgb& after) const {
    float most = 0;
    for (int c = 0; c < 3; ++c)
      if (before[c] < limit_)
        most = std::max(most, after[c] - before[c]);
    return most;
  }

  template <class Value>
  void add_piece(float a, float b, const Rgb& before, const Rgb& after, int cuts,
                 const Value& value) {
    const float middle = 0.5f * (a + b), half = 0.5f * (b - a);
    const float depth = thickness(before, after);
    if (depth > thick && cuts > 0 && middle > a && middle < b) {
      const Rgb between = depth_.at(middle);
      add_piece(a, middle, before, between, cuts - 1, value);
      if (!opaque(between))
        add_piece(middle, b, between, after, cuts - 1, value);
      return;
    }
    if (depth > thick) { // single precision has no place in between
      Rgb mean;
      for (int c = 0; c < 3; ++c) {
        const float piece = after[c] - before[c];
        mean[c] = std::exp(-before[c]) * (piece > 0 ? opacity_of(piece) / piece : 1);
      }
      sum_ += value(middle) * mean * air_.left(middle) * (b - a);
      return;
    }
    const bool clear = after == before;
    const auto point = [&](float t, float weight) {
      sum_ +=
          value(t) * transmittance(clear ? before : depth_.at(t)) * air_.left(t) * (weight * half);
    };
    if (depth > thin) {
      constexpr float offset = 0.77459667f; // Abramowitz and Stegun 25.4.30
      point(middle - offset * half, 5.0f / 9);
      point(middle, 8.0f / 9);
      point(middle + offset * half, 5.0f / 9);
    } else {
      constexpr float offset = 0.57735027f;
      point(middle - offset * half, 1);
      point(middle + offset * half, 1);
    }
  }

  DepthReader depth_;
  const RayAir& air_;
  float limit_;
  Rgb sum_;
};

} // namespace

Rgb emission_along(const Medium& medium, const Segment& segment, const DepthProfile& profile,
                   float cutoff, std::vector<Rgb>* of_emitters) {
  const Ray& ray = segment.ray;
  const float limit = -std::log(std::max(cutoff, 1e-30f));
  Rgb sum;
  for (const Emitter& emitter : medium.emitters) {
    const EmissionField& field = *emitter.field;
    const Vec3f o = emitter.local_point(ray.origin), d = emitter.local_vector(ray.direction);
    EmissionIntegral integral(medium, ray, profile, limit);
    walk_emitter(emitter, o, d, segment.t_begin, segment.t_end,
                 [&](const Vec3<int>& cell, std::int32_t entry, float t_a, float t_b) {
                   const Vec3f corner(cell * cell_width);
                   const auto value = [&](float t) {
                     const Vec3f p = min(max(o + d * t - corner, Vec3f(0)), Vec3f(cell_width));
                     return field.sample_cell(entry, p);
                   };
                   if (entry < 0)
                     return integral.add(t_a, t_b, value);
                   for (GridTraversal cubes(o - corner, d, Vec3<int>(cell_width), t_a, t_b);
                        !cubes.done(); cubes.advance())
                     if (!integral.add(cubes.t(), cubes.t_exit(), value))
                       return false;
                   return true;
                 });
    const Rgb light = integral.sum() * emitter.strength;
    if (of_emitters)
      of_emitters->push_back(light);
    sum += light;
  }
  return sum;
}

Rgb sample_emission(const Medium& medium, const Segment& segment, Rng& rng) {
  const Ray& ray = segment.ray;
  constexpr int samples = 2; // per cell, at equal distances
  Rgb sum;
  for (const Emitter& emitter : medium.emitters) {
    const Vec3f o = emitter.local_point(ray.origin), d = emitter.local_vector(ray.direction);
    walk_emitter(emitter, o, d, segment.t_begin, segment.t_end,
                 [&](const Vec3<int>& cell, std::int32_t entry, float t_a, float t_b) {
                   const float step = (t_b - t_a) / samples, start = t_a + rng.uniform() * step;
                   Rgb values;
                   for (int i = 0; i < samples; ++i) {
                     const Vec3f p =
                         o + d * (start + static_cast<float>(i) * step) - Vec3f(cell * cell_width);
                     values += emitter.field->sample_cell(entry,
                                                          min(max(p, Vec3f(0)), Vec3f(cell_width)));
                   }
                   sum += values * emitter.strength * step;
                   return true;
                 });
  }
  return sum;
}

} // namespace vdbeam
