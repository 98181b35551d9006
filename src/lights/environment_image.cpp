#include "lights/environment_image.h"

#include "lights/distant_emission.h"
#include "lights/sphere_table.h"
#include "machine/stop_reading.h"
#include "math/affine.h"
#include "vdbeam/error.h"

#include <fmt/core.h>

#include <numbers>

namespace vdbeam {
namespace {

double luminance(const Rgb& c) {
  return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) +
         0.0722 * static_cast<double>(c.z);
}

constexpr float largest_half = 65504;
constexpr float largest_float = std::numeric_limits<float>::max();

/// Corrections of an image's values to make them radiance.
struct Mended {
  std::uint64_t infinite = 0, negative = 0, not_numbers = 0, too_bright = 0;

  /// Radiance as it can be used: a sun that overflowed its half floats is as bright as they go,
  /// anything else that is no radiance is none.
  float radiance(float value, float factor) {
    if (!(value >= 0)) {
      ++(std::isnan(value) ? not_numbers : negative);
      return 0;
    }
    if (value == infinity) {
      ++infinite;
      value = largest_half;
    }
    too_bright += factor > 1 && value > largest_float / factor;
    return std::min(value * factor, largest_float);
  }

  void add_notes(const std::string& name, std::vector<std::string>& notes) const {
    const auto add = [&](std::uint64_t count, const char* what) {
      if (count > 0)
        notes.push_back(fmt::format("light.image {}: {} {} {}", name, count,
                                    count == 1 ? "value" : "values", what));
    };
    add(infinite, "of infinity, taken for 65504, the largest half float: the light may lack power");
    add(negative, "below 0, taken for 0");
    add(not_numbers, "that are no numbers, taken for 0");
    add(too_bright, "too bright for single precision, taken for 3.4e38");
  }
};

/// Radiance over the sphere, in the image's own frame (z up, x where the turn is 0).
class RadianceMap {
public:
  RadianceMap(const Image& image, const std::string& name, const Rgb& factor)
      : width_(image.width), height_(image.height) {
    const ImageChannel* grey = image.find("Y");
    const ImageChannel* channels[3] = {image.find("R"), image.find("G"), image.find("B")};
    const std::size_t count = static_cast<std::size_t>(std::max(0, width_)) * std::max(0, height_);
    for (const ImageChannel*& channel : channels) {
      if (!channel)
        channel = grey;
      if (!channel || count == 0 || channel->data.size() != count)
        throw InputError(
            fmt::format("light.image {} must hold the channels R, G, B or Y; it lacks some", name));
    }
    pixels_.resize(count);
    const auto row = static_cast<std::size_t>(width_);
    for (std::size_t i = 0; i < count; ++i) {
      if (i % row == 0)
        StopReading::check();
      for (int c = 0; c < 3; ++c)
        pixels_[i][c] = mended_.radiance(channels[c]->data[i], factor[c]);
    }
  }

  const Mended& mended() const { return mended_; }
  int width() const { return width_; }
  int height() const { return height_; }

  /// Bilinear; the turn wraps around, the poles' rows extend to the poles.
  Rgb lookup(double theta_share, double turn) const {
    const double x = turn * width_ - 0.5, y = theta_share * height_ - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    const float fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const int i = static_cast<int>(x0), j = static_cast<int>(y0);
    const Rgb top = pixel(i, j) * (1 - fx) + pixel(i + 1, j) * fx;
    const Rgb bottom = pixel(i, j + 1) * (1 - fx) + pixel(i + 1, j + 1) * fx;
    return top * (1 - fy) + bottom * fy;
  }

  /// Luminance integrated over each pixel: the bilinear interpolant's mean has weights 1/8, 6/8,
  /// 1/8 each way, so it is positive wherever the interpolant is not 0 throughout.
  std::vector<double> pixel_integrals() const {
    std::vector<double> along(pixels_.size()), result(pixels_.size());
    for (int y = 0; y < height_; ++y) {
      StopReading::check();
      for (int x = 0; x < width_; ++x)
        along[offset(x, y)] = luminance(pixel(x - 1, y)) / 8 + luminance(pixel(x, y)) * 0.75 +
                              luminance(pixel(x + 1, y)) / 8;
    }
    for (int y = 0; y < height_; ++y) {
      StopReading::check();
      const double band =
          std::cos(std::numbers::pi * y / height_) - std::cos(std::numbers::pi * (y + 1) / height_);
      for (int x = 0; x < width_; ++x)
        result[offset(x, y)] =
            band * (along[offset(x, std::max(0, y - 1))] / 8 + along[offset(x, y)] * 0.75 +
                    along[offset(x, std::min(height_ - 1, y + 1))] / 8);
    }
    return result;
  }

private:
  std::size_t offset(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }
  const Rgb& pixel(int x, int y) const {
    const int wrapped = x < 0 ? x + width_ : (x >= width_ ? x - width_ : x);
    return pixels_[offset(wrapped, std::clamp(y, 0, height_ - 1))];
  }

  int width_, height_;
  std::vector<Rgb> pixels_;
  Mended mended_;
};

class EnvironmentImage final : public Light {
public:
  EnvironmentImage(const Image& image, const std::string& name, const LightSettings& settings,
                   const LightContext& context)
      : map_(image, name, settings.radiance),
        table_(map_.pixel_integrals(), map_.width(), map_.height()),
        axes_(environment_axes(context.up, settings.rotation)), boxes_(context.region.boxes) {
    power_ = estimate_power(*this);
    if (context.notes)
      map_.mended().add_notes(name, *context.notes);
  }

  IncidentSample sample_incident(const Vec3f&, float u, float v) const override {
    const Drawn drawn = draw(u, v);
    return {drawn.direction, infinity, drawn.value, drawn.pdf};
  }
  float incident_pdf(const Vec3f&, const Vec3f& wi) const override {
    const Place place = locate(wi);
    return table_.pdf(place.theta_share, place.turn);
  }
  LightHit emitted_radiance(const Segment& segment) const override {
    if (segment.t_end < infinity)
      return {};
    const Place place = locate(segment.ray.direction);
    return {map_.lookup(place.theta_share, place.turn)};
  }
  EmittedPhoton emit(double place, Rng& rng) const override {
    return emit_from_all_around(boxes_, place, rng,
                                [this](float u, float v) { return draw(u, v); });
  }
  Rgb power() const override { return power_; }
  bool is_delta() const override { return false; }

private:
  struct Place {
    double theta_share, turn;
  };
  struct Drawn {
    Vec3f direction; ///< towards the light
    Rgb value;       ///< radiance / pdf
    float pdf;
  };

  Place locate(const Vec3f& direction) const {
    const Vec3d d(direction);
    const double x = dot(axes_[0], d), y = dot(axes_[1], d), z = dot(axes_[2], d);
    const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
    return {std::atan2(std::sqrt(x * x + y * y), z) / std::numbers::pi, turn < 0 ? turn + 1 : turn};
  }
  Drawn draw(float u, float v) const {
    const SphereTable::Sample s = table_.sample(u, v);
    if (!(s.pdf > 0))
      return {Vec3f(axes_[2]), {}, 0};
    const double sin_theta = std::sqrt(std::max(0.0, 1 - s.cos_theta * s.cos_theta));
    const double phi = 2 * std::numbers::pi * s.turn;
    const Vec3d d = axes_[0] * (sin_theta * std::cos(phi)) +
                    axes_[1] * (sin_theta * std::sin(phi)) + axes_[2] * s.cos_theta;
    const double theta_share = std::atan2(sin_theta, s.cos_theta) / std::numbers::pi;
    return {Vec3f(d), map_.lookup(theta_share, s.turn) / s.pdf, s.pdf};
  }

  RadianceMap map_;
  SphereTable table_;
  std::array<Vec3d, 3> axes_;
  EntrySampler boxes_;
  Rgb power_;
};

} // namespace

std::array<Vec3d, 3> environment_axes(const Vec3d& up_setting, double rotation_degrees) {
  const Vec3d up = unit_direction(up_setting, "camera.up");
  // The smallest rotation that takes +y to `up`, applied to +x and +z (Rodrigues, axis y x up).
  const Vec3d y{0, 1, 0};
  const auto turned = [&](const Vec3d& a) {
    if (up.y < -1 + 1e-9) // opposite: half a turn about x
      return Vec3d{a.x, -a.y, -a.z};
    const Vec3d axis = cross(y, up);
    return a * up.y + cross(axis, a) + axis * (dot(axis, a) / (1 + up.y));
  };
  const double angle = rotation_degrees * (std::numbers::pi / 180);
  const auto spun = [&](const Vec3d& a) { // a is perpendicular to up
    return a * std::cos(angle) + cross(up, a) * std::sin(angle);
  };
  // The turn runs from left to right: it is 0 at -z, 1/4 at +x, 1/2 at +z, 3/4 at -x.
  return {spun(turned({0, 0, -1})), spun(turned({1, 0, 0})), up};
}

std::unique_ptr<Light> make_environment_image(const Image& image, const std::string& name,
                                              const LightSettings& settings,
                                              const LightContext& context) {
  return std::make_unique<EnvironmentImage>(image, name, settings, context);
}

} // namespace vdbeam
