#include "lights/emission_cells.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

/// Cells of a whole surface, about, and along a primitive's side at most.
constexpr double cells = 65536;
constexpr double most_per_side = 256;
/// Points at which the picture is read per cell, at most.
constexpr double most_points = 1024;
/// Share of the points that are drawn uniformly: the cells' values are those of some points only.
constexpr double uniform_share = 0.05;

} // namespace

EmissionCells::EmissionCells(std::shared_ptr<const SurfaceSet> surfaces, int surface,
                             const Texture& texture)
    : surfaces_(std::move(surfaces)), surface_(static_cast<std::size_t>(surface)) {
  const std::size_t primitives = surfaces_->primitives(surface_);
  first_.push_back(0);
  for (std::size_t i = 0; i < primitives; ++i) {
    const double side = std::clamp(std::round(std::sqrt(cells * share(i))), 1.0, most_per_side);
    sides_.push_back(static_cast<std::uint32_t>(side));
    first_.push_back(first_.back() + static_cast<std::size_t>(side * side));
  }
  const double texels = static_cast<double>(texture.width()) * texture.height();
  const auto count = static_cast<double>(first_.back());
  const int points =
      static_cast<int>(std::ceil(std::sqrt(std::clamp(texels / count, 4.0, most_points))));
  std::vector<double> weights, shares;
  Vec3d integral{};
  for (std::size_t i = 0; i < primitives; ++i) {
    const std::uint32_t side = sides_[i];
    const double cell_share = share(i) / side / side;
    for (std::uint32_t cell = 0; cell < side * side; ++cell) {
      Vec3d sum{};
      for (int k = 0; k < points * points; ++k) {
        const AreaPlace place{(cell / side + (k / points + 0.5) / points) / side,
                              (cell % side + (k % points + 0.5) / points) / side};
        const SurfacePoint point = surfaces_->sample(surface_, i, place);
        sum += Vec3d(texture.at(point.uv)) / static_cast<double>(point.pdf);
      }
      const Vec3d part = sum * (cell_share / (points * points));
      integral += part;
      weights.push_back(max_component(part));
      shares.push_back(cell_share);
    }
  }
  integral_ = Rgb(integral);
  double whole = 0;
  for (const double weight : weights)
    whole += weight;
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += whole > 0 ? (1 - uniform_share) * weights[i] / whole + uniform_share * shares[i]
                     : shares[i];
    until_.push_back(sum);
  }
}

double EmissionCells::share(std::size_t primitive) const {
  return surfaces_->share_before(surface_, primitive + 1) -
         surfaces_->share_before(surface_, primitive);
}

std::size_t EmissionCells::cell_at(std::size_t primitive, const AreaPlace& place) const {
  const std::uint32_t side = sides_[primitive];
  const auto index = [&](double x) {
    return static_cast<std::size_t>(std::clamp(x * side, 0.0, side - 1.0));
  };
  return first_[primitive] + index(place.u) * side + index(place.v);
}

double EmissionCells::density(std::size_t primitive, std::size_t cell) const {
  const double before = cell == 0 ? 0 : until_[cell - 1];
  const double side = sides_[primitive];
  return (until_[cell] - before) / until_.back() / (share(primitive) / (side * side));
}

SurfacePoint EmissionCells::sample(double place, double u, double v) const {
  const auto found =
      std::upper_bound(until_.begin(), until_.end() - 1, place * until_.back()) - until_.begin();
  const auto cell = static_cast<std::size_t>(found);
  const auto after = std::upper_bound(first_.begin(), first_.end() - 1, cell);
  const auto primitive = static_cast<std::size_t>(after - first_.begin()) - 1;
  const std::size_t side = sides_[primitive], local = cell - first_[primitive];
  const auto width = static_cast<double>(side);
  SurfacePoint point =
      surfaces_->sample(surface_, primitive,
                        AreaPlace{(static_cast<double>(local / side) + u) / width,
                                  (static_cast<double>(local % side) + v) / width});
  point.pdf *= static_cast<float>(density(primitive, cell));
  return point;
}

float EmissionCells::pdf(std::size_t primitive, const Vec3d& position, const Vec3f& normal) const {
  const std::size_t cell = cell_at(primitive, surfaces_->place_of(surface_, primitive, position));
  return surfaces_->sample_pdf(surface_, normal) * static_cast<float>(density(primitive, cell));
}

} // namespace vdbeam
