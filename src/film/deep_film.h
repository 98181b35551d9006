#pragma once

#include "film/compensated_sums.h"
#include "image/deep_layout.h"
#include "image/pass_image.h"
#include "image/plane_file.h"
#include "vdbeam/deep_image.h"

namespace vdbeam {

/// Deep part of a film: sums of light and opacity per piece of the layout, which
/// merge as exactly as those of the flat picture.
class DeepFilm {
public:
  explicit DeepFilm(DeepLayout layout);
  /// A film that is to be filled from a file (`planes`, then `finish_reading`): it holds at most so
  /// many edges and pieces for each pixel on average.
  DeepFilm(std::size_t pixels, std::size_t edge_planes, std::size_t piece_planes);

  /// Adds a pass that has a value for each piece; values that are not finite count as 0.
  void add(const PassImage& pass);
  /// Adds the passes of a film with the same layout (std::invalid_argument).
  void merge(const DeepFilm& other);

  /// As Film::planes.
  std::vector<ImagePlane> planes();
  /// False where what was read is no layout.
  bool finish_reading(float alpha_error);

  const DeepLayout& layout() const { return layout_; }
  /// The mean of the passes. A sample's opacity is that of the piece, what it adds divided by what
  /// reaches it, and so is its colour: laid over each other the samples give the flat picture's
  /// `volume` and its opacity.
  DeepImage develop(int passes, int width, int height) const;

  /// Memory of a pass and the film per piece [bytes].
  static constexpr std::size_t bytes_per_piece() {
    return sizeof(float) +
           DeepLayout::values_per_piece * (sizeof(float) + CompensatedSums::bytes_per_value);
  }

private:
  std::size_t pixels_;
  DeepLayout layout_;
  std::vector<std::uint32_t> counts_; ///< pieces per pixel
  CompensatedSums sums_;
};

} // namespace vdbeam
