#pragma once

#include "errors/error_estimate.h"
#include "errors/pass_history.h"
#include "film/compensated_sums.h"
#include "film/deep_film.h"
#include "image/pass_image.h"
#include "image/plane_file.h"
#include "vdbeam/image.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// The depth of a pixel without any medium: far behind everything, the value that Blender writes.
constexpr float empty_depth = 1e10f;

/// The mean of passes. It holds 168 bytes per pixel (1.4 GB at 3840 x 2160; 204 with emission)
/// whatever the number of passes, at most 3 MB of their history, and developing it needs 60 (72)
/// more per pixel.
///
/// Pass values that are not finite count as 0, so that one bad path cannot destroy a frame; see
/// invalid_values().
class Film {
public:
  /// `glows`: passes may hold emission. `groups`: names of the groups of lights of passes. `deep`:
  /// where rays are cut for a deep picture. `objects`: names of those whose coverage passes hold.
  /// `planes`: names of what they hold beyond that (plane_layers.h).
  Film(int width, int height, bool glows = false, std::vector<std::string> groups = {},
       std::optional<DeepFilm> deep = std::nullopt, std::vector<std::string> objects = {},
       std::vector<std::string> planes = {});

  /// Adds one pass. Its size must be the film's (std::invalid_argument). `probes` are unbiased
  /// values of probe_pixels(), any of them.
  void add(const PassImage& pass, const std::vector<PixelValue>& probes = {});
  /// Adds the passes of another film of the same size (std::invalid_argument).
  void merge(const Film& other);

  int width() const { return width_; }
  int height() const { return height_; }
  int passes() const { return passes_; }
  bool glows() const { return glows_; }
  const std::vector<std::string>& groups() const { return group_names_; }
  const std::vector<std::string>& plane_names() const { return plane_names_; }
  /// Values of the passes so far that were NaN or infinite.
  std::uint64_t invalid_values() const { return invalid_values_; }
  /// About how many values develop() gives for each pixel.
  std::size_t values_per_pixel() const {
    constexpr std::size_t of_cryptomatte = 12;
    return (glows_ ? 18 : 15) + 3 * groups_.size() + planes_.size() +
           (coverage_.empty() ? 0 : of_cryptomatte);
  }
  /// Memory of a film per pixel [bytes], without its history.
  static constexpr std::size_t bytes_per_pixel(bool glows = false) {
    return (glows ? 17 : 14) * CompensatedSums::bytes_per_value;
  }
  /// And for each object whose coverage it holds, with that of a pass and the largest layers.
  static constexpr std::size_t bytes_per_pixel_of_object() {
    return CompensatedSums::bytes_per_value + sizeof(float);
  }
  /// And for each plane that layers ask for, with that of a pass and of the picture.
  static constexpr std::size_t bytes_per_pixel_of_plane() {
    return CompensatedSums::bytes_per_value + 2 * sizeof(float);
  }
  /// And for each group of lights.
  static constexpr std::size_t bytes_per_pixel_of_group() {
    return 3 * (CompensatedSums::bytes_per_value + sizeof(float));
  }
  /// And what develop() gives back.
  static constexpr std::size_t developed_bytes_per_pixel(bool glows = false) {
    return (glows ? 18 : 15) * sizeof(float);
  }

  /// Everything that a film holds per pixel ("direct.R.sum", "depth.rest", ...), always in the same
  /// order: with these and the two counts stored and put back, it goes on bit for bit.
  std::vector<ImagePlane> planes();
  /// Pixels that probes may hold a biased estimator against.
  const std::vector<std::size_t>& probe_pixels() const { return history_.pixels(); }
  void set_counts(int passes, std::uint64_t invalid_values);

  /// R, G, B: direct + indirect + emission + background; A: the mean opacity; and the layers volume
  /// (direct + indirect + emission, and A), volume_direct, volume_indirect and, of a film that
  /// glows, volume_emission (half), and depth.Z (float): the mean distance [world] of the medium,
  /// weighted by opacity, or empty_depth where there is none. Everything is black before the first
  /// pass.
  /// Groups of lights come as light_NAME, planes under their names, and objects as Cryptomatte
  /// (cryptomatte.h).
  Image develop() const;
  /// The deep picture; nullopt where the film holds none.
  std::optional<DeepImage> develop_deep() const;
  DeepFilm* deep() { return deep_ ? &*deep_ : nullptr; }
  const DeepFilm* deep() const { return deep_ ? &*deep_ : nullptr; }
  /// Adds one of the layers that develop() leaves out, or nothing: background, transmittance,
  /// variance, that of the mean of the passes (float), error, its root (float), and samples, rays
  /// per pixel (float).
  void add_layer(const std::string& name, Image& image) const;

  /// The expected MRSE of develop()'s R, G, B, without bias, from the variance of the passes: the
  /// mean over pixels and channels of s^2 / (n (mean + 0.01)^2), s^2 the unbiased sample variance
  /// of n passes. Infinite for fewer than 2 passes.
  double mrse_estimate() const;
  /// The same, corrected for the bias of weighting each pixel by its own noisy mean, with the bias
  /// that probes show (`unbiased`: there is none) and an interval that takes the noise shared by
  /// pixels into account (docs/theory/error-estimate.md). The corrections change only when a batch
  /// of passes is complete.
  ErrorEstimate error_estimate(bool unbiased) const;

private:
  std::size_t pixels() const { return static_cast<std::size_t>(width_) * height_; }
  void develop_parts(double passes, Image& image) const;
  std::vector<float> develop_plane(std::size_t plane) const;
  std::uint64_t add_pixels(const PassImage& pass, std::size_t begin, std::size_t end);
  void check_size(int width, int height) const;

  /// Direct + indirect + emission, without (false) or with background: value i of 3 per pixel.
  double sum(std::size_t i, bool background) const;

  int width_, height_;
  bool glows_;
  int passes_ = 0;
  std::uint64_t invalid_values_ = 0;
  CompensatedSums direct_, indirect_, background_; ///< 3 per pixel
  CompensatedSums emission_;                       ///< 3 per pixel, none without emission
  CompensatedSums opacity_, depth_;
  std::vector<std::string> group_names_;
  std::vector<CompensatedSums> groups_; ///< 3 per pixel and group of lights
  std::vector<std::string> object_names_;
  std::vector<CompensatedSums> coverage_; ///< 1 per pixel and object
  std::vector<std::string> plane_names_;
  std::vector<CompensatedSums> planes_; ///< 1 per pixel and plane that layers ask for
  CompensatedSums squares_;             ///< 3 per pixel: sums of what passes show, squared
  std::optional<DeepFilm> deep_;
  PassHistory history_;
  struct HistoryStatistics {
    std::size_t batches;
    NoiseStatistics noise;
    BiasStatistics bias;
  };
  mutable std::optional<HistoryStatistics> statistics_; ///< when a batch was last complete
};

} // namespace vdbeam
