#include "lights/cone.h"
#include "lights/disc_light.h"
#include "lights/entry_sampler.h"
#include "lights/light_table.h"
#include "lights/silhouette_mask.h"
#include "math/color.h"

namespace vdbeam {
namespace {

// Up to this tangent of the angular radius photons are aimed through the mask of the light's axis;
// a wider light sees the region from too many sides for one mask.
constexpr double widest_mask = 0.1;

/// The sun: parallel light of a given irradiance.
class ParallelLight final : public Light {
public:
  ParallelLight(const Vec3d& direction, const Rgb& irradiance, const OccupiedRegion& region)
      : direction_(direction), towards_(-direction_), irradiance_(irradiance),
        mask_(direction_, 0, region) {}

  IncidentSample sample_incident(const Vec3f&, float, float) const override {
    return {-direction_, infinity, irradiance_, 0};
  }
  float incident_pdf(const Vec3f&, const Vec3f&) const override { return 0; }
  LightHit emitted_radiance(const Segment&) const override { return {}; }
  EmittedPhoton emit(double place, Rng& rng) const override {
    if (mask_.area() <= 0)
      return {{{}, direction_}, {}};
    const auto pixel = static_cast<std::uint32_t>(place * 0x1p32);
    const float u = rng.uniform(), v = rng.uniform();
    const SilhouetteMask::Point start = mask_.sample(pixel, u, v);
    return {{start.position + direction_ * start.depth, direction_}, irradiance_ * mask_.area()};
  }
  Rgb power() const override { return irradiance_ * mask_.area(); }
  bool is_delta() const override { return true; }
  const Vec3f* narrow_direction() const override { return &towards_; }

private:
  Vec3f direction_, towards_;
  Rgb irradiance_;
  SilhouetteMask mask_;
};

/// The sun as a disc of radiance L: a plane that faces it receives E = pi L sin^2(radius). Towards
/// its limb it may be darker.
class DiscLight final : public Light {
public:
  DiscLight(const Vec3d& direction, const Rgb& irradiance, double radius_degrees, const Rgb& limb,
            const OccupiedRegion& region)
      : axis_(direction), towards_(-axis_),
        limb_(limb), cone_{direction, one_minus_cos_degrees(radius_degrees)},
        mask_(axis_, static_cast<float>(spread()), masked() ? region : OccupiedRegion{}),
        boxes_(region.boxes), irradiance_(irradiance) {
    const double solid_angle = cone_.solid_angle();
    // E / (pi sin^2) * solid angle, without the small numbers.
    total_ = Rgb(Vec3d(irradiance) * (2 / (2 - cone_.one_minus_cos)));
    pdf_ = static_cast<float>(1 / solid_angle);
    radiance_ = Rgb(Vec3d(total_) / solid_angle);
    for (int i = 0; i < 3; ++i)
      radiance_[i] = std::min(radiance_[i], std::numeric_limits<float>::max());
  }

  IncidentSample sample_incident(const Vec3f&, float u, float v) const override {
    const Vec3d direction = cone_.sample(u, v);
    return {Vec3f(-direction), infinity, darkened(total_, direction), pdf_};
  }
  float incident_pdf(const Vec3f&, const Vec3f& wi) const override { return shows(wi) ? pdf_ : 0; }
  LightHit emitted_radiance(const Segment& segment) const override {
    const Vec3f& direction = segment.ray.direction;
    return {segment.t_end == infinity && shows(direction) ? darkened(radiance_, -Vec3d(direction))
                                                          : Rgb()};
  }
  EmittedPhoton emit(double place, Rng& rng) const override {
    return masked() ? emit_through_mask(place, rng) : emit_to_boxes(place, rng);
  }
  Rgb power() const override {
    return irradiance_ * (masked() ? mask_.area() : boxes_.projected_area(axis_));
  }
  bool is_delta() const override { return false; }
  const Vec3f* narrow_direction() const override { return masked() ? &towards_ : nullptr; }

private:
  double spread() const {
    const double cosine = 1 - cone_.one_minus_cos;
    return std::sqrt(cone_.one_minus_cos * (2 - cone_.one_minus_cos)) / std::max(cosine, 1e-9);
  }
  bool masked() const { return spread() <= widest_mask; }
  // The chord between unit vectors: |a - b|^2 = 2 (1 - cos), exact for narrow discs.
  bool shows(const Vec3f& direction) const {
    const Vec3d chord = Vec3d(direction) + cone_.axis;
    return dot(chord, chord) <= 2 * cone_.one_minus_cos;
  }
  /// The light that travels along `direction`; `even` is its mean over the disc.
  Rgb darkened(const Rgb& even, const Vec3d& direction) const {
    if (limb_ == Rgb(0))
      return even;
    const Vec3d chord = direction - cone_.axis;
    const double x = dot(chord, chord) / 2, edge = cone_.one_minus_cos; // 1 - cos
    const double cosine = std::sqrt(std::max(0.0, 1 - x * (2 - x) / (edge * (2 - edge))));
    Rgb result = even;
    for (int c = 0; c < 3; ++c) // over the disc cos^n has the mean 2 / (n + 2)
      result[c] *= (limb_[c] + 2) / 2 * std::pow(static_cast<float>(cosine), limb_[c]);
    return result;
  }
  EmittedPhoton emit_through_mask(double place, Rng& rng) const {
    if (mask_.area() <= 0)
      return {{{}, axis_}, {}};
    const auto pixel = static_cast<std::uint32_t>(place * 0x1p32);
    const float u = rng.uniform(), v = rng.uniform();
    const SilhouetteMask::Point start = mask_.sample(pixel, u, v);
    const float u_direction = rng.uniform(), v_direction = rng.uniform();
    const Vec3f direction(cone_.sample(u_direction, v_direction));
    const float cosine = dot(direction, axis_); // the mask's plane is seen at this angle
    return {{start.position + direction * (start.depth / cosine), direction},
            darkened(total_, Vec3d(direction)) * (mask_.area() * cosine)};
  }
  EmittedPhoton emit_to_boxes(double place, Rng& rng) const {
    const float u = rng.uniform(), v = rng.uniform();
    const float u_direction = rng.uniform(), v_direction = rng.uniform();
    const Vec3f direction(cone_.sample(u_direction, v_direction));
    const EntrySampler::Entry entry =
        boxes_.sample_line(direction, static_cast<float>(place), u, v);
    return {{entry.point, direction}, darkened(total_, Vec3d(direction)) * entry.weight};
  }

  Vec3f axis_, towards_;
  Rgb limb_;
  Cone cone_; ///< of the directions of travel
  SilhouetteMask mask_;
  EntrySampler boxes_;
  Rgb irradiance_;
  Rgb total_; ///< radiance times solid angle
  Rgb radiance_;
  float pdf_ = 0;
};

std::unique_ptr<Light> make_distant_light(const LightSettings& settings,
                                          const LightContext& context) {
  const Vec3d direction = unit_direction(settings.direction, "light.direction");
  if (settings.angular_radius <= 0)
    return std::make_unique<ParallelLight>(direction, settings.irradiance, context.region);
  // Narrower discs than this have no width in single precision; a hemisphere is the widest.
  const double radius = std::clamp(settings.angular_radius, 1e-5, 90.0);
  return make_disc_light(direction, settings.irradiance, radius, Rgb(0), context.region);
}

constexpr std::string_view distant_keys[] = {"direction", "irradiance", "angular_radius"};

} // namespace

std::unique_ptr<Light> make_disc_light(const Vec3d& direction, const Rgb& irradiance,
                                       double radius_degrees, const Rgb& limb,
                                       const OccupiedRegion& region) {
  return std::make_unique<DiscLight>(direction, irradiance, radius_degrees, limb, region);
}

const LightKind distant_light{
    .name = "distant",
    .help = "a directional light with an angular radius, such as the sun",
    .keys = distant_keys,
    .colored = [](const LightSettings& light) { return !is_grey(light.irradiance); },
    .complaint = direction_complaint,
    .make = make_distant_light};

} // namespace vdbeam
