#include "grids/emission_grid.h"

#include "text/curve.h"
#include "vdbeam/error.h"
#include "volume/blackbody.h"

#include <fmt/format.h>

#include <optional>

namespace vdbeam {

Rgb blackbody_emission(const EmissionSettings& settings, float value) {
  const double kelvin = settings.kelvin * static_cast<double>(value) + settings.kelvin_offset;
  if (!(value > 0) || !(kelvin > 0))
    return {};
  double brightness = 1;
  if (settings.law == EmissionLaw::planck)
    brightness = blackbody_luminance(kelvin, settings.reference);
  else if (settings.law == EmissionLaw::stefan_boltzmann)
    brightness = std::pow(kelvin / settings.reference, 4);
  constexpr double most = 1e30; // far from the end of single precision
  return Rgb(blackbody_color(kelvin, settings.color_space) * std::min(brightness, most));
}

namespace {

/// Colour of a value of the grid that determines it.
class ColorLaw {
public:
  explicit ColorLaw(const EmissionSettings& settings) : settings_(settings) {
    if (settings.ramp.empty())
      return;
    ramp_.emplace(settings.ramp, 3);
    to_working_space_ =
        rgb_matrix(chromaticities_of(ColorSpace::rec709), chromaticities_of(settings.color_space));
  }
  bool has_ramp() const { return ramp_.has_value(); }
  Rgb at(float value) const {
    if (!ramp_)
      return blackbody_emission(settings_, value);
    if (!(value > 0))
      return {};
    const auto x = static_cast<double>(value);
    return Rgb(to_working_space_.apply({ramp_->at(x, 0), ramp_->at(x, 1), ramp_->at(x, 2)}));
  }

private:
  const EmissionSettings& settings_;
  std::optional<Curve> ramp_;
  ColorMatrix to_working_space_;
};

} // namespace

EmissionGrid make_emission(const EmissionSettings& settings, const DensityGrid& intensity,
                           const DensityGrid& temperature, const std::string& label,
                           const FieldLimits& limits) {
  const bool intense = !settings.intensity.empty(), hot = !settings.temperature.empty();
  EmissionGrid result;
  for (const auto& [used, grid] : {std::pair(intense, &intensity), std::pair(hot, &temperature)})
    if (used) {
      result.active_voxels += grid->active_voxels;
      result.notes.insert(result.notes.end(), grid->notes.begin(), grid->notes.end());
    }
  const DensityGrid& shape = intense ? intensity : temperature;
  result.index_to_world = shape.index_to_world;
  if (shape.field.empty() || (intense && hot && temperature.field.empty()))
    return result;
  const bool uniform = !(intense && hot);
  if (const std::uint64_t bytes = EmissionField::bytes_of(shape.field, uniform);
      bytes > limits.bytes)
    throw FrameError(fmt::format("{}: its emission needs {:.2f} GiB as bricks, more than the limit "
                                 "of {:.2f} GiB",
                                 label, static_cast<double>(bytes) / (1 << 30),
                                 static_cast<double>(limits.bytes) / (1 << 30)));
  EmissionField::Law law;
  const ColorLaw color(settings);
  if (!hot && color.has_ramp())
    law = [&](float value, const Vec3f&) { return color.at(value); };
  else if (!hot)
    law = [](float value, const Vec3f&) { return Rgb(value); };
  else if (!intense)
    law = [&](float value, const Vec3f&) { return color.at(value); };
  else {
    Affine shift, back;
    shift.translation = Vec3d(shape.field.origin());
    back.translation = -Vec3d(temperature.field.origin());
    const Affine map =
        back.after(temperature.index_to_world.inverse()).after(shape.index_to_world).after(shift);
    law = [&color, &temperature, map](float value, const Vec3f& local) {
      const float degrees = temperature.field.sample(Vec3f(map.point(Vec3d(local))));
      return color.at(degrees) * value;
    };
  }
  auto field = std::make_shared<EmissionField>(shape.field, law, uniform, limits.stop);
  if (!field->empty())
    result.field = std::move(field);
  return result;
}

} // namespace vdbeam
