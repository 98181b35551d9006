#pragma once

#include "image/pass_image.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// Radiance of one pixel by an unbiased estimator, to hold a biased one against.
struct ProbeValue {
  std::size_t pixel; ///< of the film
  Rgb radiance;
};

/// How the passes went at some of the pixels: sums over up to 16 batches of successive passes, from
/// which follow what noise the pixels share and how a biased picture differs from unbiased probes.
/// Batches double in length whenever 16 are full, so memory stays below 2 MB.
class PassHistory {
public:
  static constexpr std::size_t most_batches = 16;
  static constexpr std::size_t most_samples = 4096;

  PassHistory(int width, int height);

  /// Pixels that are followed: one in each block of a grid of columns() x rows() blocks, row-major.
  const std::vector<std::size_t>& pixels() const { return pixels_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Pixels that are followed, of all.
  double share() const { return share_; }

  /// `probes` are of pixels that are followed.
  void add(const PassImage& pass, const std::vector<ProbeValue>& probes);
  /// Takes over the batches of another history of the same size.
  void merge(const PassHistory& other);

  /// Batches that no further pass joins, unless there are hardly any others. What is said about
  /// errors rests on them, so that it changes only when one is full.
  std::size_t batches() const;
  double passes(std::size_t batch) const { return counts_[batch]; }
  /// Sums over the batch's passes, R, G, B of each followed pixel.
  const float* sums(std::size_t batch) const { return &values_[batch * stride()]; }
  const float* probe_sums(std::size_t batch) const { return sums(batch) + 3 * pixels_.size(); }
  /// How many probes each followed pixel got.
  const float* probes(std::size_t batch) const { return sums(batch) + 6 * pixels_.size(); }

  /// Everything above, for storing: both as long as a multiple of the film's pixels.
  std::vector<float>& values() { return values_; }
  std::vector<std::uint32_t>& counts() { return counts_; }

private:
  std::size_t stride() const { return 7 * pixels_.size(); }
  std::size_t used() const;
  void join(std::size_t batch);
  void make_room();

  int columns_, rows_, block_;
  int width_;
  double share_;
  std::vector<std::size_t> pixels_;
  std::vector<float> values_;
  std::vector<std::uint32_t> counts_; ///< passes of each batch
};

} // namespace vdbeam
