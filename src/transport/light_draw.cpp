#include "transport/light_draw.h"

#include "tuning/constants.h"

#include <numbers>

namespace vdbeam {

void draw_systematically(std::vector<DrawnLight>& candidates, std::size_t first, std::size_t count,
                         Rng& rng) {
  const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(first);
  candidates.erase(std::remove_if(begin, candidates.end(),
                                  [](const DrawnLight& drawn) { return !(drawn.weight > 0); }),
                   candidates.end());
  if (candidates.size() - first <= 2 * count) {
    for (std::size_t i = first; i < candidates.size(); ++i)
      candidates[i].weight = 1;
    return;
  }
  // Without those that are certain, the step between draws is shorter, and others may be certain.
  // The rest is summed anew each time: beside a very bright lamp that is subtracted it would be
  // lost in rounding.
  std::size_t certain = first;
  double sum = 0;
  for (bool found = true; found && count > 0;) {
    found = false;
    sum = 0;
    for (std::size_t i = certain; i < candidates.size(); ++i)
      sum += static_cast<double>(candidates[i].weight);
    const double step = sum / static_cast<double>(count);
    for (std::size_t i = certain; i < candidates.size() && count > 0; ++i)
      if (static_cast<double>(candidates[i].weight) >= step) {
        --count;
        candidates[i].weight = 1;
        std::swap(candidates[i], candidates[certain++]);
        found = true;
      }
  }
  std::size_t kept = certain;
  if (count > 0) {
    const double step = sum / static_cast<double>(count);
    double next = static_cast<double>(rng.uniform()) * step, passed = 0;
    for (std::size_t i = certain; i < candidates.size(); ++i) {
      const auto weight = static_cast<double>(candidates[i].weight);
      passed += weight;
      if (passed <= next)
        continue;
      candidates[kept++] = {candidates[i].light, static_cast<float>(step / weight)};
      next += step;
    }
  }
  candidates.resize(kept, {0});
}

float lamp_importance(const Light& lamp, const Segment& segment) {
  const Vec3d to_lamp = *lamp.position() - Vec3d(segment.ray.origin);
  const Vec3d direction(segment.ray.direction);
  const double begin{segment.t_begin}, end{segment.t_end}, reach{end - begin};
  const double nearest = std::clamp(dot(to_lamp, direction), begin, end);
  const double distance = std::max(length(to_lamp - direction * nearest), 1e-6 * reach);
  const double integral = reach / (distance * (distance + reach / std::numbers::pi));
  return static_cast<float>(static_cast<double>(lamp.typical_intensity()) * integral);
}

std::size_t LightDraw::most() {
  return static_cast<std::size_t>(tuning::lamps_per_vertex);
}

LightDraw::LightDraw(const LightSet& lights, const std::vector<bool>& sampled) : lights_(&lights) {
  for (std::size_t l = 0; l < lights.size(); ++l)
    if (sampled[l] && lights[l].position())
      lamps_.push_back(l);
  if (lamps_.size() <= 2 * most())
    lamps_.clear();
  for (std::size_t l = 0; l < lights.size(); ++l)
    if (sampled[l] && (lamps_.empty() || !lights[l].position()))
      others_.push_back(l);
}

} // namespace vdbeam
