#include "lights/disc_light.h"
#include "lights/environment_image.h"
#include "lights/light_table.h"
#include "lights/sky/air_colors.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

namespace vdbeam {
namespace {

/// The sun's radius as seen from the earth, degrees.
constexpr double sun_radius_degrees = 0.2666;
/// How the sun darkens towards its limb, at 610, 550 and 465 nm (Hestroffer and Magnan, Wavelength
/// dependency of the Solar limb darkening, 1998).
const Rgb sun_limb{0.456f, 0.508f, 0.605f};

/// The value that `make` gives for a key, which lights of a frame, and of frames that follow,
/// share.
template <class Key, class Value>
class LastMade {
public:
  template <class Make>
  std::shared_ptr<const Value> get(const Key& key, const Make& make) {
    const std::scoped_lock lock(mutex_);
    if (!value_ || !(key_ == key)) {
      // A thread that waits for its tasks must take no other that waits for the lock.
      tbb::this_task_arena::isolate([&] { value_ = std::make_shared<const Value>(make()); });
      key_ = key;
    }
    return value_;
  }

private:
  std::mutex mutex_;
  Key key_;
  std::shared_ptr<const Value> value_;
};

} // namespace

AirSettings air_of(const LightSettings& settings, const Vec3d& up) {
  const Vec3d to_sun = -unit_direction(settings.direction, "light.direction");
  return {.sun_elevation =
              std::asin(std::clamp(dot(to_sun, unit_direction(up, "camera.up")), -1.0, 1.0)),
          .aerosol = settings.aerosol,
          .ground_albedo = settings.ground_albedo,
          .altitude = settings.altitude};
}

std::shared_ptr<const Atmosphere> atmosphere_of(const AirSettings& air) {
  static LastMade<AirSettings, Atmosphere> last;
  return last.get(air, [&] { return Atmosphere(air); });
}

namespace {

/// What an image of the sky is made from.
struct SkyImageKey {
  AirSettings air;
  Rgb irradiance;
  ColorSpace space = ColorSpace::rec709;
  double sun_turn = 0; ///< where the sun is in the image, radians
  /// The row below the horizon shows the sky: what is far away on the ground has its colour, and
  /// no image is so fine that the ground behind could not be seen in between.
  bool open_horizon = false;

  friend bool operator==(const SkyImageKey&, const SkyImageKey&) = default;
};

Image sky_image(const SkyImageKey& key, const AirColors& color) {
  const auto air = atmosphere_of(key.air);
  Image image;
  image.width = 1024;
  image.height = 512;
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, std::vector<float>(count)});
  std::size_t pixel = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, ++pixel) {
      const int row = key.open_horizon && y == image.height / 2 ? y - 1 : y;
      const double elevation = std::numbers::pi * (0.5 - (row + 0.5) / image.height);
      const double turn = 2 * std::numbers::pi * (x + 0.5) / image.width;
      const Rgb seen = color(air->radiance(elevation, turn - key.sun_turn));
      for (int c = 0; c < 3; ++c)
        image.channels[static_cast<std::size_t>(c)].data[pixel] = seen[c];
    }
  return image;
}

std::unique_ptr<Light> make_atmosphere_light(const LightSettings& settings,
                                             const LightContext& context) {
  const std::array<Vec3d, 3> axes = environment_axes(context.up, 0);
  const Vec3d to_sun = -unit_direction(settings.direction, "light.direction");
  const SkyImageKey key{air_of(settings, context.up), settings.irradiance, settings.color_space,
                        std::atan2(dot(axes[1], to_sun), dot(axes[0], to_sun)),
                        settings.metres_per_unit.has_value()};
  static LastMade<SkyImageKey, Image> last;
  const auto image = last.get(key, [&] { return sky_image(key, AirColors(settings)); });
  LightSettings sky = settings;
  sky.radiance = Rgb(1);
  sky.rotation = 0;
  return make_environment_image(*image, "atmosphere", sky, context);
}

std::unique_ptr<Light> make_sun_light(const LightSettings& settings, const LightContext& context) {
  const auto air = atmosphere_of(air_of(settings, context.up));
  return make_disc_light(unit_direction(settings.direction, "light.direction"),
                         AirColors(settings)(air->sun()), sun_radius_degrees, sun_limb,
                         context.region);
}

constexpr std::string_view atmosphere_keys[] = {
    "direction", "irradiance", "aerosol", "ground_albedo", "altitude", "sun", "metres_per_unit"};
constexpr std::string_view sun_keys[] = {"direction", "irradiance", "aerosol", "altitude"};

bool is_colored(const LightSettings&) {
  return true;
}

} // namespace

const LightKind atmosphere_light{.name = "atmosphere",
                                 .help = "the clear sky of a round earth with its sun",
                                 .keys = atmosphere_keys,
                                 .colored = is_colored,
                                 .surrounds = true,
                                 .complaint = direction_complaint,
                                 .make = make_atmosphere_light};

const LightKind sun_light{.name = "sun",
                          .help = "the sun of an atmosphere without its sky",
                          .keys = sun_keys,
                          .colored = is_colored,
                          .complaint = direction_complaint,
                          .make = make_sun_light};

} // namespace vdbeam
