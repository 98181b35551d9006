#pragma once

#include "vdbeam/vec.h"

#include <vector>

namespace vdbeam {

/// A piecewise constant density over the sphere, on a grid of latitude and longitude: inversion of
/// the rows' and then the columns' distribution, so that nearby numbers give nearby directions.
///
/// Rows are equal steps of theta from 0 (+z) to pi, columns equal steps of turn from 0 to 1, both
/// but for the last, narrower one where the block size does not divide the image. Within a block
/// the density per solid angle is constant.
class SphereTable {
public:
  /// Integrals (of any non-negative function) over the pixels of a lat-long image, row-major;
  /// pixels are grouped in blocks so that the table stays small.
  SphereTable(const std::vector<double>& pixel_integrals, int width, int height);

  struct Sample {
    double cos_theta = 1;
    double turn = 0; ///< phi / (2 pi), in [0, 1)
    float pdf = 0;   ///< per solid angle; 0 where the function is 0 everywhere
  };
  Sample sample(float u, float v) const;
  /// Density at theta / pi and turn, both in [0, 1].
  float pdf(double theta_share, double turn) const;

private:
  float block_pdf(int row, int column) const;

  int width_ = 1, height_ = 1;    // pixels
  int block_ = 1;                 // pixels per block, both ways
  int columns_ = 1, rows_ = 1;    // blocks
  std::vector<float> row_cdf_;    // rows_ + 1
  std::vector<float> column_cdf_; // rows_ * (columns_ + 1)
  std::vector<double> cos_edges_; // rows_ + 1
  bool empty_ = true;
};

} // namespace vdbeam
