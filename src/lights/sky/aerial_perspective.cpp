#include "lights/sky/aerial_perspective.h"

#include "lights/environment_image.h"
#include "lights/sky/air_colors.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <mutex>
#include <numbers>

namespace vdbeam {
namespace {

/// Least transmittance that counts as more than 0.
constexpr double least_left = 1e-12;

} // namespace

/// Rows by elevation, densest at the horizon, as those of the sky; columns by azimuth from the sun.
struct AerialPerspective::Tables {
  /// What the tables depend on.
  struct Key {
    AirSettings air;
    Rgb irradiance;
    ColorSpace space = ColorSpace::rec709;

    friend bool operator==(const Key&, const Key&) = default;
  };

  Tables(const Key& key_, const AirColors& color)
      : key(key_), air(atmosphere_of(key_.air)), depths(static_cast<std::size_t>(rows) * knots),
        sources(static_cast<std::size_t>(rows) * columns * knots) {
    tbb::parallel_for(0, rows, [&](int row) { fill(row, color); });
  }

  static double elevation(int row) {
    const double v = 2 * (row + 0.5) / rows - 1;
    return std::copysign(v * v, v) * std::numbers::pi / 2;
  }
  static std::size_t offset(int row, int column) {
    return (static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column)) * knots;
  }

  void fill(int row, const AirColors& color) {
    const double length = air->length_in_air(elevation(row));
    std::array<double, knots - 1> distances{};
    for (int k = 1; k < knots; ++k)
      distances[static_cast<std::size_t>(k - 1)] = length * std::pow(k / (knots - 1.0), 3);
    std::array<Atmosphere::Between, knots - 1> between{};
    const Vec3d white = color.rgb(air->unfiltered());
    Rgb* depth = &depths[static_cast<std::size_t>(row) * knots];
    for (int column = 0; column < columns; ++column) {
      air->between(elevation(row), std::numbers::pi * column / (columns - 1), distances, between);
      Rgb* source = &sources[offset(row, column)];
      for (std::size_t k = 1; k < knots; ++k) {
        const Vec3d left = color.rgb(between[k - 1].left);
        const Rgb light = color(between[k - 1].light);
        for (int c = 0; c < 3; ++c) {
          const double share = std::clamp(left[c] / white[c], least_left, 1.0);
          depth[k][c] = static_cast<float>(-std::log(share) / distances[k - 1]);
          source[k][c] =
              share < 1 ? static_cast<float>(static_cast<double>(light[c]) / (1 - share)) : 0.0f;
        }
      }
      source[0] = source[1];
    }
    depth[0] = depth[1];
  }

  Key key;
  std::shared_ptr<const Atmosphere> air;
  std::vector<Rgb> depths;  ///< [row][knot]
  std::vector<Rgb> sources; ///< [row][column][knot]
};

AerialPerspective::AerialPerspective(const LightSettings& settings, const Vec3d& up,
                                     const RenderSpace& space)
    : axes_(environment_axes(up, 0)), metres_(*settings.metres_per_unit / space.scale) {
  const Vec3d to_sun = -unit_direction(settings.direction, "light.direction");
  sun_turn_ = std::atan2(dot(axes_[1], to_sun), dot(axes_[0], to_sun));
  const Tables::Key key{air_of(settings, up), settings.irradiance, settings.color_space};
  static std::mutex mutex;
  static std::shared_ptr<const Tables> last;
  const std::scoped_lock lock(mutex);
  if (!last || !(last->key == key)) // a thread that waits must take no task that waits for the lock
    tbb::this_task_arena::isolate(
        [&] { last = std::make_shared<const Tables>(key, AirColors(settings)); });
  tables_ = last;
}

RayAir AerialPerspective::along(const Vec3d& direction, double shift) const {
  const double elevation = std::asin(std::clamp(dot(direction, axes_[2]), -1.0, 1.0));
  const double azimuth = std::atan2(dot(direction, axes_[1]), dot(direction, axes_[0])) - sun_turn_;
  const auto split = [](double place, int size, float& rest) {
    const double inside = std::clamp(place, 0.0, size - 1.0);
    const int first = std::min(static_cast<int>(inside), size - 2);
    rest = static_cast<float>(inside - first);
    return first;
  };
  const double v =
      std::copysign(std::sqrt(std::abs(elevation) / (std::numbers::pi / 2)), elevation);
  float down = 0, across = 0;
  const int row = split((v + 1) / 2 * rows - 0.5, rows, down);
  const int column = split(std::abs(std::remainder(azimuth, 2 * std::numbers::pi)) /
                               std::numbers::pi * (columns - 1),
                           columns, across);
  RayAir::Table table;
  table.knots = knots;
  table.length = tables_->air->length_in_air(elevation);
  table.metres = metres_;
  table.shift = shift;
  for (int i = 0; i < RayAir::columns; ++i) {
    const int r = row + i / 2, c = column + i % 2;
    table.column[i] = {&tables_->depths[static_cast<std::size_t>(r) * knots],
                       &tables_->sources[Tables::offset(r, c)],
                       (i / 2 ? down : 1 - down) * (i % 2 ? across : 1 - across)};
  }
  return RayAir(table);
}

int light_with_air(const std::vector<LightSettings>& lights) {
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (lights[i].type == LightType::atmosphere && lights[i].metres_per_unit)
      return static_cast<int>(i);
  return -1;
}

std::vector<LightSettings> lights_at_camera(const Scene& scene) {
  std::vector<LightSettings> lights = scene.lights;
  const CameraSettings& camera = scene.camera;
  for (LightSettings& light : lights) {
    if (!light.metres_per_unit)
      continue;
    const double height =
        dot(camera.position, unit_direction(camera.up, "camera.up")) * *light.metres_per_unit;
    const double altitude = std::clamp(light.altitude + height, 1.0, 50e3);
    const double step = std::max(1.0, std::exp2(std::floor(std::log2(altitude))) / 64);
    light.altitude = std::round(altitude / step) * step;
  }
  return lights;
}

} // namespace vdbeam
