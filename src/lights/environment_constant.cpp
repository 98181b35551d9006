#include "image/color_conversion.h"
#include "lights/entry_sampler.h"
#include "lights/environment_image.h"
#include "lights/light_table.h"
#include "machine/stop_reading.h"
#include "math/color.h"
#include "math/sampling.h"
#include "vdbeam/image_file.h"

namespace vdbeam {
namespace {

/// The same radiance from everywhere.
class ConstantEnvironment final : public Light {
public:
  ConstantEnvironment(const Rgb& radiance, const OccupiedRegion& region)
      : radiance_(radiance), boxes_(region.boxes) {}

  IncidentSample sample_incident(const Vec3f&, float u, float v) const override {
    return {sample_sphere(u, v), infinity, radiance_ * (4 * pi), density};
  }
  float incident_pdf(const Vec3f&, const Vec3f&) const override { return density; }
  LightHit emitted_radiance(const Segment& segment) const override {
    return {segment.t_end == infinity ? radiance_ : Rgb()};
  }
  EmittedPhoton emit(double place, Rng& rng) const override {
    const float u_face = static_cast<float>(place), u = rng.uniform(), v = rng.uniform();
    const float u_direction = rng.uniform(), v_direction = rng.uniform();
    const EntrySampler::Entry entry = boxes_.sample_surface(u_face, u, v, u_direction, v_direction);
    return {{entry.point, entry.direction}, radiance_ * entry.weight};
  }
  Rgb power() const override { return radiance_ * (pi * boxes_.surface_area()); }
  bool is_delta() const override { return false; }

private:
  static constexpr float density = 1 / (4 * pi);

  Rgb radiance_;
  EntrySampler boxes_;
};

std::unique_ptr<Light> make_environment_light(const LightSettings& settings,
                                              const LightContext& context) {
  if (settings.image.empty())
    return std::make_unique<ConstantEnvironment>(settings.radiance, context.region);
  Image image = read_image(settings.image);
  StopReading::check();
  convert_colors(image, chromaticities_of(settings.color_space));
  StopReading::check();
  return make_environment_image(image, settings.image, settings, context);
}

constexpr std::string_view environment_keys[] = {"radiance", "image", "rotation"};

} // namespace

const LightKind environment_light{
    .name = "environment",
    .help = "radiance from all directions, constant or from an image",
    .keys = environment_keys,
    .colored =
        [](const LightSettings& light) { return !light.image.empty() || !is_grey(light.radiance); },
    .surrounds = true,
    .wants_shadow_rays = [](const LightSettings& light) { return !light.image.empty(); },
    .make = make_environment_light};

} // namespace vdbeam
