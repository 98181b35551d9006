#include "film/deep_film.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vdbeam {
namespace {

/// Files hold planes of one value per pixel.
template <class T>
void pad(std::vector<T>& values, std::size_t pixels) {
  if (pixels > 0)
    values.resize((values.size() + pixels - 1) / pixels * pixels);
}

std::size_t padded(std::size_t count, std::size_t pixels) {
  return pixels > 0 ? (count + pixels - 1) / pixels * pixels : 0;
}

/// Fills in where each pixel's pieces and edges begin. False where there are more than fit.
bool number_pieces(const std::vector<std::uint32_t>& counts, DeepLayout& layout,
                   std::size_t most_pieces) {
  std::size_t pieces = 0, edges = 0;
  layout.first.clear();
  layout.first_edge.clear();
  for (const std::uint32_t count : counts) {
    layout.first.push_back(static_cast<std::uint32_t>(pieces));
    layout.first_edge.push_back(edges);
    pieces += count;
    edges += count > 0 ? std::size_t{count} + 1 : 0;
    if (pieces > most_pieces || edges > layout.edges.size())
      return false;
  }
  layout.first.push_back(static_cast<std::uint32_t>(pieces));
  return true;
}

} // namespace

DeepFilm::DeepFilm(DeepLayout layout)
    : pixels_(layout.pixels()), layout_(std::move(layout)),
      sums_(padded(layout_.pieces() * DeepLayout::values_per_piece, pixels_)) {
  for (std::size_t i = 0; i < pixels_; ++i)
    counts_.push_back(static_cast<std::uint32_t>(layout_.count(i)));
  pad(layout_.edges, pixels_);
}

DeepFilm::DeepFilm(std::size_t pixels, std::size_t edge_planes, std::size_t piece_planes)
    : pixels_(pixels), counts_(pixels), sums_(piece_planes * pixels) {
  layout_.edges.resize(edge_planes * pixels);
  layout_.cosines.resize(pixels);
}

bool DeepFilm::finish_reading(float alpha_error) {
  layout_.alpha_error = alpha_error;
  return number_pieces(counts_, layout_, sums_.size() / DeepLayout::values_per_piece);
}

void DeepFilm::add(const PassImage& pass) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pass.deep.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                        sums_.add(i, static_cast<double>(finite_or_zero(pass.deep[i])));
                    });
}

void DeepFilm::merge(const DeepFilm& other) {
  if (other.counts_ != counts_ || other.layout_.edges != layout_.edges)
    throw std::invalid_argument("deep films whose rays are cut otherwise cannot be merged");
  for (std::size_t i = 0; i < sums_.size(); ++i)
    sums_.merge(i, other.sums_);
}

std::vector<ImagePlane> DeepFilm::planes() {
  std::vector<ImagePlane> planes;
  if (pixels_ == 0)
    return planes;
  planes.push_back({"deep.counts", counts_.data(), 1});
  planes.push_back({"deep.cosines", layout_.cosines.data(), 1});
  for (std::size_t i = 0; i < layout_.edges.size(); i += pixels_)
    planes.push_back({fmt::format("deep.edges.{}", i / pixels_), &layout_.edges[i], 1});
  for (std::size_t i = 0; i < sums_.size(); i += pixels_) {
    planes.push_back({fmt::format("deep.sums.{}", i / pixels_), sums_.high_data() + i, 1});
    planes.push_back({fmt::format("deep.rests.{}", i / pixels_), sums_.low_data() + i, 1});
  }
  return planes;
}

DeepImage DeepFilm::develop(int passes, int width, int height) const {
  DeepImage image;
  image.width = width;
  image.height = height;
  image.counts.assign(pixels_, 0);
  image.alpha_error = layout_.alpha_error;
  const double n = std::max(passes, 1);
  // Beyond so little light no sample's opacity has any digits left.
  constexpr double least_light = 1e-6;
  for (std::size_t pixel = 0; pixel < pixels_; ++pixel) {
    const float* edges = layout_.edges_of(pixel);
    const float cosine = layout_.cosines[pixel];
    double light = 1; // what of the light behind is left
    for (std::size_t k = 0; k < layout_.count(pixel); ++k) {
      const std::size_t at = (layout_.first[pixel] + k) * DeepLayout::values_per_piece;
      const double r = sums_.high(at) / n, g = sums_.high(at + 1) / n, b = sums_.high(at + 2) / n;
      const double opacity = sums_.high(at + 3) / n, reaches = std::max(light, least_light);
      light -= opacity;
      if (r == 0 && g == 0 && b == 0 && !(opacity > 0))
        continue;
      ++image.counts[pixel];
      image.z.push_back(edges[k] * cosine);
      image.z_back.push_back(edges[k + 1] * cosine);
      image.r.push_back(static_cast<float>(r / reaches));
      image.g.push_back(static_cast<float>(g / reaches));
      image.b.push_back(static_cast<float>(b / reaches));
      image.a.push_back(static_cast<float>(std::clamp(opacity / reaches, 0.0, 1.0)));
    }
  }
  return image;
}

} // namespace vdbeam
