#include "medium/medium.h"

#include <set>

namespace vdbeam {

Affine Volume::to_render() const {
  Affine map;
  for (std::size_t row = 0; row < 3; ++row)
    map.rows[row] = Vec3d(to_local.rows[row]);
  map.translation = Vec3d(to_local.translation);
  return map.inverse();
}

Boxd Volume::bounds() const {
  const Vec3d cells = Vec3d(field.cell_counts()) * double{cell_width};
  return to_render().bounds({Vec3d(0), cells});
}

bool Medium::isotropic() const {
  for (const PhaseFunction& phase : phases)
    if (!phase.isotropic())
      return false;
  return true;
}

std::size_t Medium::bytes() const {
  std::size_t sum = tree ? tree->bytes() : 0;
  std::set<const void*> known; // volumes share what they have in common
  for (const Volume& volume : volumes) {
    if (known.insert(volume.field.values()).second)
      sum += volume.field.bytes();
    if (known.insert(volume.majorants.values()).second)
      sum += volume.majorants.bytes();
    if (volume.color && known.insert(volume.color.get()).second)
      sum += volume.color->bytes();
  }
  for (const Emitter& emitter : emitters)
    sum += emitter.field->bytes();
  return sum;
}

float Medium::majorant(const Vec3f& point, std::size_t part, const Volume* but) const {
  float sum = 0;
  for_each_at(point, [&](std::size_t v) {
    if (parts[v] == part && &volumes[v] != but)
      sum += volumes[v].majorant(point);
  });
  return sum;
}

void Medium::grow_tree() {
  tree = nullptr;
  if (volumes.size() <= VolumeTree::few)
    return;
  std::vector<Boxf> boxes;
  boxes.reserve(volumes.size());
  for (const Volume& volume : volumes) {
    const Boxd box = volume.bounds();
    const Vec3d margin =
        box.size() * 1e-5 + max(max(box.upper, -box.lower), Vec3d(0)) * 1e-6 + Vec3d(1e-7);
    boxes.push_back({Vec3f(box.lower - margin), Vec3f(box.upper + margin)});
  }
  tree = std::make_shared<const VolumeTree>(boxes);
}

Segment Medium::clip(Segment segment) const {
  for (int a = 0; a < 3; ++a) {
    const float o = segment.ray.origin[a], d = segment.ray.direction[a];
    if (d == 0) {
      if (o < bounds.lower[a] || o > bounds.upper[a])
        segment.t_end = segment.t_begin;
      continue;
    }
    const float near = ((d > 0 ? bounds.lower[a] : bounds.upper[a]) - o) / d;
    const float far = ((d > 0 ? bounds.upper[a] : bounds.lower[a]) - o) / d;
    segment.t_begin = std::max(segment.t_begin, near);
    segment.t_end = std::min(segment.t_end, far);
  }
  return segment;
}

} // namespace vdbeam
