#include "lights/surface_light.h"

#include "lights/cone.h"
#include "lights/light_table.h"
#include "math/sampling.h"

#include <bit>
#include <cmath>

namespace vdbeam {

namespace {

/// A second number from a first: the same for the same, else unrelated to it.
double another(float u) {
  return static_cast<double>(mix64(std::bit_cast<std::uint32_t>(u)) >> 11) * 0x1p-53;
}

} // namespace

SurfaceLight::SurfaceLight(std::shared_ptr<const SurfaceSet> surfaces, int surface,
                           const Rgb& radiance, bool two_sided, const SolidAngleShape& seen_as,
                           std::shared_ptr<const Texture> texture, const OccupiedRegion* target)
    : surfaces_(std::move(surfaces)), surface_(surface), radiance_(radiance), two_sided_(two_sided),
      seen_as_(seen_as), texture_(std::move(texture)) {
  const auto index = static_cast<std::size_t>(surface);
  center_ = surfaces_->bounds(index).center();
  const Vec3d corner = Vec3d(surfaces_->bounds(index).upper) - center_;
  size_squared_ = dot(corner, corner);
  if (target) {
    target_.center = target->center;
    target_.radius = target->radius;
  }
  const double sides = two_sided ? 2 : 1;
  if (texture_) {
    cells_.emplace(surfaces_, surface, *texture_);
    intensity_ = Rgb(Vec3d(radiance) * Vec3d(cells_->integral()));
  } else {
    intensity_ = Rgb(Vec3d(radiance) * surfaces_->area(index));
  }
  power_ = Rgb(Vec3d(intensity_) * (static_cast<double>(pi) * sides));
  constexpr int enough = 256; // there may be thousands of lamps, and it only shares out photons
  if (target)
    power_ = estimate_power(*this, enough);
}

SurfacePoint SurfaceLight::sample_area(double place, double u, double v) const {
  return cells_ ? cells_->sample(place, u, v)
                : surfaces_->sample(static_cast<std::size_t>(surface_), place, u, v);
}

float SurfaceLight::area_pdf(std::size_t primitive, const Vec3d& position,
                             const Vec3f& normal) const {
  return cells_ ? cells_->pdf(primitive, position, normal)
                : surfaces_->sample_pdf(static_cast<std::size_t>(surface_), normal);
}

std::optional<SolidAnglePoint> SurfaceLight::sample_solid_angle(const Vec3d& point, float u,
                                                                float v) const {
  const auto x = static_cast<double>(u), y = static_cast<double>(v);
  if (const auto* ball = std::get_if<Ball>(&seen_as_))
    return ball->sample(point, x, y);
  if (const auto* rectangle = std::get_if<Rectangle>(&seen_as_))
    return rectangle->sample(point, x, y);
  return std::nullopt;
}

double SurfaceLight::solid_angle(const Vec3d& point) const {
  if (const auto* ball = std::get_if<Ball>(&seen_as_))
    return ball->solid_angle(point);
  const auto* rectangle = std::get_if<Rectangle>(&seen_as_);
  return rectangle ? rectangle->solid_angle(point) : 0;
}

IncidentSample SurfaceLight::sample_incident(const Vec3f& point, float u, float v) const {
  if (cells_)
    return sample_textured(point, u, v);
  if (const auto seen = sample_solid_angle(Vec3d(point), u, v)) {
    const Vec3f wi(seen->wi);
    const auto pdf = static_cast<float>(seen->pdf);
    const bool lit = shines(Vec3f(seen->normal), -wi);
    return {wi, static_cast<float>(seen->distance), lit ? radiance_ / pdf : Rgb(), pdf};
  }
  return sample_by_area(point, static_cast<double>(u), another(u), static_cast<double>(v));
}

IncidentSample SurfaceLight::sample_by_area(const Vec3f& point, double place, double u,
                                            double v) const {
  const SurfacePoint on = sample_area(place, u, v);
  const Vec3d to = on.position - Vec3d(point);
  const double distance = length(to);
  if (!(distance > 0))
    return {{0, 0, 1}, 0, {}, 0};
  const Vec3f wi(to / distance);
  const float cosine = std::abs(dot(on.normal, wi));
  if (!shines(on.normal, -wi) || !(cosine > 0))
    return {wi, static_cast<float>(distance), {}, 0};
  const auto d = static_cast<float>(distance);
  const float pdf = on.pdf * d * d / cosine;
  return {wi, d, radiance(on.uv) / pdf, pdf};
}

IncidentSample SurfaceLight::sample_textured(const Vec3f& point, float u, float v) const {
  const double whole = solid_angle(Vec3d(point));
  const double place = static_cast<double>(u), across = static_cast<double>(v);
  if (!(whole > 0))
    return sample_by_area(point, place, another(u), across);
  if (u >= 0.5f) {
    IncidentSample sample = sample_by_area(point, 2 * place - 1, another(u), across);
    const float pdf = 0.5f * (sample.pdf + static_cast<float>(1 / whole));
    sample.value *= sample.pdf / pdf;
    sample.pdf = pdf;
    return sample;
  }
  const auto seen = sample_solid_angle(Vec3d(point), 2 * u, v);
  if (!seen)
    return {{0, 0, 1}, 0, {}, 0};
  SurfaceHit hit;
  hit.t = seen->distance;
  hit.position = Vec3d(point) + seen->wi * seen->distance;
  hit.normal = Vec3f(seen->normal);
  hit.surface = surface_;
  const Vec3f wi(seen->wi);
  const float pdf = surface_pdf(hit, wi);
  const Rgb value = pdf > 0 ? radiance(surfaces_->uv(hit)) / pdf : Rgb();
  return {wi, static_cast<float>(hit.t), value, pdf};
}

IncidentSample SurfaceLight::typical_incident(const Vec3f& point) const {
  const Vec3d to = center_ - Vec3d(point);
  const double distance = length(to);
  const Vec3f wi = distance > 0 ? Vec3f(to / distance) : Vec3f{0, 0, 1};
  const double from = std::max(distance * distance, size_squared_);
  return {wi, static_cast<float>(distance), Rgb(Vec3d(intensity_) / from), 0};
}

float SurfaceLight::surface_pdf(const SurfaceHit& hit, const Vec3f& wi) const {
  const float cosine = std::abs(dot(hit.normal, wi)), t = static_cast<float>(hit.t);
  if (!(cosine > 0) || !shines(hit.normal, -wi))
    return 0;
  const double whole = solid_angle(hit.position - Vec3d(wi) * hit.t);
  if (whole > 0 && !cells_)
    return static_cast<float>(1 / whole);
  const float by_area = area_pdf(hit.primitive, hit.position, hit.normal) * t * t / cosine;
  return whole > 0 ? 0.5f * (by_area + static_cast<float>(1 / whole)) : by_area;
}

float SurfaceLight::incident_pdf(const Vec3f& point, const Vec3f& wi) const {
  const auto hit = surfaces_->intersect({{point, wi}});
  return hit && hit->surface == surface_ ? surface_pdf(*hit, wi) : 0;
}

LightHit SurfaceLight::emitted_radiance(const Segment& segment) const {
  const auto hit = surfaces_->intersect(segment);
  if (!hit || hit->surface != surface_ || !shines(hit->normal, -segment.ray.direction))
    return {};
  return {radiance(hit->uv), static_cast<float>(hit->t)};
}

/// By Lambert's cosine law, or evenly in the cone that holds the target.
Vec3f SurfaceLight::sample_leaving(const SurfacePoint& from, Rng& rng, float& weight) const {
  const float u = rng.uniform_positive(), v = rng.uniform();
  const float side = two_sided_ && rng.uniform() >= 0.5f ? -1.0f : 1.0f;
  const Vec3d way = Vec3d(target_.center) - from.position;
  const double distance = length(way), sine = static_cast<double>(target_.radius) / distance;
  if (!(target_.radius > 0) || !(sine < 1)) {
    weight = two_sided_ ? 2 * pi : pi;
    return direction_about(from.normal * side, std::sqrt(u), 2 * pi * v);
  }
  Cone cone{way / distance, sine * sine / (1 + std::sqrt(1 - sine * sine))};
  const Vec3f direction(cone.sample(static_cast<double>(u), static_cast<double>(v)));
  const float cosine = dot(from.normal, direction);
  const bool lit = two_sided_ || cosine > 0;
  weight = lit ? std::abs(cosine) * static_cast<float>(cone.solid_angle()) : 0;
  return direction;
}

EmittedPhoton SurfaceLight::emit(double place, Rng& rng) const {
  const double u = rng.uniform(), v = rng.uniform();
  const SurfacePoint on = sample_area(place, u, v);
  float weight = 0;
  const Vec3f direction = sample_leaving(on, rng, weight);
  SurfaceHit from;
  from.position = on.position;
  from.normal = on.normal;
  const bool front = dot(on.normal, direction) >= 0;
  // Moved off the surface by several roundings to single precision.
  Vec3d start = from.leave(direction);
  const double largest =
      max_component(Vec3d{std::abs(start.x), std::abs(start.y), std::abs(start.z)});
  start += Vec3d(front ? on.normal : -on.normal) * (4e-7 * largest + 1e-12);
  return {{Vec3f(start), direction}, radiance(on.uv) * (weight / on.pdf)};
}

} // namespace vdbeam
