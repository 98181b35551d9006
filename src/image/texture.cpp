#include "image/texture.h"

#include "image/color_conversion.h"
#include "image/srgb.h"
#include "machine/stop_reading.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

constexpr float largest_half = 65504;
/// Leaves room for factors in single precision.
constexpr float largest_radiance = 1e30f;

/// Replaces values that no matrix can convert; how many there were.
std::size_t make_finite(Image& image) {
  std::size_t count = 0;
  for (ImageChannel& channel : image.channels)
    for (float& value : channel.data)
      if (!std::isfinite(value)) {
        value = value > 0 ? largest_half : 0;
        ++count;
      }
  return count;
}

void add_note(std::vector<std::string>& notes, const std::string& name, std::size_t count,
              const std::string& what) {
  if (count > 0)
    notes.push_back(
        fmt::format("texture {}: {} {} {}", name, count, count == 1 ? "value" : "values", what));
}

} // namespace

Texture::Texture(const Image& image, TextureWrap wrap, float largest, const std::string& name,
                 std::vector<std::string>& notes)
    : width_(image.width), height_(image.height), wrap_(wrap) {
  const std::size_t count = static_cast<std::size_t>(std::max(0, width_)) *
                            static_cast<std::size_t>(std::max(0, height_));
  const ImageChannel* channels[3] = {image.find("R"), image.find("G"), image.find("B")};
  for (const ImageChannel* channel : channels)
    if (!channel || count == 0 || channel->data.size() != count)
      throw InputError(
          fmt::format("texture {} must hold the channels R, G, B or Y; it lacks some", name));
  texels_.resize(count);
  std::size_t negative = 0, large = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = channels[c]->data[i];
      negative += value < 0;
      large += value > largest;
      texels_[i][c] = value > 0 ? std::min(value, largest) : 0;
    }
  add_note(notes, name, negative, "below 0, taken for 0");
  add_note(notes, name, large, fmt::format("above {:.6g}, taken for that", largest));
}

int Texture::wrapped(int i, int size) const {
  if (wrap_ == TextureWrap::clamp)
    return std::clamp(i, 0, size - 1);
  const int period = wrap_ == TextureWrap::mirror ? 2 * size : size;
  const int r = i % period, from_start = r < 0 ? r + period : r;
  return from_start < size ? from_start : period - 1 - from_start;
}

std::pair<float, float> Texture::range(int channel) const {
  const auto [least, most] =
      std::minmax_element(texels_.begin(), texels_.end(), [channel](const Rgb& a, const Rgb& b) {
        return a[channel] < b[channel];
      });
  return {(*least)[channel], (*most)[channel]};
}

Rgb Texture::at(const Uv& uv) const {
  const auto share = [](float x) {
    constexpr double most = 1e6; // beyond, a picture repeats too often to be one
    return std::isfinite(x) ? std::clamp(static_cast<double>(x), -most, most) : 0.0;
  };
  // In the picture rows go down. Of a mirrored one two make a period.
  const auto place = [&](double x, int size) {
    const double whole = wrap_ == TextureWrap::clamp    ? 0
                         : wrap_ == TextureWrap::mirror ? 2 * std::floor(x / 2)
                                                        : std::floor(x);
    const double limited = wrap_ == TextureWrap::clamp ? std::clamp(x, 0.0, 1.0) : x - whole;
    return limited * size - 0.5;
  };
  const double x = place(share(uv.u), width_), y = place(1 - share(uv.v), height_);
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const int i = static_cast<int>(x0), j = static_cast<int>(y0);
  const Rgb top = texel(i, j) * (1 - fx) + texel(i + 1, j) * fx;
  const Rgb bottom = texel(i, j + 1) * (1 - fx) + texel(i + 1, j + 1) * fx;
  return top * (1 - fy) + bottom * fy;
}

Texture make_texture(Image image, const std::string& name, const MaterialSettings& material,
                     bool shines, std::vector<std::string>& notes) {
  StopReading::check();
  add_note(notes, name, make_finite(image),
           "that are infinite, taken for 65504, or no numbers, taken for 0");
  convert_colors(image, chromaticities_of(material.color_space));
  StopReading::check();
  return {image, material.texture_wrap, shines ? largest_radiance : 1, name, notes};
}

Texture make_data_texture(Image image, const std::string& name, const DataKind& kind,
                          std::vector<std::string>& notes) {
  StopReading::check();
  add_note(notes, name, make_finite(image),
           "that are infinite, taken for 65504, or no numbers, taken for 0");
  const ImageChannel* alpha = kind.use == TextureUse::opacity ? image.find("A") : nullptr;
  const std::vector<float> opacity = alpha ? alpha->data : std::vector<float>();
  for (ImageChannel& channel : image.channels) {
    if (alpha)
      channel.data = opacity;
    else if (kind.alpha_only)
      std::fill(channel.data.begin(), channel.data.end(), 1.0f);
    else if (kind.encoded && channel.name != "A")
      for (float& value : channel.data)
        value = static_cast<float>(srgb_of_light(std::clamp(static_cast<double>(value), 0.0, 1.0)));
  }
  StopReading::check();
  return {image, kind.wrap, 1, name, notes};
}

Texture read_texture(const MaterialSettings& material, bool shines,
                     std::vector<std::string>& notes) {
  return make_texture(read_image(material.texture), material.texture, material, shines, notes);
}

} // namespace vdbeam
