#include "film/film.h"

#include "film/cryptomatte.h"
#include "film/film_blocks.h"
#include "layers/plane_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// The channels of every image, in their order.
enum Channel : std::size_t {
  rgb = 0,
  alpha = 3,
  volume = 4,
  volume_alpha = 7,
  direct = 8,
  indirect = 11,
  depth = 14,
  emission = 15 ///< where something glows
};

/// An image with these channels, and room for them.
Image make_image(int width, int height, bool glows) {
  Image image;
  image.width = width;
  image.height = height;
  // Blender reads a layer's channel only where its last part is one of R G B A X Y Z V U.
  for (const char* name : {"R", "G", "B", "A", "volume.R", "volume.G", "volume.B", "volume.A",
                           "volume_direct.R", "volume_direct.G", "volume_direct.B",
                           "volume_indirect.R", "volume_indirect.G", "volume_indirect.B"})
    image.channels.push_back({name, {}});
  image.channels.push_back({"depth.Z", {}, false});
  if (glows)
    for (const char* name : {"volume_emission.R", "volume_emission.G", "volume_emission.B"})
      image.channels.push_back({name, {}});
  // New memory costs more time than what is done with it, so all threads share that.
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  tbb::parallel_for(std::size_t{0}, image.channels.size(),
                    [&](std::size_t c) { image.channels[c].data.resize(pixels); });
  return image;
}

} // namespace

Image Film::develop() const {
  Image image = make_image(width_, height_, glows_);
  const double passes = std::max(passes_, 1);
  for_each_block(pixels(), [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto set = [&](std::size_t channel, std::size_t i, double sum, double count) {
      image.channels[channel].data[i] = static_cast<float>(sum / count);
    };
    for (std::size_t i = begin; i < end; ++i) {
      // The high parts are the correctly rounded sums.
      for (std::size_t c = 0; c < 3; ++c) {
        set(direct + c, i, direct_.high(3 * i + c), passes);
        set(indirect + c, i, indirect_.high(3 * i + c), passes);
        set(volume + c, i, sum(3 * i + c, false), passes);
        set(rgb + c, i, sum(3 * i + c, true), passes);
        if (glows_)
          set(emission + c, i, emission_.high(3 * i + c), passes);
      }
      set(alpha, i, opacity_.high(i), passes);
      set(volume_alpha, i, opacity_.high(i), passes);
      if (opacity_.high(i) > 0)
        set(depth, i, depth_.high(i), opacity_.high(i));
      else
        image.channels[depth].data[i] = empty_depth;
    }
  });
  develop_parts(passes, image);
  return image;
}

/// Adds the channels of light groups, of the planes that layers ask for, and of objects.
void Film::develop_parts(double passes, Image& image) const {
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<float> data(pixels());
      for (std::size_t i = 0; i < data.size(); ++i)
        data[i] = static_cast<float>(groups_[g].high(3 * i + c) / passes);
      image.channels.push_back(
          {fmt::format("light_{}.{}", group_names_[g], "RGB"[c]), std::move(data)});
    }
  for (std::size_t i = 0; i < planes_.size(); ++i)
    image.channels.push_back(
        {plane_names_[i], develop_plane(i), plane_layer_of(plane_names_[i]).half});
  if (!object_names_.empty())
    add_cryptomatte(
        object_names_,
        [&](std::size_t object, std::size_t pixel) {
          return static_cast<float>(std::min(1.0, coverage_[object].high(pixel) / passes));
        },
        image);
}

std::vector<float> Film::develop_plane(std::size_t plane) const {
  const PlaneLayer& layer = plane_layer_of(plane_names_[plane]);
  std::vector<float> data(pixels(), layer.empty);
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double weight = layer.of_opacity ? opacity_.high(i) : std::max(passes_, 1);
    if (weight > 0)
      data[i] = static_cast<float>(planes_[plane].high(i) / weight);
  }
  return data;
}

std::optional<DeepImage> Film::develop_deep() const {
  if (!deep_)
    return std::nullopt;
  return deep_->develop(passes_, width_, height_);
}

void Film::add_layer(const std::string& name, Image& image) const {
  const double n = std::max(passes_, 1);
  const auto add = [&](const std::string& channel, bool half, const auto& value) {
    std::vector<float> data(pixels());
    for (std::size_t i = 0; i < data.size(); ++i)
      data[i] = static_cast<float>(value(i));
    image.channels.push_back({name + "." + channel, std::move(data), half});
  };
  if (name == "transmittance")
    add("Y", true, [&](std::size_t i) { return 1 - opacity_.high(i) / n; });
  if (name == "samples")
    add("Y", false, [&](std::size_t) { return passes_; });
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string channel(1, "RGB"[c]);
    if (name == "background")
      add(channel, true, [&](std::size_t i) { return background_.high(3 * i + c) / n; });
    const auto variance = [&](std::size_t i) {
      const double mean = sum(3 * i + c, true) / n;
      return passes_ < 2
                 ? 0.0
                 : std::max(0.0, squares_.high(3 * i + c) - n * mean * mean) / (n * (n - 1));
    };
    if (name == "variance")
      add(channel, false, variance);
    if (name == "error")
      add(channel, false, [&](std::size_t i) { return std::sqrt(variance(i)); });
  }
}

} // namespace vdbeam
