#include "rays/make_deep_layout.h"

#include "math/pass_numbers.h"
#include "medium/depth_profile.h"
#include "transport/camera_ray.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace vdbeam {
namespace {

constexpr std::size_t rays_per_pixel = 4;
constexpr double most_pieces_by_depth = 1000;

/// Opacity up to a distance.
struct Knot {
  double distance, opacity;
};

/// Data common to a pixel's rays.
class PixelCurve {
public:
  explicit PixelCurve(const EstimatorInput& input) : input_(input) {}

  /// Distances [world] in ascending order with the mean opacity of a few rays; empty where they
  /// meet nothing.
  const std::vector<Knot>& trace(int x, int y) {
    const std::size_t pixel = static_cast<std::size_t>(y) * input_.camera.width() + x;
    knots_.clear();
    for (std::size_t i = 0; i < rays_per_pixel; ++i) {
      Rng rng({input_.settings.seed, input_.frame, layout_pass}, RngStage::camera,
              pixel * rays_per_pixel + i);
      cameras_[i] = camera_ray(input_.world, input_.camera, input_.camera.sample(x, y, rng));
      profiles_[i].build(input_.world.medium, cameras_[i].segment,
                         static_cast<float>(input_.settings.cutoff));
      add_knots(i);
    }
    std::sort(knots_.begin(), knots_.end(),
              [](const Knot& a, const Knot& b) { return a.distance < b.distance; });
    for (std::size_t i = 0; i < rays_per_pixel; ++i)
      if (!profiles_[i].empty())
        add_opacity(i);
    return knots_;
  }

private:
  double distance(std::size_t ray, float t) const {
    return (static_cast<double>(t) + cameras_[ray].shift) / input_.world.space.scale;
  }

  void add_knots(std::size_t ray) {
    for (std::size_t k = 0; !profiles_[ray].empty() && k < profiles_[ray].knots(); ++k)
      knots_.push_back({distance(ray, profiles_[ray].t(k)), 0});
    const Segment& segment = cameras_[ray].segment;
    if (!input_.world.medium.emitters.empty() && !segment.empty())
      for (const float t : {segment.t_begin, segment.t_end})
        knots_.push_back({distance(ray, t), 0});
  }

  void add_opacity(std::size_t ray) {
    const DepthProfile& profile = profiles_[ray];
    ProfileCursor cursor(profile);
    for (Knot& knot : knots_) {
      cursor.move_to(
          static_cast<float>(knot.distance * input_.world.space.scale - cameras_[ray].shift));
      const Rgb tau = cursor.channels(input_.world.medium);
      double opacity = 0;
      for (int c = 0; c < 3; ++c)
        opacity -= std::expm1(-static_cast<double>(tau[c]));
      knot.opacity += opacity / (3 * rays_per_pixel);
    }
  }

  const EstimatorInput& input_;
  std::array<CameraRay, rays_per_pixel> cameras_;
  std::array<DepthProfile, rays_per_pixel> profiles_;
  std::vector<Knot> knots_;
};

/// Cuts a curve of opacity into pieces.
class Cutter {
public:
  Cutter(double alpha, double depth, bool glows) : alpha_(alpha), depth_(depth), glows_(glows) {}

  /// Appends the edges.
  void cut(const std::vector<Knot>& knots, std::vector<float>& edges) {
    edges_ = &edges;
    begin_ = edges.size();
    const double span = knots.back().distance - knots.front().distance;
    longest_ = std::max(depth_, span / most_pieces_by_depth);
    last_ = knots.front();
    edges.push_back(static_cast<float>(last_.distance));
    for (std::size_t k = 0; k + 1 < knots.size(); ++k)
      add(knots[k], knots[k + 1]);
    add_edge(knots.back());
    if (edges.size() == begin_ + 1) // everything in one place
      edges.push_back(std::nextafter(edges.back(), infinity));
  }

private:
  void add(const Knot& a, const Knot& b) {
    const double length = b.distance - a.distance;
    if (b.opacity == a.opacity && !glows_ && length > 0.25 * longest_) {
      add_edge(a);
      add_edge(b);
      return;
    }
    for (;;) {
      double distance = infinity;
      if (b.opacity > last_.opacity + alpha_)
        distance =
            a.distance + length * (last_.opacity + alpha_ - a.opacity) / (b.opacity - a.opacity);
      distance = std::min(distance, last_.distance + longest_);
      if (!(distance < b.distance) || !(distance > last_.distance))
        return;
      const double share = length > 0 ? (distance - a.distance) / length : 1;
      add_edge({distance, a.opacity + share * (b.opacity - a.opacity)});
    }
  }

  /// Unless single precision has no place for it.
  void add_edge(const Knot& knot) {
    last_ = knot;
    const auto edge = static_cast<float>(knot.distance);
    if (edge > edges_->back())
      edges_->push_back(edge);
  }

  double alpha_, depth_;
  bool glows_;
  double longest_ = 0;
  Knot last_{};
  std::vector<float>* edges_ = nullptr;
  std::size_t begin_ = 0;
};

/// The most by which a curve's opacity differs from that of homogeneous pieces, which go through it
/// at `count` + 1 edges.
double largest_error(const std::vector<Knot>& knots, const float* edges, std::size_t count) {
  double largest = 0;
  std::size_t k = 0;
  const auto opacity_at = [&](double distance) {
    while (k + 2 < knots.size() && knots[k + 1].distance < distance)
      ++k;
    const double length = knots[k + 1].distance - knots[k].distance;
    const double share =
        length > 0 ? std::clamp((distance - knots[k].distance) / length, 0.0, 1.0) : 1;
    return knots[k].opacity + share * (knots[k + 1].opacity - knots[k].opacity);
  };
  double begin = opacity_at(static_cast<double>(edges[0]));
  for (std::size_t i = 0; i < count; ++i) {
    const auto a = static_cast<double>(edges[i]), b = static_cast<double>(edges[i + 1]);
    const std::size_t from = k;
    const double end = opacity_at(b);
    const double kept = std::max(1e-12, 1 - end) / std::max(1e-12, 1 - begin);
    for (std::size_t j = from; j < knots.size() && knots[j].distance < b; ++j)
      if (knots[j].distance > a) {
        const double share = (knots[j].distance - a) / (b - a);
        const double homogeneous = 1 - (1 - begin) * std::pow(kept, share);
        largest = std::max(largest, std::abs(homogeneous - knots[j].opacity));
      }
    begin = end;
  }
  return largest;
}

/// Pieces of one row of the image.
struct Row {
  std::vector<std::uint32_t> counts;
  std::vector<float> edges, cosines;
  double error = 0;
};

/// Where the medium lies between, for pixels whose few rays missed it.
std::array<float, 2> whole_range(const EstimatorInput& input) {
  const auto& region = input.world.region;
  const double scale = input.world.space.scale;
  const double away = length(Vec3d(region.center) - input.camera.origin()) / scale;
  const double radius = 1.001 * static_cast<double>(region.radius) / scale;
  return {static_cast<float>(std::max(0.0, away - radius)), static_cast<float>(away + radius)};
}

} // namespace

DeepLayout make_deep_layout(const EstimatorInput& input, double alpha, double depth,
                            const std::function<void(std::size_t pieces)>& check) {
  const Camera& camera = input.camera;
  PixelRegion window{0, 0, camera.width(), camera.height()};
  if (!input.window.empty())
    window = input.window;
  const std::array<float, 2> range = whole_range(input);
  std::vector<Row> rows(static_cast<std::size_t>(camera.height()));
  std::atomic<std::size_t> pieces_so_far = 0;
  const auto cut_row = [&](int y) {
    Row& row = rows[static_cast<std::size_t>(y)];
    PixelCurve curve(input);
    Cutter cutter(alpha, depth, !input.world.medium.emitters.empty());
    for (int x = 0; x < camera.width() && !input.stopped(); ++x) {
      row.cosines.push_back(static_cast<float>(camera.depth_over_distance(x + 0.5, y + 0.5)));
      const bool wanted = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
      const std::size_t begin = row.edges.size();
      if (wanted) {
        const std::vector<Knot>& knots = curve.trace(x, y);
        if (knots.size() > 1) {
          cutter.cut(knots, row.edges);
          row.error = std::max(row.error, largest_error(knots, row.edges.data() + begin,
                                                        row.edges.size() - begin - 1));
        } else {
          row.edges.insert(row.edges.end(), range.begin(), range.end());
        }
      }
      const std::size_t edges = row.edges.size() - begin;
      row.counts.push_back(edges > 0 ? static_cast<std::uint32_t>(edges - 1) : 0);
    }
    std::size_t pieces = 0;
    for (const std::uint32_t count : row.counts)
      pieces += count;
    check(pieces_so_far += pieces);
  };
  tbb::parallel_for(0, camera.height(), cut_row);
  DeepLayout layout;
  if (input.stopped())
    return layout;
  std::size_t pieces = 0;
  for (Row& row : rows) {
    std::size_t edge = layout.edges.size();
    for (const std::uint32_t count : row.counts) {
      layout.first.push_back(static_cast<std::uint32_t>(pieces));
      layout.first_edge.push_back(edge);
      pieces += count;
      edge += count > 0 ? std::size_t{count} + 1 : 0;
    }
    layout.edges.insert(layout.edges.end(), row.edges.begin(), row.edges.end());
    layout.cosines.insert(layout.cosines.end(), row.cosines.begin(), row.cosines.end());
    layout.alpha_error = std::max(layout.alpha_error, static_cast<float>(row.error));
    row = {};
  }
  layout.first.push_back(static_cast<std::uint32_t>(pieces));
  return layout;
}

DeepLayout cut_out(const DeepLayout& layout, int width, const PixelRegion& window) {
  DeepLayout part;
  part.edges = layout.edges;
  part.alpha_error = layout.alpha_error;
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      part.first.push_back(layout.first[pixel]);
      part.first_edge.push_back(layout.first_edge[pixel]);
      part.cosines.push_back(layout.cosines[pixel]);
    }
  part.first.push_back(static_cast<std::uint32_t>(layout.pieces()));
  return part;
}

} // namespace vdbeam
