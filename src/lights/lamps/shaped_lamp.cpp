#include "lights/lamps/shaped_lamp.h"

#include "image/texture.h"
#include "lights/lamps/direction_table.h"
#include "lights/lamps/ies_profile.h"
#include "lights/lamps/spot_cone.h"
#include "lights/light_table.h"

#include <optional>

namespace vdbeam {
namespace {

/// How a lamp's intensity depends on direction. Its files are shared by copies.
class LampShape {
public:
  LampShape(const LightSettings& settings, const LightContext& context, const LampShape* same)
      : axis_(unit_direction(settings.direction, "light.direction")) {
    turn(unit_direction(context.up, "camera.up"), settings.rotation);
    if (settings.type == LightType::spot)
      cone_.emplace(settings);
    if (!settings.ies.empty())
      profile_ = same ? same->profile_
                      : std::make_shared<const IesProfile>(read_ies_profile(settings.ies));
    if (!settings.image.empty()) {
      slide_ = same ? same->slide_ : read_slide(settings, context);
      // The shorter side spans the cone.
      const double shorter = std::min(slide_->width(), slide_->height());
      const double tangent = std::tan(settings.cone_angle * (std::numbers::pi / 180));
      half_width_ = tangent * slide_->width() / shorter;
      half_height_ = tangent * slide_->height() / shorter;
    }
  }

  const std::optional<SpotCone>& cone() const { return cone_; }
  const Vec3d& axis() const { return axis_; }

  Vec3d at(const Vec3d& direction) const {
    const double lit = without_slide(direction);
    if (!slide_ || !(lit > 0))
      return Vec3d(lit);
    const double along = dot(direction, axis_); // > 0 in the cone
    const Uv uv{static_cast<float>(0.5 + 0.5 * dot(direction, right_) / along / half_width_),
                static_cast<float>(0.5 + 0.5 * dot(direction, top_) / along / half_height_)};
    return Vec3d(slide_->at(uv)) * lit;
  }

  /// Over all directions, without the image [sr].
  double integral() const {
    if (!profile_)
      return cone_->integral();
    if (!cone_)
      return profile_->integral();
    constexpr int rings = 1024, sectors = 256;
    const int around = profile_->is_round() ? 1 : sectors;
    double sum = 0;
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < around; ++j)
        sum += without_slide(cone_->outer().sample((i + 0.5) / rings, (j + 0.5) / around));
    return sum / rings / around * cone_->outer().solid_angle();
  }

private:
  void turn(const Vec3d& up, double degrees) {
    constexpr double parallel = 1e-6;
    Vec3d right = cross(axis_, up);
    if (!(length(right) > parallel))
      right = cross(axis_, {0, 0, 1});
    if (!(length(right) > parallel))
      right = cross(axis_, {0, 1, 0});
    right = normalize(right);
    const Vec3d top = cross(right, axis_);
    const double angle = degrees * (std::numbers::pi / 180);
    right_ = right * std::cos(angle) + top * std::sin(angle);
    top_ = top * std::cos(angle) - right * std::sin(angle);
  }

  static std::shared_ptr<const Texture> read_slide(const LightSettings& settings,
                                                   const LightContext& context) {
    MaterialSettings slide;
    slide.texture = settings.image;
    slide.texture_wrap = TextureWrap::clamp;
    slide.color_space = settings.color_space;
    std::vector<std::string> unread;
    return std::make_shared<const Texture>(
        read_texture(slide, true, context.notes ? *context.notes : unread));
  }

  double without_slide(const Vec3d& direction) const {
    const double lit = cone_ ? cone_->share(direction) : 1;
    if (!profile_ || !(lit > 0))
      return lit;
    constexpr double degrees = 180 / std::numbers::pi;
    const double x = dot(direction, right_), y = dot(direction, top_);
    const double horizontal = std::atan2(y, x) * degrees;
    const double vertical = std::atan2(std::sqrt(x * x + y * y), dot(direction, axis_)) * degrees;
    return lit * profile_->at(vertical, horizontal < 0 ? horizontal + 360 : horizontal);
  }

  Vec3d axis_, right_, top_;
  std::optional<SpotCone> cone_;
  std::shared_ptr<const IesProfile> profile_;
  std::shared_ptr<const Texture> slide_;
  double half_width_ = 1, half_height_ = 1; ///< of the image at distance 1
};

class ShapedLamp final : public LocalLight {
public:
  ShapedLamp(const LightSettings& settings, const LightContext& context, LampShape shape)
      : LocalLight(settings, context, cone_of(settings, context, shape)), shape_(std::move(shape)),
        table_(emission_cone(),
               [this](const Vec3d& direction) { return mean_component(shape_.at(direction)); }) {
    power_ = estimate_power(*this);
  }

  const LampShape& shape() const { return shape_; }
  Rgb power() const override { return power_; }
  Segment lit_part(const Segment& segment) const override {
    return shape_.cone() ? part_within(shape_.cone()->outer(), *position(), segment) : segment;
  }

private:
  static Cone cone_of(const LightSettings& settings, const LightContext& context,
                      const LampShape& shape) {
    Cone cone = cone_towards(render_position(settings, context), context.region);
    if (cone.one_minus_cos >= 2)
      cone.axis = shape.axis();
    return shape.cone() ? narrower(shape.cone()->outer(), cone) : cone;
  }
  Vec3d share(const Vec3d& direction) const override { return shape_.at(direction); }
  Drawn draw(double place, float v) const override {
    const DirectionTable::Sample sample = table_.sample(place, static_cast<double>(v));
    return {sample.direction, sample.solid_angle};
  }

  LampShape shape_;
  DirectionTable table_;
  Rgb power_;
};

} // namespace

bool is_shaped(const LightSettings& settings) {
  return !settings.ies.empty() || (settings.type == LightType::spot && !settings.image.empty());
}

std::unique_ptr<Light> make_shaped_lamp(const LightSettings& settings,
                                        const LightContext& context) {
  const auto* same = dynamic_cast<const ShapedLamp*>(context.other);
  LampShape shape(settings, context, same ? &same->shape() : nullptr);
  LightSettings lamp = settings;
  if (settings.power)
    lamp.intensity = Rgb(Vec3d(*settings.power) / shape.integral());
  return std::make_unique<ShapedLamp>(lamp, context, std::move(shape));
}

} // namespace vdbeam
