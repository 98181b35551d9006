#pragma once

#include "geometry/surface_set.h"
#include "image/texture.h"
#include "materials/material.h"
#include "transport/surface_store.h"

#include <memory>
#include <vector>

namespace vdbeam {

/// What stands in a scene: surfaces in render space and what they are made of.
struct Surfaces {
  std::shared_ptr<const SurfaceSet> set;
  std::vector<std::shared_ptr<const Material>> materials; ///< per surface
  std::vector<std::shared_ptr<const Texture>> textures;   ///< per surface; null: none
  std::shared_ptr<const SurfaceStore> store; ///< what they were made of, for the next frame
  std::vector<int> lights; ///< per surface: its index among the lights, -1 where it does not shine

  const Material& material(const SurfaceHit& hit) const {
    return *materials[static_cast<std::size_t>(hit.surface)];
  }
  /// Of meshes, trees and textures.
  std::size_t bytes() const;
  std::vector<Boxd> solids; ///< bounds of the surfaces inside of which there is no medium

  /// How far from its beginning a flight that ends there meets the medium. Within a solid, whose
  /// surface is the next of a solid that the flight, or its continuation, meets, and from the back,
  /// there is none.
  float medium_end(const std::optional<SurfaceHit>& end, const Vec3f& direction) const {
    if (!end)
      return infinity;
    return !solids.empty() && inside_solid(*end, direction) ? 0 : static_cast<float>(end->t);
  }

private:
  bool inside_solid(SurfaceHit end, const Vec3f& direction) const;
};

/// A path at a surface: where it came along `direction`.
class SurfaceVertex {
public:
  SurfaceVertex(const Surfaces& surfaces, const SurfaceHit& hit, const Vec3f& direction);

  const SurfaceHit& hit() const { return hit_; }
  const Material& material() const { return material_; }
  /// The path came to the side to which the normal points.
  bool front() const { return wo_.z > 0; }
  /// Index of the light that the surface is, or -1.
  int light() const { return light_; }
  Rgb emitted() const { return material_.emitted(front()) * shown_; }
  /// What absorption inside left of the light on its way from the path's last event to here.
  Rgb absorbed() const;
  /// f(wo, wi) |cos(wi)| and the density with which `sample` draws wi, in render space.
  Rgb evaluate(const Vec3f& wi) const { return material_.evaluate(wo_, to_local(wi)) * shown_; }
  float pdf(const Vec3f& wi) const { return material_.pdf(wo_, to_local(wi)); }
  /// Where the path goes on; the direction is in render space.
  MaterialSample sample(Carried carried, Rng& rng) const;

private:
  Vec3f to_local(const Vec3f& v) const {
    return {dot(v, tangent_), dot(v, bitangent_), dot(v, hit_.normal)};
  }

  SurfaceHit hit_;
  const Material& material_;
  int light_;
  Rgb shown_{1, 1, 1}; ///< by the texture: factor of what is reflected and emitted
  Vec3f tangent_, bitangent_;
  Vec3f wo_; ///< back along the path, in the surface's frame
};

/// Ends long paths among surfaces: from the 64th on a path goes on with the chance 0.9, its weight
/// divided by that, so that mirrors that face each other keep no path for ever.
class SurfaceRoulette {
public:
  bool survive(Rgb& weight, Rng& rng) {
    if (++count_ < first)
      return true;
    if (rng.uniform() >= chance)
      return false;
    weight *= 1 / chance;
    return true;
  }

private:
  static constexpr int first = 64;
  static constexpr float chance = 0.9f;
  int count_ = 0;
};

} // namespace vdbeam
