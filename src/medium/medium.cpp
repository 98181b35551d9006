#include "medium/medium.h"

namespace vdbeam {

bool Medium::isotropic() const {
  for (const PhaseFunction& phase : phases)
    if (!phase.isotropic())
      return false;
  return true;
}

std::size_t Medium::bytes() const {
  std::size_t sum = 0;
  for (const Volume& volume : volumes)
    sum += volume.field.bytes() + volume.majorants.bytes() +
           (volume.color ? volume.color->bytes() : 0);
  for (const Emitter& emitter : emitters)
    sum += emitter.field->bytes();
  return sum;
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
