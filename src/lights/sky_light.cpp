#include "lights/distant_emission.h"
#include "lights/light_table.h"
#include "math/color.h"
#include "math/sampling.h"

#include <array>
#include <numbers>

namespace vdbeam {
namespace {

double mean(const Rgb& c) {
  return (static_cast<double>(c.x) + static_cast<double>(c.y) + static_cast<double>(c.z)) / 3;
}

/// A clear sky whose radiance depends on the elevation alone: from the horizon it falls off towards
/// the zenith, and a band of haze leads to the ground below.
class SkyLight final : public Light {
public:
  SkyLight(const LightSettings& settings, const LightContext& context)
      : up_(unit_direction(context.up, "camera.up")),
        horizon_(settings.radiance * settings.horizon),
        zenith_(settings.radiance * settings.zenith), ground_(settings.radiance * settings.ground),
        boxes_(context.region.boxes) {
    make_table();
    power_ = estimate_power(*this);
  }

  IncidentSample sample_incident(const Vec3f&, float u, float v) const override {
    const Drawn drawn = draw(u, v);
    return {drawn.direction, infinity, drawn.value, drawn.pdf};
  }
  float incident_pdf(const Vec3f&, const Vec3f& wi) const override {
    return bins_[bin_of(sine(wi))].pdf;
  }
  LightHit emitted_radiance(const Segment& segment) const override {
    return {segment.t_end == infinity ? radiance(sine(segment.ray.direction)) : Rgb()};
  }
  EmittedPhoton emit(double place, Rng& rng) const override {
    return emit_from_all_around(boxes_, place, rng,
                                [this](float u, float v) { return draw(u, v); });
  }
  Rgb power() const override { return power_; }
  bool is_delta() const override { return false; }

private:
  static constexpr int bin_count = 256;

  /// Equal steps of the elevation's sine, hence equal solid angles.
  struct Bin {
    float begin_share = 0; ///< of all samples, those in the bins before
    float pdf = 0;         ///< per solid angle
  };
  struct Drawn {
    Vec3f direction; ///< towards the light
    Rgb value;       ///< radiance / pdf
    float pdf;
  };

  double sine(const Vec3f& direction) const { return dot(up_, Vec3d(direction)); }

  Rgb radiance(double sine) const {
    const double x = std::clamp(sine, -1.0, 1.0);
    if (x >= 0) {
      const auto haze = static_cast<float>(std::pow(1 - x, 5));
      return zenith_ + (horizon_ - zenith_) * haze;
    }
    constexpr double band = 0.25; // about 14 degrees
    const double rest = std::max(0.0, 1 + x / band);
    return ground_ + (horizon_ - ground_) * static_cast<float>(rest * rest);
  }

  static int bin_of(double sine) {
    return std::clamp(static_cast<int>((sine + 1) * (bin_count / 2)), 0, bin_count - 1);
  }

  void make_table() {
    std::array<double, bin_count> weights{};
    double sum = 0;
    for (int i = 0; i < bin_count; ++i) {
      const double low = 2.0 * i / bin_count - 1, width = 2.0 / bin_count;
      // Simpson's rule; a bin's ends are in it, so that no bin is 0 where its radiance is not.
      sum += weights[static_cast<std::size_t>(i)] =
          (mean(radiance(low)) + 4 * mean(radiance(low + width / 2)) +
           mean(radiance(low + width))) /
          6;
    }
    if (!(sum > 0))
      return;
    double before = 0;
    for (std::size_t i = 0; i < bin_count; ++i) {
      bins_[i].begin_share = static_cast<float>(before / sum);
      bins_[i].pdf = static_cast<float>(weights[i] / sum * bin_count / (4 * std::numbers::pi));
      before += weights[i];
    }
    dark_ = false;
  }

  Drawn draw(float u, float v) const {
    if (dark_)
      return {Vec3f(up_), {}, 0};
    auto bin = std::upper_bound(bins_.begin(), bins_.end(), u,
                                [](float x, const Bin& b) { return x < b.begin_share; }) -
               1;
    while (!(bin->pdf > 0)) // rounding may end in a bin that is never drawn
      bin = bin == bins_.begin() ? bins_.end() - 1 : bin - 1;
    const double share = static_cast<double>(bin->pdf) * 4 * std::numbers::pi / bin_count;
    const double within = std::clamp((static_cast<double>(u) - bin->begin_share) / share, 0.0, 1.0);
    const double x = 2 * (static_cast<double>(bin - bins_.begin()) + within) / bin_count - 1;
    const double radius = std::sqrt(std::max(0.0, 1 - x * x));
    const double angle = 2 * std::numbers::pi * static_cast<double>(v);
    Vec3d side, front;
    orthonormal_frame(up_, side, front);
    const Vec3d d = up_ * x + (side * std::cos(angle) + front * std::sin(angle)) * radius;
    return {Vec3f(d), radiance(x) / bin->pdf, bin->pdf};
  }

  Vec3d up_;
  Rgb horizon_, zenith_, ground_;
  EntrySampler boxes_;
  std::array<Bin, bin_count> bins_{};
  Rgb power_;
  bool dark_ = true;
};

constexpr std::string_view sky_keys[] = {"radiance", "zenith", "horizon", "ground"};

} // namespace

const LightKind sky_light{.name = "sky",
                          .help = "a gradient of zenith, horizon and ground radiance",
                          .keys = sky_keys,
                          .colored =
                              [](const LightSettings& light) {
                                return !is_grey(light.radiance) || !is_grey(light.zenith) ||
                                       !is_grey(light.horizon) || !is_grey(light.ground);
                              },
                          .surrounds = true,
                          .wants_shadow_rays = [](const LightSettings&) { return false; },
                          .make = [](const LightSettings& settings,
                                     const LightContext& context) -> std::unique_ptr<Light> {
                            return std::make_unique<SkyLight>(settings, context);
                          }};

} // namespace vdbeam
