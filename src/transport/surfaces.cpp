#include "transport/surfaces.h"

#include "math/sampling.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace vdbeam {

std::size_t Surfaces::bytes() const {
  std::set<const Texture*> known;
  std::size_t sum = set->bytes();
  for (const auto& texture : textures)
    if (texture && known.insert(texture.get()).second)
      sum += texture->bytes();
  return sum;
}

bool Surfaces::inside_solid(SurfaceHit end, const Vec3f& direction) const {
  for (;;) {
    if (material(end).is_solid())
      return dot(end.normal, direction) > 0;
    const Vec3d& p = end.position;
    const bool maybe = std::any_of(solids.begin(), solids.end(), [&](const Boxd& box) {
      return p.x > box.lower.x && p.y > box.lower.y && p.z > box.lower.z && p.x < box.upper.x &&
             p.y < box.upper.y && p.z < box.upper.z;
    });
    const auto next = maybe ? set->intersect(end.leave(direction), Vec3d(direction), 0,
                                             static_cast<double>(infinity))
                            : std::nullopt;
    if (!next)
      return false;
    end = *next;
  }
}

SurfaceVertex::SurfaceVertex(const Surfaces& surfaces, const SurfaceHit& hit,
                             const Vec3f& direction)
    : hit_(hit), material_(surfaces.material(hit)),
      light_(surfaces.lights[static_cast<std::size_t>(hit.surface)]) {
  if (const auto& texture = surfaces.textures[static_cast<std::size_t>(hit.surface)])
    shown_ = texture->at(hit.uv);
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
  result.weight *= shown_;
  const Vec3f local = result.wi;
  result.wi = normalize(tangent_ * local.x + bitangent_ * local.y + hit_.normal * local.z);
  return result;
}

} // namespace vdbeam
