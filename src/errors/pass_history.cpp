#include "errors/pass_history.h"

#include "math/rng.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

std::size_t round_up(std::size_t count, std::size_t unit) {
  return (count + unit - 1) / unit * unit;
}

float finite_or_zero(float value) {
  return std::isfinite(value) ? value : 0.0f;
}

int blocks(int side, int block) {
  return (side + block - 1) / block;
}

} // namespace

PassHistory::PassHistory(int width, int height) : block_(1), width_(width) {
  while (static_cast<std::size_t>(blocks(width, block_)) * blocks(height, block_) > most_samples)
    ++block_;
  columns_ = blocks(width, block_);
  rows_ = blocks(height, block_);
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      // Not always the same place of a block, which a pattern of the picture might match.
      const std::uint64_t bits = mix64(pixels_.size() + 1);
      const int x0 = column * block_, y0 = row * block_;
      const int x = x0 + static_cast<int>(bits % std::min(block_, width - x0));
      const int y = y0 + static_cast<int>((bits >> 32) % std::min(block_, height - y0));
      pixels_.push_back(static_cast<std::size_t>(y) * width + x);
    }
  const std::size_t all = static_cast<std::size_t>(width) * height;
  share_ = all > 0 ? static_cast<double>(pixels_.size()) / static_cast<double>(all) : 1;
  values_.resize(round_up(stride() * most_batches, std::max<std::size_t>(all, 1)));
  counts_.resize(round_up(most_batches, std::max<std::size_t>(all, 1)));
}

std::size_t PassHistory::used() const {
  std::size_t batch = 0;
  while (batch < most_batches && counts_[batch] > 0)
    ++batch;
  return batch;
}

std::size_t PassHistory::batches() const {
  const std::size_t count = used();
  if (count <= most_batches / 2)
    return count;
  const std::uint32_t length = *std::max_element(counts_.begin(), counts_.begin() + most_batches);
  return counts_[count - 1] < length ? count - 1 : count;
}

/// Adds batch + 1 to `batch`, and moves what follows.
void PassHistory::join(std::size_t batch) {
  const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(batch * stride());
  const auto next = begin + static_cast<std::ptrdiff_t>(stride());
  const auto end = values_.begin() + static_cast<std::ptrdiff_t>(most_batches * stride());
  std::transform(begin, next, next, begin, std::plus<>());
  std::fill(std::move(next + static_cast<std::ptrdiff_t>(stride()), end, next), end, 0.0f);
  counts_[batch] += counts_[batch + 1];
  for (std::size_t i = batch + 1; i + 1 < most_batches; ++i)
    counts_[i] = counts_[i + 1];
  counts_[most_batches - 1] = 0;
}

/// Makes batches twice as long where all are full.
void PassHistory::make_room() {
  if (used() < most_batches)
    return;
  for (std::size_t batch = 0; batch < most_batches / 2; ++batch)
    join(batch);
}

void PassHistory::add_values(const std::vector<PixelValue>& values, std::size_t first,
                             float* sums) const {
  const std::size_t samples = pixels_.size();
  for (const PixelValue& value : values) {
    const int x = static_cast<int>(value.pixel % width_),
              y = static_cast<int>(value.pixel / width_);
    const std::size_t i = static_cast<std::size_t>(y / block_) * columns_ + x / block_;
    for (std::size_t c = 0; c < 3; ++c)
      sums[first * samples + 3 * i + c] += finite_or_zero(value.radiance[static_cast<int>(c)]);
    sums[(first + 3) * samples + i] += 1;
  }
}

void PassHistory::add(const PassImage& pass, const std::vector<PixelValue>& probes) {
  std::size_t batch = used();
  const std::uint32_t length = *std::max_element(counts_.begin(), counts_.begin() + most_batches);
  if (batch > 0 && counts_[batch - 1] < length) {
    --batch;
  } else {
    make_room();
    batch = used();
  }
  ++counts_[batch];
  const std::size_t samples = pixels_.size();
  float* sums = &values_[batch * stride()];
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t pixel = pixels_[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const auto part = [&](const std::vector<Rgb>& light) {
        return light.empty() ? 0.0f : finite_or_zero(light[pixel][static_cast<int>(c)]);
      };
      const float value =
          part(pass.direct) + part(pass.indirect) + part(pass.background) + part(pass.emission);
      sums[3 * i + c] += value;
      sums[11 * samples + 3 * i + c] += value * pass.truncation;
    }
  }
  sums[14 * samples] += pass.truncation;
  sums[14 * samples + 1] += pass.truncation * pass.truncation;
  add_values(probes, 3, sums);
  add_values(pass.blur, 7, sums);
}

PassHistory PassHistory::with_several_passes_per_batch() const {
  PassHistory longer = *this;
  const std::size_t count = used();
  const bool single =
      std::all_of(counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(count),
                  [](std::uint32_t passes) { return passes == 1; });
  if (!single || count < 2 * fewest_batches)
    return longer;
  for (std::size_t batch = 0; batch < count / 2; ++batch)
    longer.join(batch);
  if (count % 2 == 1)
    longer.join(count / 2 - 1);
  return longer;
}

void PassHistory::merge(const PassHistory& other) {
  const std::size_t theirs = other.used();
  for (std::size_t i = 0; i < theirs; ++i) {
    if (used() == most_batches) { // the two neighbours that are shortest together
      std::size_t best = 0;
      for (std::size_t batch = 1; batch + 1 < most_batches; ++batch)
        if (counts_[batch] + counts_[batch + 1] < counts_[best] + counts_[best + 1])
          best = batch;
      join(best);
    }
    const std::size_t batch = used();
    std::copy_n(other.sums(i), stride(), &values_[batch * stride()]);
    counts_[batch] = other.counts_[i];
  }
}

} // namespace vdbeam
