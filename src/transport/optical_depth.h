#pragma once

#include "math/rng.h"
#include "transport/medium.h"

namespace vdbeam {

/// Optical depth beyond which a ray counts as opaque: exp(-25) = 1.4e-11 of the light is left out.
inline constexpr float opaque_optical_depth = 25;

/// Integral over [t_a, t_b] of the density along a line inside one lattice cube of a brick. Along a
/// line a trilinear function is a cubic, which two-point Gauss-Legendre integrates exactly.
/// `corner` is the cube's lower corner in the brick; o + t d runs in brick coordinates.
inline float integrate_cube(const float* brick, const Vec3<int>& corner, const Vec3f& o,
                            const Vec3f& d, float t_a, float t_b) {
  constexpr int width = DensityField::brick_width;
  const float* p = brick + (corner.x * width + corner.y) * width + corner.z;
  const float c000 = p[0], c001 = p[1], c010 = p[width], c011 = p[width + 1];
  const float* q = p + width * width;
  const float c100 = q[0], c101 = q[1], c110 = q[width], c111 = q[width + 1];
  const float middle = 0.5f * (t_a + t_b), half = 0.5f * (t_b - t_a);
  const Vec3f at_middle = o + d * middle - Vec3f(corner);
  float sum = 0;
  for (const float node : {-0.57735027f, 0.57735027f}) {
    const Vec3f f = at_middle + d * (half * node);
    const float c00 = c000 + f.z * (c001 - c000), c01 = c010 + f.z * (c011 - c010);
    const float c10 = c100 + f.z * (c101 - c100), c11 = c110 + f.z * (c111 - c110);
    const float c0 = c00 + f.y * (c01 - c00), c1 = c10 + f.y * (c11 - c10);
    sum += c0 + f.x * (c1 - c0);
  }
  return std::max(0.0f, half * sum);
}

/// Calls visit(t_a, t_b, tau) for consecutive pieces of the ray inside `volume`, tau being the
/// exact optical depth of the piece for the strongest channel; empty stretches are skipped. Ends
/// when visit returns false.
template <class Visit>
void walk_segments(const Volume& volume, const Ray& ray, float t_begin, float t_end,
                   const Visit& visit) {
  const Vec3f o = volume.local_point(ray.origin), d = volume.local_vector(ray.direction);
  constexpr int width = DensityField::cell_width;
  for (CellWalk cells(o * (1.0f / width), d * (1.0f / width), volume.field.cell_counts(), t_begin,
                      t_end);
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
    for (CellWalk cubes(brick_origin, d, {width, width, width}, cells.t(), cells.t_exit());
         !cubes.done(); cubes.advance()) {
      const float tau = volume.extinction * integrate_cube(brick, cubes.cell(), brick_origin, d,
                                                           cubes.t(), cubes.t_exit());
      if (!visit(cubes.t(), cubes.t_exit(), tau))
        return;
    }
  }
}

/// Transmittance per channel over [0, t_end], by the exact integral.
Rgb exact_transmittance(const Medium& medium, const Ray& ray, float t_end);

/// Unbiased estimate of the same by ratio tracking (Novak et al. 2014), with Russian roulette where
/// little is left.
Rgb ratio_transmittance(const Medium& medium, const Ray& ray, float t_end, Rng& rng);

} // namespace vdbeam
