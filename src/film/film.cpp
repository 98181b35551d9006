#include "film/film.h"

#include "film/film_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace vdbeam {
namespace {

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

/// Makes `count` arrays of `size` sums each. Copies of one would touch all of their memory.
std::vector<CompensatedSums> make_sums(std::size_t count, std::size_t size) {
  std::vector<CompensatedSums> sums;
  sums.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    sums.emplace_back(size);
  return sums;
}

} // namespace

Film::Film(int width, int height, bool glows, std::vector<std::string> groups,
           std::optional<DeepFilm> deep, std::vector<std::string> objects,
           std::vector<std::string> planes)
    : width_(width), height_(height), glows_(glows), direct_(3 * pixels()), indirect_(3 * pixels()),
      background_(3 * pixels()), emission_(glows ? 3 * pixels() : 0), opacity_(pixels()),
      depth_(pixels()), group_names_(std::move(groups)),
      groups_(make_sums(group_names_.size(), 3 * pixels())), object_names_(std::move(objects)),
      coverage_(make_sums(object_names_.size(), pixels())), plane_names_(std::move(planes)),
      planes_(make_sums(plane_names_.size(), pixels())), squares_(3 * pixels()),
      deep_(std::move(deep)), history_(width, height) {}

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
    squares_.add(i, total * total);
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
    merge_values(squares_, other.squares_, 3 * begin, 3 * end);
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
    add("squares." + channel, squares_, 3, c);
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

double Film::mrse_estimate() const {
  if (passes_ < 2 || pixels() == 0)
    return std::numeric_limits<double>::infinity();
  const double n = passes_;
  std::vector<double> sums((pixels() + block_size - 1) / block_size);
  for_each_block(pixels(), [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = 3 * begin; i < 3 * end; ++i) {
      const double mean = sum(i, true) / n;
      // Rounding may leave a constant with a tiny negative variance.
      const double variance = std::max(0.0, (squares_.high(i) - n * mean * mean) / (n - 1));
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
