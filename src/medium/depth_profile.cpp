#include "medium/depth_profile.h"

namespace vdbeam {

void DepthProfile::build(const Medium& medium, const Segment& segment, float cutoff,
                         const RayAir& air) {
  air_ = air;
  t_.clear();
  tau_.clear();
  met_.clear();
  volumes_ = 0;
  if (segment.empty())
    return;
  const float limit = -std::log(std::max(cutoff, 1e-30f));
  if (medium.volumes.size() == 1) {
    met_.push_back(0);
    volumes_ = 1;
    build_single(medium.volumes[0], segment, limit);
  } else {
    build_several(medium, segment, limit);
  }
}

namespace {

float weakest_channel(const Volume& volume) {
  const Rgb& scale = volume.channel_scale;
  return std::min(scale.x, std::min(scale.y, scale.z));
}

/// Parts of a piece at most: more than can be seen of it, unless a channel sees far.
constexpr float most_pieces = 1024;

} // namespace

void DepthProfile::build_single(const Volume& volume, const Segment& segment, float limit) {
  const float weakest = weakest_channel(volume);
  float sum = 0;
  for_each_piece(volume, segment, [&](float t_a, float t_b, float piece) {
    if (t_.empty() ? piece > 0 : t_.back() < t_a) { // the start, or an empty stretch
      t_.push_back(t_a);
      tau_.push_back(sum);
    }
    if (t_.empty())
      return true;
    // Within an optically thick piece a straight line is far from the truth, so it is cut up.
    const int parts = static_cast<int>(std::min(most_pieces, std::ceil(piece)));
    float t = t_a;
    for (int i = 1; i < parts && sum * weakest < limit; ++i) {
      const float t_next = t_a + (t_b - t_a) * static_cast<float>(i) / static_cast<float>(parts);
      sum += cube_optical_depth(volume, segment.ray, t, t_next);
      t_.push_back(t_next);
      tau_.push_back(sum);
      t = t_next;
    }
    sum += t > t_a ? cube_optical_depth(volume, segment.ray, t, t_b) : piece;
    t_.push_back(t_b);
    tau_.push_back(sum);
    return sum * weakest < limit;
  });
}

void DepthProfile::build_several(const Medium& medium, const Segment& segment, float limit) {
  std::vector<DepthProfile> parts;
  medium.for_each_met(segment, [&](std::size_t v) {
    DepthProfile part;
    part.build_single(medium.volumes[v], segment, limit);
    if (part.empty())
      return;
    t_.insert(t_.end(), part.t_.begin(), part.t_.end());
    met_.push_back(static_cast<std::uint32_t>(v));
    parts.push_back(std::move(part));
  });
  volumes_ = met_.size();
  std::sort(t_.begin(), t_.end());
  t_.erase(std::unique(t_.begin(), t_.end()), t_.end());
  tau_.resize(t_.size() * volumes_);
  for (std::size_t v = 0; v < volumes_; ++v)
    read_at_knots(parts[v], medium.volumes[met_[v]], segment.ray, v);
}

/// Optical depth of volume v, whose own profile is `part`, at every knot. Knots of other volumes
/// lie inside its cubes, where it is integrated anew: interpolation would not be exact.
void DepthProfile::read_at_knots(const DepthProfile& part, const Volume& volume, const Ray& ray,
                                 std::size_t v) {
  std::size_t own = 0;
  for (std::size_t knot = 0; knot < t_.size(); ++knot) {
    const float t = t_[knot];
    while (own + 1 < part.knots() && part.t(own + 1) <= t)
      ++own;
    float tau = part.tau(own);
    if (t > part.t(own) && own + 1 < part.knots() && part.tau(own + 1) > tau)
      tau = std::min(tau + cube_optical_depth(volume, ray, part.t(own), t), part.tau(own + 1));
    tau_[knot * volumes_ + v] = tau;
  }
}

float DepthProfile::sharpest_piece() const {
  float sharpest = 0, before = 0;
  for (std::size_t knot = 1; knot < t_.size(); ++knot) {
    const float after = total(knot);
    sharpest = std::max(sharpest, (after - before) * std::exp(-before));
    before = after;
  }
  return sharpest;
}

float DepthProfile::opacity_depth(const Medium& medium) const {
  float sum = 0;
  const int channels = medium.chromatic ? 3 : 1;
  for (int c = 0; c < channels; ++c) {
    float tau = 0, before = 1;
    for (std::size_t knot = 1; knot < t_.size(); ++knot) {
      const float tau_after = this->channels(medium, knot)[c];
      const float piece = tau_after - tau;
      const float t = t_[knot - 1] + mean_collision(piece) * (t_[knot] - t_[knot - 1]);
      sum += before * opacity_of(piece) * t; // a difference of exponentials would lose digits
      tau = tau_after;
      before = std::exp(-tau_after);
    }
  }
  return sum / static_cast<float>(channels);
}

} // namespace vdbeam
