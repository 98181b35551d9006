#pragma once

#include "image/pass_image.h"
#include "math/zeroed_array.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// Fewest batches that give a variance.
inline constexpr std::size_t fewest_batches = 3;

/// History of the passes at some of the pixels: sums over up to 16 batches of successive passes.
/// They show which noise the pixels share, how a biased picture differs from unbiased probes and
/// how much its kernels blur. Batches double in length whenever 16 are full, so memory stays below
/// 4 MB.
class PassHistory {
public:
  static constexpr std::size_t most_batches = 16;
  static constexpr std::size_t most_samples = 4096;

  PassHistory(int width, int height);

  /// Pixels that are followed: one in each block of a grid of columns() x rows() blocks, row-major.
  const std::vector<std::size_t>& pixels() const { return pixels_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Fraction of the pixels that is followed.
  double share() const { return share_; }

  /// `probes` are radiances by an unbiased estimator. They and the pass's blur must be of followed
  /// pixels.
  void add(const PassImage& pass, const std::vector<PixelValue>& probes);
  /// Adds the batches of another history of the same size.
  void merge(const PassHistory& other);

  /// Number of complete batches (up to 8, the one that is being filled counts too). Error estimates
  /// use only these, so they change only when a batch is complete.
  std::size_t batches() const;
  double passes(std::size_t batch) const { return counts_[batch]; }
  /// Sums over the batch's passes, R, G, B of each followed pixel.
  const float* sums(std::size_t batch) const { return &values_[batch * stride()]; }
  const float* probe_sums(std::size_t batch) const { return sums(batch) + 3 * pixels_.size(); }
  /// Number of probes of each followed pixel.
  const float* probes(std::size_t batch) const { return sums(batch) + 6 * pixels_.size(); }
  /// The same for the passes' blur.
  const float* blur_sums(std::size_t batch) const { return sums(batch) + 7 * pixels_.size(); }
  const float* blurs(std::size_t batch) const { return sums(batch) + 10 * pixels_.size(); }
  /// Sums over the batch's passes of what each shows times its truncation (PassImage).
  const float* truncated_sums(std::size_t batch) const { return sums(batch) + 11 * pixels_.size(); }
  /// Sums of the passes' truncation and of its square.
  double truncation(std::size_t batch) const { return sums(batch)[14 * pixels_.size()]; }
  double truncation_squares(std::size_t batch) const {
    return sums(batch)[14 * pixels_.size() + 1];
  }

  /// The same passes in half the number of batches, of two or three, where batches are single
  /// passes: a single pass has one truncation order, so its effect cannot be separated. Otherwise,
  /// and where the batches would be too few, the history as it is.
  PassHistory with_several_passes_per_batch() const;

  /// Everything above, for storing: both as long as a multiple of the film's pixels.
  ZeroedArray<float>& values() { return values_; }
  ZeroedArray<std::uint32_t>& counts() { return counts_; }

private:
  std::size_t stride() const { return 14 * pixels_.size() + 2; }
  /// Adds values to sums of R, G, B that begin at `first` values per pixel, and counts them behind.
  void add_values(const std::vector<PixelValue>& values, std::size_t first, float* sums) const;
  std::size_t used() const;
  void join(std::size_t batch);
  void make_room();

  int columns_, rows_, block_;
  int width_;
  double share_;
  std::vector<std::size_t> pixels_;
  ZeroedArray<float> values_;
  ZeroedArray<std::uint32_t> counts_; ///< passes of each batch
};

} // namespace vdbeam
