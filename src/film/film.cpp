#include "film/film.h"

#include "estimators/plane_layers.h"
#include "film/cryptomatte.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace vdbeam {
namespace {

/// Pixels of one task. Sums over the image are sums of blocks in order, whatever the threads.
constexpr std::size_t block_size = 4096;

template <class Body>
void for_each_block(std::size_t pixels, const Body& body) {
  tbb::parallel_for(std::size_t{0}, (pixels + block_size - 1) / block_size, [&](std::size_t block) {
    body(block, block * block_size, std::min(pixels, (block + 1) * block_size));
  });
}

static_assert(sizeof(Rgb) == 3 * sizeof(float));
const float* components(const std::vector<Rgb>& colours) {
  return reinterpret_cast<const float*>(colours.data());
}

/// Adds values [begin, end), of one block, and returns how many were not finite.
std::uint64_t add_values(CompensatedSums& sums, const float* values, std::size_t begin,
                         std::size_t end) {
  std::uint32_t finite = 0;
  for (std::size_t i = begin; i < end; ++i) {
    finite += is_finite(values[i]);
    sums.add(i, finite_or_zero(values[i]));
  }
  return end - begin - finite;
}

void merge_values(CompensatedSums& sums, const CompensatedSums& other, std::size_t begin,
                  std::size_t end) {
  for (std::size_t i = begin; i < end; ++i)
    sums.merge(i, other);
}

} // namespace

Film::Film(int width, int height, bool glows, std::vector<std::string> groups,
           std::optional<DeepFilm> deep, std::vector<std::string> objects,
           std::vector<std::string> planes)
    : width_(width), height_(height), glows_(glows), direct_(3 * pixels()), indirect_(3 * pixels()),
      background_(3 * pixels()), emission_(glows ? 3 * pixels() : 0), opacity_(pixels()),
      depth_(pixels()), group_names_(std::move(groups)),
      groups_(group_names_.size(), CompensatedSums(3 * pixels())),
      object_names_(std::move(objects)), coverage_(object_names_.size(), CompensatedSums(pixels())),
      plane_names_(std::move(planes)), planes_(plane_names_.size(), CompensatedSums(pixels())),
      squares_(3 * pixels()), deep_(std::move(deep)), history_(width, height) {}

void Film::check_size(int width, int height) const {
  if (width != width_ || height != height_)
    throw std::invalid_argument(fmt::format("a film of {} x {} pixels cannot take {} x {}", width_,
                                            height_, width, height));
}

std::uint64_t Film::add_pixels(const PassImage& pass, std::size_t begin, std::size_t end) {
  const float* direct = components(pass.direct);
  const float* indirect = components(pass.indirect);
  const float* background = components(pass.background);
  const float* emission = glows_ && !pass.emission.empty() ? components(pass.emission) : nullptr;
  std::uint64_t invalid = add_values(direct_, direct, 3 * begin, 3 * end);
  invalid += add_values(indirect_, indirect, 3 * begin, 3 * end);
  invalid += add_values(background_, background, 3 * begin, 3 * end);
  if (emission)
    invalid += add_values(emission_, emission, 3 * begin, 3 * end);
  for (std::size_t g = 0; g < groups_.size() && g < pass.groups.size(); ++g)
    add_values(groups_[g], components(pass.groups[g]), 3 * begin, 3 * end);
  for (std::size_t i = 0; i < coverage_.size() && i < pass.coverage.size(); ++i)
    add_values(coverage_[i], pass.coverage[i].data(), begin, end);
  for (std::size_t i = 0; i < planes_.size() && i < pass.planes.size(); ++i)
    invalid += add_values(planes_[i], pass.planes[i].data(), begin, end);
  invalid += add_values(opacity_, pass.opacity.data(), begin, end);
  invalid += add_values(depth_, pass.depth.data(), begin, end);
  for (std::size_t i = 3 * begin; i < 3 * end; ++i) {
    const double total = double{finite_or_zero(direct[i])} + finite_or_zero(indirect[i]) +
                         finite_or_zero(background[i]) +
                         (emission ? finite_or_zero(emission[i]) : 0);
    squares_[i] += total * total;
  }
  return invalid;
}

void Film::add(const PassImage& pass, const std::vector<PixelValue>& probes) {
  check_size(pass.width, pass.height);
  std::vector<std::uint64_t> invalid((pixels() + block_size - 1) / block_size);
  for_each_block(pixels(), [&](std::size_t block, std::size_t begin, std::size_t end) {
    invalid[block] = add_pixels(pass, begin, end);
  });
  invalid_values_ = std::accumulate(invalid.begin(), invalid.end(), invalid_values_);
  if (deep_)
    deep_->add(pass);
  history_.add(pass, probes);
  ++passes_;
}

void Film::merge(const Film& other) {
  check_size(other.width_, other.height_);
  if (glows_ != other.glows_ || group_names_ != other.group_names_ ||
      object_names_ != other.object_names_ || plane_names_ != other.plane_names_ ||
      deep_.has_value() != other.deep_.has_value())
    throw std::invalid_argument("a film with emission, groups of lights or planes and one without, "
                                "or with others, cannot be merged");
  for_each_block(pixels(), [&](std::size_t, std::size_t begin, std::size_t end) {
    merge_values(direct_, other.direct_, 3 * begin, 3 * end);
    merge_values(indirect_, other.indirect_, 3 * begin, 3 * end);
    merge_values(background_, other.background_, 3 * begin, 3 * end);
    if (glows_)
      merge_values(emission_, other.emission_, 3 * begin, 3 * end);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      merge_values(groups_[g], other.groups_[g], 3 * begin, 3 * end);
    for (std::size_t i = 0; i < coverage_.size(); ++i)
      merge_values(coverage_[i], other.coverage_[i], begin, end);
    for (std::size_t i = 0; i < planes_.size(); ++i)
      merge_values(planes_[i], other.planes_[i], begin, end);
    merge_values(opacity_, other.opacity_, begin, end);
    merge_values(depth_, other.depth_, begin, end);
    for (std::size_t i = 3 * begin; i < 3 * end; ++i)
      squares_[i] += other.squares_[i];
  });
  if (deep_)
    deep_->merge(*other.deep_);
  history_.merge(other.history_);
  statistics_.reset();
  passes_ += other.passes_;
  invalid_values_ += other.invalid_values_;
}

std::vector<ImagePlane> Film::planes() {
  std::vector<ImagePlane> planes;
  const auto add = [&](const std::string& name, CompensatedSums& sums, std::size_t stride,
                       std::size_t channel) {
    planes.push_back({name + ".sum", sums.high_data() + channel, stride});
    planes.push_back({name + ".rest", sums.low_data() + channel, stride});
  };
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string channel(1, "RGB"[c]);
    add("direct." + channel, direct_, 3, c);
    add("indirect." + channel, indirect_, 3, c);
    add("background." + channel, background_, 3, c);
    if (glows_)
      add("emission." + channel, emission_, 3, c);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      add("group." + group_names_[g] + "." + channel, groups_[g], 3, c);
    planes.push_back({"squares." + channel, squares_.data() + c, 3});
  }
  for (std::size_t i = 0; i < coverage_.size(); ++i)
    add("object." + object_names_[i], coverage_[i], 1, 0);
  for (std::size_t i = 0; i < planes_.size(); ++i)
    add("plane." + plane_names_[i], planes_[i], 1, 0);
  add("opacity", opacity_, 1, 0);
  add("depth", depth_, 1, 0);
  if (deep_)
    for (ImagePlane& plane : deep_->planes())
      planes.push_back(std::move(plane));
  const auto add_history = [&](const char* name, auto& values) {
    for (std::size_t first = 0; first < values.size(); first += pixels())
      planes.push_back({fmt::format("history.{}.{}", name, first / pixels()), &values[first], 1});
  };
  if (pixels() > 0) {
    add_history("sums", history_.values());
    add_history("passes", history_.counts());
  }
  return planes;
}

void Film::set_counts(int passes, std::uint64_t invalid_values) {
  passes_ = passes;
  invalid_values_ = invalid_values;
  statistics_.reset();
}

double Film::sum(std::size_t i, bool background) const {
  double sum = direct_.high(i) + indirect_.high(i);
  if (glows_)
    sum += emission_.high(i);
  return background ? sum + background_.high(i) : sum;
}

Image Film::develop() const {
  Image image;
  image.width = width_;
  image.height = height_;
  // Blender reads a layer's channel only where its last part is one of R G B A X Y Z V U.
  for (const char* name : {"R", "G", "B", "A", "volume.R", "volume.G", "volume.B", "volume.A",
                           "volume_direct.R", "volume_direct.G", "volume_direct.B",
                           "volume_indirect.R", "volume_indirect.G", "volume_indirect.B"})
    image.channels.push_back({name, std::vector<float>(pixels())});
  image.channels.push_back({"depth.Z", std::vector<float>(pixels()), false});
  if (glows_)
    for (const char* name : {"volume_emission.R", "volume_emission.G", "volume_emission.B"})
      image.channels.push_back({name, std::vector<float>(pixels())});

  enum : std::size_t {
    rgb = 0,
    alpha = 3,
    volume = 4,
    volume_alpha = 7,
    direct = 8,
    indirect = 11
  };
  constexpr std::size_t depth = 14, emission = 15;
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
  return image;
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
    if (name == "variance")
      add(channel, false, [&](std::size_t i) {
        const double mean = sum(3 * i + c, true) / n;
        return passes_ < 2 ? 0.0
                           : std::max(0.0, squares_[3 * i + c] - n * mean * mean) / (n * (n - 1));
      });
  }
}

double Film::mrse_estimate() const {
  if (passes_ < 2 || pixels() == 0)
    return std::numeric_limits<double>::infinity();
  const double n = passes_;
  std::vector<double> sums((pixels() + block_size - 1) / block_size);
  for_each_block(pixels(), [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = 3 * begin; i < 3 * end; ++i) {
      const double mean = sum(i, true) / n;
      // Rounding may leave a constant with a tiny negative variance.
      const double variance = std::max(0.0, (squares_[i] - n * mean * mean) / (n - 1));
      sums[block] += variance / (n * (mean + 0.01) * (mean + 0.01));
    }
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0) / (3 * static_cast<double>(pixels()));
}

ErrorEstimate Film::error_estimate(bool unbiased) const {
  // Batches that are complete stay as they are until there are more or, joined, fewer of them.
  if (!statistics_ || statistics_->batches != history_.batches())
    statistics_ = {history_.batches(), noise_statistics(history_), bias_statistics(history_)};
  return combine_errors(mrse_estimate(), statistics_->noise, statistics_->bias, unbiased);
}

} // namespace vdbeam
