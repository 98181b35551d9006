#include "transport/depth_profile.h"

namespace vdbeam {

void DepthProfile::build(const Medium& medium, const Ray& ray, float t_begin, float t_end,
                         float cutoff) {
  t_.clear();
  tau_.clear();
  volumes_ = medium.volumes.size();
  if (!(t_begin < t_end))
    return;
  const float limit = -std::log(std::max(cutoff, 1e-30f));
  if (volumes_ == 1)
    build_single(medium.volumes[0], ray, t_begin, t_end, limit);
  else
    build_several(medium, ray, t_begin, t_end, limit);
}

namespace {

float weakest_channel(const Volume& volume) {
  const Rgb& scale = volume.channel_scale;
  return std::min(scale.x, std::min(scale.y, scale.z));
}

} // namespace

void DepthProfile::build_single(const Volume& volume, const Ray& ray, float t_begin, float t_end,
                                float limit) {
  const float weakest = weakest_channel(volume);
  float sum = 0;
  walk_segments(volume, ray, t_begin, t_end, [&](float t_a, float t_b, float piece) {
    if (t_.empty() ? piece > 0 : t_.back() < t_a) { // the start, or an empty stretch
      t_.push_back(t_a);
      tau_.push_back(sum);
    }
    if (t_.empty())
      return true;
    sum += piece;
    t_.push_back(t_b);
    tau_.push_back(sum);
    return sum * weakest < limit;
  });
}

void DepthProfile::build_several(const Medium& medium, const Ray& ray, float t_begin, float t_end,
                                 float limit) {
  std::vector<DepthProfile> parts(volumes_);
  for (std::size_t v = 0; v < volumes_; ++v) {
    parts[v].build_single(medium.volumes[v], ray, t_begin, t_end, limit);
    t_.insert(t_.end(), parts[v].t_.begin(), parts[v].t_.end());
  }
  std::sort(t_.begin(), t_.end());
  t_.erase(std::unique(t_.begin(), t_.end()), t_.end());
  tau_.resize(t_.size() * volumes_);
  for (std::size_t v = 0; v < volumes_; ++v) {
    if (parts[v].empty())
      continue;
    ProfileCursor cursor(parts[v]);
    for (std::size_t knot = 0; knot < t_.size(); ++knot) {
      cursor.move_to(t_[knot]);
      tau_[knot * volumes_ + v] = cursor.tau();
    }
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

float DepthProfile::opacity_depth() const {
  float sum = 0, before = 1;
  for (std::size_t knot = 1; knot < t_.size(); ++knot) {
    const float after = std::exp(-total(knot));
    sum += (before - after) * 0.5f * (t_[knot - 1] + t_[knot]);
    before = after;
  }
  return sum;
}

} // namespace vdbeam
