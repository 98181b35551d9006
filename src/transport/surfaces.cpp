#include "transport/surfaces.h"

#include "math/sampling.h"

#include <cmath>

namespace vdbeam {

SurfaceVertex::SurfaceVertex(const Surfaces& surfaces, const SurfaceHit& hit,
                             const Vec3f& direction)
    : hit_(hit), material_(surfaces.material(hit)),
      light_(surfaces.lights[static_cast<std::size_t>(hit.surface)]) {
  orthonormal_frame(hit_.normal, tangent_, bitangent_);
  wo_ = to_local(-direction);
}

Rgb SurfaceVertex::absorbed() const {
  const Rgb tau = material_.absorption() * static_cast<float>(hit_.t);
  if (front() || max_component(tau) <= 0)
    return Rgb(1);
  return {std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z)};
}

MaterialSample SurfaceVertex::sample(Carried carried, Rng& rng) const {
  MaterialSample result = material_.sample(wo_, carried, rng);
  const Vec3f local = result.wi;
  result.wi = normalize(tangent_ * local.x + bitangent_ * local.y + hit_.normal * local.z);
  return result;
}

} // namespace vdbeam
