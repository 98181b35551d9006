#include "transport/medium.h"

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
    sum += volume.field.bytes() + volume.majorants.bytes();
  for (const Emitter& emitter : emitters)
    sum += emitter.field->bytes();
  return sum;
}

void Medium::clip(const Ray& ray, float& t_begin, float& t_end) const {
  for (int a = 0; a < 3; ++a) {
    const float o = ray.origin[a], d = ray.direction[a];
    if (d == 0) {
      if (o < bounds.lower[a] || o > bounds.upper[a])
        t_end = t_begin;
      continue;
    }
    const float near = ((d > 0 ? bounds.lower[a] : bounds.upper[a]) - o) / d;
    const float far = ((d > 0 ? bounds.upper[a] : bounds.lower[a]) - o) / d;
    t_begin = std::max(t_begin, near);
    t_end = std::min(t_end, far);
  }
}

} // namespace vdbeam
