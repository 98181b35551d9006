#pragma once

#include "geometry/surface_set.h"
#include "image/texture.h"
#include "materials/material.h"
#include "transport/material_maps.h"
#include "transport/surface_store.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace vdbeam {

/// Surfaces of a scene in render space, and their materials.
struct Surfaces {
  std::shared_ptr<const SurfaceSet> set;
  std::vector<std::shared_ptr<const Material>> materials; ///< per surface
  /// Per surface: its materials from point to point; null: it has but one.
  std::vector<std::shared_ptr<const MaterialMaps>> maps;
  std::vector<std::shared_ptr<const Texture>> textures; ///< per surface; null: none
  std::shared_ptr<const SurfaceStore> store; ///< what they were made of, for the next frame
  std::vector<int> lights; ///< per surface: its index among the lights, -1 where it does not shine

  const Material& material(const SurfaceHit& hit) const {
    const auto i = static_cast<std::size_t>(hit.surface);
    return maps[i] ? maps[i]->at(hit) : *materials[i];
  }
  /// Memory of meshes, trees and textures.
  std::size_t bytes() const;
  std::vector<Boxd> solids; ///< bounds of the surfaces that exclude the medium from their inside

  /// Some surface is a mirror, glass, or metal that is not very rough.
  bool show_surroundings() const {
    return any([](const Material& material) { return material.shows_surroundings(); });
  }

  /// Some surface is a mirror or smooth glass: path tracing may miss light that it focuses.
  bool focus_light() const {
    return any(
        [](const Material& material) { return material.is_specular() && !material.is_black(); });
  }

  /// Some surface sends light on in narrow lobes (Material::throws_light).
  bool throw_light() const {
    return any([](const Material& material) { return material.throws_light(); });
  }

  /// How far from its beginning a flight that ends there meets the medium. Within a solid, whose
  /// surface is the next of a solid that the flight, or its continuation, meets, and from the back,
  /// there is none.
  float medium_end(const std::optional<SurfaceHit>& end, const Vec3f& direction) const {
    if (!end)
      return infinity;
    return !solids.empty() && inside_solid(*end, direction) ? 0 : static_cast<float>(end->t);
  }

  /// Some surface is neither only matt nor specular.
  bool any_gloss() const {
    return any([](const Material& material) {
      return !material.is_all_matt() && !material.is_black() && !material.is_specular();
    });
  }

private:
  template <class Predicate>
  bool any(const Predicate& is_wanted) const {
    const auto wanted = [&](const auto& material) { return is_wanted(*material); };
    return std::any_of(materials.begin(), materials.end(), wanted) ||
           std::any_of(maps.begin(), maps.end(), [&](const auto& map) {
             return map && std::any_of(map->materials().begin(), map->materials().end(), wanted);
           });
  }
  bool inside_solid(SurfaceHit end, const Vec3f& direction) const;
};

/// A path at a surface: where it came along `direction`.
class SurfaceVertex {
public:
  SurfaceVertex(const Surfaces& surfaces, const SurfaceHit& hit, const Vec3f& direction);

  const SurfaceHit& hit() const { return hit_; }
  Vec3f position() const { return Vec3f(hit_.position); }
  /// Where a ray begins that leaves in the direction wi.
  Vec3d leave(const Vec3f& wi) const { return hit_.leave(wi); }
  const Material& material() const { return material_; }
  /// The path came to the side to which the normal points.
  bool front() const { return wo_.z > 0; }
  /// Index of the light that the surface is, or -1.
  int light() const { return light_; }
  /// Albedo of the matt part of the material, for the direction from which the path came.
  Rgb matt_albedo() const { return material_.matt_albedo(wo_) * shown_; }
  /// The share of `evaluate` that is the matt part's, per channel.
  Rgb matt_share(const Vec3f& wi) const;
  Rgb guide_albedo() const { return material_.guide_albedo() * shown_; }
  Rgb texture() const { return shown_; } ///< its colour; 1 where there is none
  Rgb emitted() const { return material_.emitted(front()) * shown_; }
  /// Transmittance of absorption inside from the path's last event to here.
  Rgb absorbed() const;
  /// f(wo, wi) |cos(wi)| and the density with which `sample` draws wi, in render space.
  Rgb evaluate(const Vec3f& wi, Carried carried = Carried::radiance) const {
    const bool corrected = hit_.smooth && carried == Carried::power;
    return sum_of<Rgb>(wi, [&](const Vec3f& local) {
      Rgb value = material_.evaluate(wo_, local) * shown_;
      if (textured_)
        value += material_.untextured(wo_, local) * (Rgb(1) - shown_);
      return value * (corrected ? power_factor(local, wi) : 1);
    });
  }
  /// |cos(wi)| as `evaluate` has it: about the shading normal.
  float shading_cosine(const Vec3f& wi) const {
    return sum_of<float>(wi, [](const Vec3f& local) { return std::abs(local.z); });
  }
  /// Power of a photon from wi that counts for the curved surface, over that which meets the
  /// triangle: the ratio of the cosines about the two normals (Veach 1997, 5.3), bounded.
  float arriving_factor(const Vec3f& wi) const;
  float pdf(const Vec3f& wi) const {
    return sum_of<float>(wi, [&](const Vec3f& local) { return material_.pdf(wo_, local); });
  }
  /// Where the path goes on; the direction is in render space.
  MaterialSample sample(Carried carried, Rng& rng) const;
  /// Glass: one branch by reflection and one by refraction, in render space.
  SpecularBranches both_ways(Carried carried, Rng& rng) const;
  /// Specular materials: all outgoing branches, in render space.
  SpecularBranches branches(Carried carried) const;

private:
  MaterialSample shown(MaterialSample local, Carried carried) const;
  float power_factor(const Vec3f& local, const Vec3f& wi) const;
  Vec3f to_local(const Vec3f& v) const {
    return {dot(v, tangent_), dot(v, bitangent_), dot(v, hit_.shading_normal)};
  }
  Vec3f from_local(const Vec3f& v) const {
    return tangent_ * v.x + bitangent_ * v.y + hit_.shading_normal * v.z;
  }
  // A curved surface would send some light through its triangles that it ought to reflect, and the
  // other way round. Such directions are mirrored at the triangle: no light leaks or is lost.
  bool changes_side(const Vec3f& local, const Vec3f& wi) const {
    return (local.z > 0) != (dot(hit_.normal, wi) > 0);
  }
  Vec3f mirrored(const Vec3f& wi) const { return wi - hit_.normal * (2 * dot(hit_.normal, wi)); }
  /// The sum of a function over those of the material's own directions that go to wi.
  template <class Value, class Function>
  Value sum_of(const Vec3f& wi, const Function& function) const {
    const Vec3f local = to_local(wi);
    if (!hit_.smooth)
      return function(local);
    Value sum{};
    if (!changes_side(local, wi))
      sum += function(local);
    const Vec3f image = mirrored(wi), local_image = to_local(image);
    if (changes_side(local_image, image))
      sum += function(local_image);
    return sum;
  }

  SurfaceHit hit_;
  const Material& material_;
  int light_;
  bool textured_ = false;
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
