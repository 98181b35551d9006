#pragma once

#include "math/ray.h"
#include "math/rng.h"
#include "vdbeam/surface_settings.h"

namespace vdbeam {

/// Quantity that the followed light carries: radiance on paths from the camera, power on paths from
/// lights. Refraction scales radiance by the square of the relative index, power not.
enum class Carried { radiance, power };

/// A direction drawn by `Material::sample`.
struct MaterialSample {
  Vec3f wi;      ///< unit, away from the surface
  Rgb weight;    ///< f |cos| / pdf; 0: the path ends
  float pdf = 0; ///< per solid angle; 0: a direction that only `sample` can find
  /// Factor of the weight that refraction will take back where the path leaves again.
  float refraction = 1;
  Rgb untextured = {}; ///< the part of the weight that a texture does not multiply
};

/// The ways on from a surface that reflects and refracts, each with its own weight; 0: there is no
/// such way.
struct SpecularBranches {
  MaterialSample reflected, refracted;
};

/// How a surface scatters light, in its own frame: z is the normal on its front. `wo` points the
/// way the path came from, `wi` the way it goes on; both leave the surface.
class Material {
public:
  virtual ~Material() = default;

  /// f(wo, wi) |cos(wi)|, without what only `sample` finds; the same for both kinds of paths.
  virtual Rgb evaluate(const Vec3f& wo, const Vec3f& wi) const = 0;
  /// The part of `evaluate` that a texture does not multiply.
  virtual Rgb untextured(const Vec3f& wo, const Vec3f& wi) const {
    static_cast<void>(wo), static_cast<void>(wi);
    return {};
  }
  /// The density with which `sample` draws wi.
  virtual float pdf(const Vec3f& wo, const Vec3f& wi) const = 0;
  virtual MaterialSample sample(const Vec3f& wo, Carried carried, Rng& rng) const = 0;
  /// `evaluate` is 0 for all directions: shadow rays are no use.
  virtual bool is_specular() const { return false; }
  /// Rough glass: one branch by reflection and one by refraction, each weighted by its share of the
  /// light, where `sample` follows one of them. Their densities are those of `pdf`.
  virtual SpecularBranches both_ways(const Vec3f& wo, Carried carried, Rng& rng) const {
    static_cast<void>(rng);
    return branches(wo, carried);
  }
  /// Specular surfaces: all outgoing branches; `sample` chooses one of them.
  virtual SpecularBranches branches(const Vec3f& wo, Carried carried) const {
    static_cast<void>(wo), static_cast<void>(carried);
    return {};
  }
  /// It shows a picture of its surroundings, if a blurred one: what camera rays show of it is found
  /// by rays that go on, as photons that arrive rarely come from where it shows light from.
  virtual bool shows_surroundings() const { return is_specular() && !is_black(); }
  /// Sends light on in a narrow lobe, or in single directions: mirrors, metal and glass, smooth or
  /// rough. A path that scatters elsewhere rarely finds where such a surface shows it a lamp or the
  /// sun, and is bright then: photons bring that light to other surfaces.
  virtual bool throws_light() const { return is_specular() && !is_black(); }
  /// Light goes on behind it, as in glass: its back encloses something.
  virtual bool refracts() const { return false; }
  /// Whether its reflected light is estimated from arriving photons.
  bool takes_photons() const { return !is_black() && !shows_surroundings(); }
  /// The part of `evaluate` that is matt: seen from elsewhere it changes by the factor
  /// `matt_albedo` alone. The rest is glossy.
  virtual Rgb matt(const Vec3f& wo, const Vec3f& wi) const {
    static_cast<void>(wo), static_cast<void>(wi);
    return {};
  }
  /// Share of the light that the matt part reflects towards wo, but for a constant factor: the
  /// albedo of a Lambertian surface.
  virtual Rgb matt_albedo(const Vec3f& wo) const {
    static_cast<void>(wo);
    return {};
  }
  /// It has no glossy part.
  virtual bool is_all_matt() const { return false; }
  /// Its colour, as denoisers want it.
  virtual Rgb guide_albedo() const { return {}; }
  /// Reflects nothing.
  virtual bool is_black() const { return false; }
  /// Radiance that it emits to its front (`front`) or back; to the back the same or nothing.
  virtual Rgb emitted(bool front) const {
    static_cast<void>(front);
    return {};
  }
  /// The surface is a light.
  bool shines() const { return max_component(emitted(true)) > 0; }
  /// Absorption coefficient of what its back encloses, per render unit.
  virtual Rgb absorption() const { return {}; }
  /// No medium is inside of what its back encloses.
  virtual bool is_solid() const { return false; }
  /// Light ends here and the picture is transparent.
  virtual bool is_holdout() const { return false; }
  /// The camera sees nothing of it but shadows.
  virtual bool is_shadow_catcher() const { return false; }
};

} // namespace vdbeam
