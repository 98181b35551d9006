#include "shading/peak_light.h"

#include "math/opacity.h"

namespace vdbeam {

namespace {

/// The share of light from behind that the peak scatters for the last time between two of its
/// optical depths.
Rgb scattered_last(const Rgb& before, const Rgb& after) {
  Rgb share;
  for (int c = 0; c < 3; ++c)
    share[c] = std::exp(-before[c]) * opacity_of(after[c] - before[c]);
  return share;
}

/// Sorts such light by place: `radiance` is the light from behind as it leaves the medium. The ray
/// is cut at the knots of its profile and at the ends of its pieces.
void sort_light(const World& world, const DepthProfile& profile, const Rgb& radiance,
                const RaySink& sink) {
  ProfileCursor cursor(profile);
  std::vector<Rgb> taken_out(profile.volume_count());
  Rgb before;
  float begin = profile.front();
  for (std::size_t knot = 1, piece = 0; knot < profile.knots();) {
    float end = profile.t(knot);
    if (piece < sink.pieces() && sink.end(piece) < end)
      end = std::max(begin, sink.end(piece++));
    else
      ++knot;
    cursor.move_to(end);
    const Rgb after = cursor.taken_out(world.medium),
              light = radiance * scattered_last(before, after);
    for (std::size_t v = 0; v < taken_out.size(); ++v) {
      const Rgb now = world.medium.peak->excess[profile.volume(v)] * cursor.tau(v);
      Rgb of_volume;
      for (int c = 0; c < 3; ++c)
        if (const float all = after[c] - before[c]; all > 0)
          of_volume[c] = light[c] * (now[c] - taken_out[v][c]) / all;
      sink.add(0.5f * (begin + end), world.medium.volumes[profile.volume(v)].setting, of_volume);
      taken_out[v] = now;
    }
    before = after;
    begin = end;
  }
}

/// What the air lets through of light that the peak scatters for the last time: mean over the ray.
Rgb air_before_peak(const World& world, const DepthProfile& profile) {
  Rgb before, sum, left;
  for (std::size_t knot = 1; profile.air() && knot < profile.knots(); ++knot) {
    const Rgb after = profile.taken_out(world.medium, knot), light = scattered_last(before, after);
    sum += light;
    left += profile.air().left(0.5f * (profile.t(knot - 1) + profile.t(knot))) * light;
    before = after;
  }
  for (int c = 0; c < 3; ++c)
    left[c] = sum[c] > 0 ? left[c] / sum[c] : 1;
  return left;
}

} // namespace

GroupedLight light_of_the_peak(const World& world, const TileRays::PixelRay& ray,
                               const GroupedLight& behind, const std::vector<bool>& sampled_lights,
                               const RaySink& sink) {
  const DepthProfile& profile = ray.profile;
  if (!world.medium.peak || profile.empty())
    return {};
  GroupedLight radiance = behind * air_to_end(ray.camera).left;
  const Rgb air = air_before_peak(world, profile);
  for (std::size_t i = 0; i < world.lights.size(); ++i)
    if (!sampled_lights[i])
      radiance.add(world.lights[i].emitted_radiance(ray.camera.whole()).radiance * air,
                   world.lights.group(i));
  const std::size_t last = profile.knots() - 1;
  const Rgb tau = profile.channels(world.medium, last);
  const Rgb through = transmittance_of(tau);
  if (sink.sorts_by_depth() || sink.sorts_by_volume())
    sort_light(world, profile, radiance.sum() * through, sink);
  return radiance * (through * scattered_last(Rgb(), profile.taken_out(world.medium, last)));
}

} // namespace vdbeam
