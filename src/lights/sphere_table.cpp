#include "lights/sphere_table.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

namespace vdbeam {
namespace {

constexpr std::ptrdiff_t largest_table = std::ptrdiff_t(1) << 20; // blocks

// Running sums of `values`, divided by their total, into count + 1 places from `cdf`.
double accumulate(const double* values, int count, float* cdf) {
  double total = 0;
  for (int i = 0; i < count; ++i)
    total += values[i];
  double sum = 0;
  cdf[0] = 0;
  for (int i = 0; i < count; ++i) {
    sum += values[i];
    cdf[i + 1] = total > 0 ? static_cast<float>(sum / total) : 0;
  }
  if (total > 0) // rounding must leave no gap below 1, where the last non-zero value ends
    for (int i = count; i > 0 && (i == count || values[i] <= 0); --i)
      cdf[i] = 1;
  return total;
}

// The interval of the distribution that holds u, never an empty one; the rest of u in [0, 1).
int invert(const float* cdf, int count, float u, double& rest) {
  const float* above = std::upper_bound(cdf + 1, cdf + count, u);
  const int i = static_cast<int>(above - cdf) - 1;
  rest = (static_cast<double>(u) - static_cast<double>(cdf[i])) /
         (static_cast<double>(cdf[i + 1]) - static_cast<double>(cdf[i]));
  return i;
}

} // namespace

SphereTable::SphereTable(const std::vector<double>& pixel_integrals, int width, int height)
    : width_(width), height_(height) {
  const auto blocks = [](int n, int size) { return (n + size - 1) / size; };
  while (static_cast<std::ptrdiff_t>(blocks(width, block_)) * blocks(height, block_) >
         largest_table)
    ++block_;
  columns_ = blocks(width, block_);
  rows_ = blocks(height, block_);
  row_cdf_.resize(rows_ + 1);
  column_cdf_.resize(static_cast<std::size_t>(rows_) * (columns_ + 1));
  for (int r = 0; r <= rows_; ++r) {
    const double share = std::min(1.0, static_cast<double>(r) * block_ / height);
    cos_edges_.push_back(std::cos(std::numbers::pi * share));
  }
  std::vector<double> row_sums(rows_);
  for (int r = 0; r < rows_; ++r) {
    std::vector<double> sums(columns_, 0.0);
    for (int y = r * block_; y < std::min(height, (r + 1) * block_); ++y)
      for (int x = 0; x < width; ++x)
        sums[x / block_] += pixel_integrals[static_cast<std::size_t>(y) * width + x];
    row_sums[r] = accumulate(sums.data(), columns_,
                             column_cdf_.data() + static_cast<std::size_t>(r) * (columns_ + 1));
  }
  empty_ = !(accumulate(row_sums.data(), rows_, row_cdf_.data()) > 0);
}

float SphereTable::block_pdf(int row, int column) const {
  const float* cdf = column_cdf_.data() + static_cast<std::size_t>(row) * (columns_ + 1);
  const double mass =
      (static_cast<double>(row_cdf_[row + 1]) - static_cast<double>(row_cdf_[row])) *
      (static_cast<double>(cdf[column + 1]) - static_cast<double>(cdf[column]));
  const int pixels = std::min(width_, (column + 1) * block_) - column * block_;
  const double solid_angle =
      2 * std::numbers::pi * pixels / width_ * (cos_edges_[row] - cos_edges_[row + 1]);
  return static_cast<float>(mass / solid_angle);
}

SphereTable::Sample SphereTable::sample(float u, float v) const {
  if (empty_)
    return {};
  double rest_u = 0, rest_v = 0;
  const int row = invert(row_cdf_.data(), rows_, v, rest_v);
  const int column = invert(column_cdf_.data() + static_cast<std::size_t>(row) * (columns_ + 1),
                            columns_, u, rest_u);
  const double begin = static_cast<double>(column) * block_ / width_;
  const double end = std::min(1.0, static_cast<double>(column + 1) * block_ / width_);
  return {cos_edges_[row] + rest_v * (cos_edges_[row + 1] - cos_edges_[row]),
          begin + rest_u * (end - begin), block_pdf(row, column)};
}

float SphereTable::pdf(double theta_share, double turn) const {
  if (empty_)
    return 0;
  const int y = std::clamp(static_cast<int>(theta_share * height_), 0, height_ - 1);
  const int x = std::clamp(static_cast<int>(turn * width_), 0, width_ - 1);
  return block_pdf(y / block_, x / block_);
}

} // namespace vdbeam
