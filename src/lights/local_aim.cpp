#include "lights/local_aim.h"

namespace vdbeam {

Cone cone_towards(const Vec3d& position, const OccupiedRegion& region) {
  Cone cone;
  const Vec3d way = Vec3d(region.center) - position;
  if (region.boxes.empty() || !(length(way) > 0))
    return cone;
  const Vec3d axis = normalize(way);
  double widest = 0;
  for (const Parallelepiped& box : region.boxes)
    for (int corner = 0; corner < 8; ++corner) {
      Vec3d to = Vec3d(box.corner) - position;
      for (int i = 0; i < 3; ++i)
        if (corner >> i & 1)
          to += Vec3d(box.edges[i]);
      const double distance = length(to), cosine = dot(to, axis) / distance;
      if (!(cosine > 0))
        return cone;
      // 1 - cos from the sine, which keeps its digits for a far light.
      const double sine = length(cross(axis, to)) / distance;
      widest = std::max(widest, sine * sine / (1 + cosine));
    }
  cone.axis = axis;
  cone.one_minus_cos = std::min(1.0, widest * (1 + 1e-5)); // the boxes are single precision
  return cone;
}

bool advance_to_region(const Vec3d& position, const Vec3d& direction, const OccupiedRegion& region,
                       Vec3d& origin) {
  origin = position;
  const Vec3d way = Vec3d(region.center) - position;
  const double along = dot(way, direction);
  const Vec3d across = way - direction * along;
  const double radius = region.radius * (1 + 1e-5);
  const double half_chord2 = radius * radius - dot(across, across);
  if (half_chord2 < 0)
    return false;
  const double half_chord = std::sqrt(half_chord2);
  if (along + half_chord < 0)
    return false;
  if (along > half_chord)
    origin = position + direction * (along - half_chord);
  return true;
}

} // namespace vdbeam
