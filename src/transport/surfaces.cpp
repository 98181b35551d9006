#include "transport/surfaces.h"

#include "math/sampling.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace vdbeam {

namespace {
/// Bound of the ratios of cosines about two normals: at the horizon little light is at stake.
constexpr float most_power_factor = 8;
} // namespace

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
  if (const auto& texture = surfaces.textures[static_cast<std::size_t>(hit.surface)]) {
    textured_ = true;
    shown_ = texture->at(hit.uv);
  }
  orthonormal_frame(hit_.shading_normal, tangent_, bitangent_);
  wo_ = to_local(-direction);
  // A curved surface is seen from the side from which its triangles are.
  constexpr float least_cosine = 1e-3f;
  if (hit_.smooth)
    wo_.z = std::copysign(std::max(std::abs(wo_.z), least_cosine), -dot(direction, hit_.normal));
}

Rgb SurfaceVertex::absorbed() const {
  const Rgb tau = material_.absorption() * static_cast<float>(hit_.t);
  if (front() || max_component(tau) <= 0)
    return Rgb(1);
  return transmittance_of(tau);
}

Rgb SurfaceVertex::matt_share(const Vec3f& wi) const {
  if (material_.is_all_matt())
    return Rgb(1);
  const Rgb all = evaluate(wi);
  const Rgb matt =
      sum_of<Rgb>(wi, [&](const Vec3f& local) { return material_.matt(wo_, local) * shown_; });
  Rgb share;
  for (int c = 0; c < 3; ++c)
    share[c] = all[c] > 0 ? std::min(1.0f, matt[c] / all[c]) : 0;
  return share;
}

float SurfaceVertex::arriving_factor(const Vec3f& wi) const {
  if (!hit_.smooth)
    return 1;
  const float met = std::abs(dot(hit_.normal, wi)), counts = shading_cosine(wi);
  return counts < most_power_factor * met ? counts / met : most_power_factor;
}

/// How much of the power of a photon goes on, for each unit of radiance that a path would take the
/// other way: with two normals the cosines do not cancel (Veach, Robust Monte Carlo Methods for
/// Light Transport Simulation, 1997, eq. 5.17).
float SurfaceVertex::power_factor(const Vec3f& local, const Vec3f& wi) const {
  const float in = std::abs(dot(hit_.normal, from_local(wo_))),
              out = std::abs(dot(hit_.normal, wi));
  const float factor = out * std::abs(wo_.z) / (in * std::abs(local.z));
  return factor < most_power_factor ? factor : most_power_factor;
}

/// The same in render space, with the texture.
MaterialSample SurfaceVertex::shown(MaterialSample local, Carried carried) const {
  local.weight *= shown_;
  if (textured_)
    local.weight += local.untextured * (Rgb(1) - shown_);
  Vec3f wi = from_local(local.wi);
  if (hit_.smooth) {
    if (changes_side(local.wi, wi))
      wi = mirrored(wi);
    if (carried == Carried::power)
      local.weight *= power_factor(local.wi, wi);
  }
  local.wi = normalize(wi);
  return local;
}

MaterialSample SurfaceVertex::sample(Carried carried, Rng& rng) const {
  return shown(material_.sample(wo_, carried, rng), carried);
}

SpecularBranches SurfaceVertex::both_ways(Carried carried, Rng& rng) const {
  const SpecularBranches local = material_.both_ways(wo_, carried, rng);
  return {shown(local.reflected, carried), shown(local.refracted, carried)};
}

SpecularBranches SurfaceVertex::branches(Carried carried) const {
  const SpecularBranches local = material_.branches(wo_, carried);
  return {shown(local.reflected, carried), shown(local.refracted, carried)};
}

} // namespace vdbeam
