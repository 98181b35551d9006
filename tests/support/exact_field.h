#pragma once

#include "math/affine.h"
#include "medium/medium.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace vdbeam::test {

/// Double-precision trilinear field on the lattice 0 ... 8 cells, sharp at its borders, and its
/// line integrals: the oracle of the transport tests. It shares no code with the renderer.
class ExactField {
public:
  ExactField(const Vec3<int>& cells, std::function<double(int, int, int)> value)
      : size_{8 * cells.x, 8 * cells.y, 8 * cells.z}, value_(std::move(value)) {}

  double density(const Vec3d& p) const {
    for (int a = 0; a < 3; ++a)
      if (p[a] < 0 || p[a] > size_[a])
        return 0;
    Vec3<int> corner;
    Vec3d f;
    for (int a = 0; a < 3; ++a) {
      corner[a] = std::min(static_cast<int>(p[a]), size_[a] - 1);
      f[a] = p[a] - corner[a];
    }
    double sum = 0;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 2; ++k)
          sum += (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y) * (k ? f.z : 1 - f.z) *
                 static_cast<double>(
                     static_cast<float>(value_(corner.x + i, corner.y + j, corner.z + k)));
    return sum;
  }

  /// Integral of density along o + t d from t_begin to t_end: split at every lattice plane, three
  /// Gauss points in each piece.
  double integral(const Vec3d& o, const Vec3d& d, double t_begin, double t_end) const {
    std::vector<double> t = crossings(o, d, t_begin, t_end);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
      const double m = (t[i] + t[i + 1]) / 2, h = (t[i + 1] - t[i]) / 2, x = h * std::sqrt(0.6);
      sum += h / 9 *
             (5 * density(o + d * (m - x)) + 8 * density(o + d * m) + 5 * density(o + d * (m + x)));
    }
    return sum;
  }

  /// t_begin, every crossing of a lattice plane inside, t_end.
  std::vector<double> crossings(const Vec3d& o, const Vec3d& d, double t_begin,
                                double t_end) const {
    std::vector<double> t{t_begin, t_end};
    for (int a = 0; a < 3; ++a)
      for (int plane = 0; plane <= size_[a] && d[a] != 0; ++plane) {
        const double at = (plane - o[a]) / d[a];
        if (at > t_begin && at < t_end)
          t.push_back(at);
      }
    std::sort(t.begin(), t.end());
    return t;
  }

private:
  Vec3<int> size_;
  std::function<double(int, int, int)> value_;
};

/// A volume alone, as render space sees it: local = (render - translation) / voxel.
inline Volume make_volume(DensityField field, float voxel, const Vec3f& corner, float extinction) {
  Volume volume;
  volume.majorants = MajorantGrid(field);
  volume.field = std::move(field);
  for (int a = 0; a < 3; ++a) {
    volume.to_local.rows[static_cast<std::size_t>(a)] = Vec3f(0);
    volume.to_local.rows[static_cast<std::size_t>(a)][a] = 1 / voxel;
  }
  volume.to_local.translation = corner * (-1 / voxel);
  volume.extinction = extinction;
  volume.voxel_size = voxel;
  return volume;
}

inline Medium make_medium(std::vector<Volume> volumes, const Boxf& bounds) {
  Medium medium;
  for (Volume& volume : volumes) {
    const Rgb& scale = volume.channel_scale;
    medium.chromatic = medium.chromatic || !(scale.x == scale.y && scale.y == scale.z);
    medium.volumes.push_back(std::move(volume));
  }
  medium.phases.emplace_back();
  medium.bounds = bounds;
  return medium;
}

} // namespace vdbeam::test
