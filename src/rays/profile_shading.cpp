#include "rays/profile_shading.h"

#include "layers/opacity_pieces.h"
#include "layers/ray_sink.h"
#include "medium/emission.h"
#include "rays/light_of_air.h"

namespace vdbeam {

namespace {

/// Transmittance from the camera to a place on its ray.
Rgb transmittance_to(const Medium& medium, const DepthProfile& profile, float t) {
  if (profile.empty() || t <= profile.front())
    return Rgb(1);
  ProfileCursor cursor(profile);
  cursor.move_to(t);
  return transmittance_of(cursor.channels(medium));
}

/// A surface is opaque, but for one that stands for what is composited later. Of a shadow catcher
/// the share that is in shadow is.
void end_at_surface(const World& world, const CameraRay& camera, float shadow,
                    OpacityAndDepth& seen) {
  const Material& material = world.surfaces->material(*camera.hit);
  if (material.is_holdout())
    return;
  const auto distance = static_cast<float>(camera.hit->t / world.space.scale);
  if (material.is_shadow_catcher()) {
    const float more = (1 - seen.opacity) * shadow;
    seen.depth += more * distance;
    seen.opacity += more;
    return;
  }
  seen.depth += (1 - seen.opacity) * distance;
  seen.opacity = 1;
}

/// How much of the pixel each object covers: the integral of Tr sigma_t dt of a volume, and what is
/// left of the ray for the surface at its end. Together they are the opacity.
void add_coverage(const EstimatorInput& input, const CameraRay& camera, const DepthProfile& profile,
                  float left, std::size_t pixel, PassImage& image) {
  const Medium& medium = input.world.medium;
  std::vector<float> sums(medium.volumes.size());
  for (std::size_t knot = 1; !profile.empty() && knot < profile.knots(); ++knot)
    add_opacity(medium, profile, knot, [&](std::size_t v, float share) { sums[v] += share; });
  const SceneObjects& objects = *input.objects;
  for (std::size_t v = 0; v < sums.size(); ++v)
    image.coverage[objects.of_volume[medium.volumes[v].setting]][pixel] += sums[v];
  if (camera.hit)
    image.coverage[objects.of_mesh[static_cast<std::size_t>(camera.hit->surface)]][pixel] += left;
}

/// What the camera would see of the surface at which its ray ends, without medium: its light, and
/// that of the air in front as far as the surface hides what is behind. A holdout stands for
/// something else, and of a shadow catcher the plate shows all but the shadow.
GroupedLight surface_through_air(const World& world, const CameraRay& camera,
                                 const SeenSurface& surface) {
  if (!camera.air)
    return surface.radiance;
  const RayAir::Seen air = air_to_end(camera);
  const Material& material = world.surfaces->material(*camera.hit);
  const float hidden = material.is_holdout()          ? 0.0f
                       : material.is_shadow_catcher() ? surface.caught.mean
                                                      : 1.0f;
  GroupedLight seen = surface.radiance * air.left;
  seen.add(air.light * hidden, world.lights.group(world.air_light));
  return seen;
}

} // namespace

GroupedLight lights_through(const World& world, const Segment& segment, const DepthProfile& profile,
                            const Rgb& tr, bool camera,
                            const std::function<float(std::size_t light)>& weight) {
  GroupedLight beyond, sum;
  for (std::size_t i = 0; i < world.lights.size(); ++i) {
    if ((camera && !world.lights.traits(i).visible) || world.lights[i].surface() >= 0)
      continue;
    LightHit hit = world.lights[i].emitted_radiance(segment);
    if (weight)
      hit.radiance *= weight(i);
    if (hit.distance == infinity)
      beyond.add(hit.radiance, world.lights.group(i));
    else
      sum.add(hit.radiance * transmittance_to(world.medium, profile, hit.distance) *
                  profile.air().left(hit.distance),
              world.lights.group(i));
  }
  return sum + beyond * tr;
}

Rgb transmittance(const Medium& medium, const DepthProfile& profile) {
  if (profile.empty())
    return Rgb(1);
  const Rgb tau = profile.channels(medium, profile.knots() - 1);
  return transmittance_of(tau);
}

OpacityAndDepth opacity_and_depth(const World& world, const CameraRay& camera,
                                  const DepthProfile& profile) {
  if (profile.empty())
    return {};
  // Not 1 - tr, which has no digits left where the medium is thin.
  const Rgb tau = profile.channels(world.medium, profile.knots() - 1);
  const float opacity =
      mean_component(Rgb(opacity_of(tau.x), opacity_of(tau.y), opacity_of(tau.z)));
  const double depth = profile.opacity_depth(world.medium) + camera.shift * opacity;
  return {opacity, static_cast<float>(depth / world.space.scale)};
}

OpacityAndDepth shade_profile(const EstimatorInput& input, const CameraRay& camera,
                              const DepthProfile& profile, std::size_t pixel, PassImage& image,
                              const SeenSurface& surface) {
  const World& world = input.world;
  const Rgb tr = transmittance(world.medium, profile);
  const OpacityAndDepth medium = opacity_and_depth(world, camera, profile);
  OpacityAndDepth seen = medium;
  GroupedLight background = lights_through(world, camera.whole(), profile, tr, true);
  if (camera.hit) {
    background += surface_through_air(world, camera, surface) * tr;
    end_at_surface(world, camera, surface.caught.mean, seen);
  }
  const RaySink sink(world, camera, input.layers, pixel, image);
  sink.add_sum(&PassImage::background, background);
  image.opacity[pixel] += seen.opacity;
  image.depth[pixel] += seen.depth;
  if (!image.coverage.empty())
    add_coverage(input, camera, profile, mean_component(tr), pixel, image);
  if (!image.planes.empty())
    input.layers->record(world, camera, profile,
                         {tr, seen.depth, surface.caught.mean, surface.caught.left,
                          camera.air ? surface.added * air_to_end(camera).left : surface.added},
                         pixel, image);
  sink.add_opacity(world.medium, profile);
  add_light_of_air(input, camera, profile, pixel, image);
  return medium;
}

void shade_emission(const EstimatorInput& input, const World& world, const CameraRay& camera,
                    const DepthProfile& profile, std::size_t pixel, PassImage& image,
                    std::uint64_t& emission_rays) {
  if (image.emission.empty() || camera.segment.empty())
    return;
  ++emission_rays;
  const auto cutoff = static_cast<float>(input.settings.cutoff);
  const RaySink sink(world, camera, input.layers, pixel, image);
  std::vector<Rgb> of_emitters;
  const Rgb emission = emission_along(world.medium, camera.segment, profile, cutoff,
                                      sink.sorts_by_volume() ? &of_emitters : nullptr);
  sink.add_sum(&PassImage::emission, {emission, world.lights.group_of_emission()});
  for (std::size_t i = 0; i < of_emitters.size(); ++i)
    sink.add_of_volume(world.medium.emitters[i].setting, of_emitters[i]);
  sink.add_emission(world.medium, camera.segment, profile, cutoff);
}

} // namespace vdbeam
