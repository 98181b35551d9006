#include "transport/similar_medium.h"

#include "medium/nest_bounds.h"

#include "math/sampling.h"
#include "medium/optical_depth.h"
#include "phase/truncated_phase.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// The volume with the share `f` of its scattering taken for no scattering; adds to `peak` what
/// leads back.
Volume similar_volume(const Volume& volume, float f, PeakTakenOut& peak) {
  Volume similar = volume;
  const Rgb scale = volume.channel_scale * (Rgb(1) - volume.albedo * f);
  const float strongest = max_component(scale);
  similar.extinction = volume.extinction * strongest;
  similar.channel_scale = scale / strongest;
  for (int c = 0; c < 3; ++c)
    similar.albedo[c] = volume.albedo[c] * (1 - f) / (1 - volume.albedo[c] * f);
  peak.extinction_factor.push_back(1 / strongest);
  peak.excess.push_back(volume.channel_scale / strongest - similar.channel_scale);
  return similar;
}

/// The same of lines through the sphere around a box.
double typical_depth(const Medium& medium, const Boxf& box) {
  constexpr std::uint64_t lines = 512;
  const Vec3f centre = box.center();
  const float radius = length(box.upper - centre);
  double sum = 0, squares = 0;
  for (std::uint64_t line = 0; line < lines; ++line) {
    Rng rng({}, RngStage::line, line);
    const float u = rng.uniform(), v = rng.uniform();
    const Vec3f direction = sample_sphere(u, v);
    Vec3f across, up;
    orthonormal_frame(direction, across, up);
    const float r = radius * std::sqrt(rng.uniform()), phi = 2 * pi * rng.uniform();
    const Vec3f origin =
        centre + across * (r * std::cos(phi)) + up * (r * std::sin(phi)) - direction * radius;
    const double through =
        max_component(exact_transmittance(medium, {{origin, direction}, 0, 2 * radius}));
    const double depth =
        std::min<double>(opaque_optical_depth, -std::log(std::max(1e-30, through)));
    sum += depth;
    squares += depth * depth;
  }
  return sum > 0 ? squares / sum : 0;
}

} // namespace

std::shared_ptr<const Medium> similar_medium(const Medium& medium, int order) {
  auto peak = std::make_shared<PeakTakenOut>();
  peak->order = order;
  auto similar = std::make_shared<Medium>(medium);
  bool any = false;
  for (PhaseFunction& phase : similar->phases) {
    TruncatedPhase truncated = truncate_peak(phase, order);
    any = any || truncated.forward > 0;
    peak->original.push_back(phase);
    peak->forward.push_back(truncated.forward);
    peak->aureoles.push_back(truncated.forward > 0 ? Aureole(phase, truncated, order) : Aureole());
    peak->gathered.push_back(truncated.gathered);
    phase = truncated.traced;
  }
  if (!any)
    return nullptr;
  for (Volume& volume : similar->volumes) {
    volume =
        similar_volume(volume, peak->forward[static_cast<std::size_t>(volume.phase_index)], *peak);
    const Rgb& scale = volume.channel_scale;
    similar->chromatic = similar->chromatic || scale.x != scale.y || scale.y != scale.z;
  }
  similar->peak = std::move(peak);
  return similar;
}

float truncation(const Medium& medium) {
  float most = 0;
  for (std::size_t i = 0; medium.peak && i < medium.peak->original.size(); ++i) {
    if (!(medium.peak->forward[i] > 0))
      continue;
    const auto order = static_cast<std::size_t>(medium.peak->order);
    const std::vector<double> moments =
        legendre_moments(medium.peak->original[i], medium.peak->order + 3);
    const double widened = std::max(0.0, moments[order] - moments[order + 2]);
    most = std::max(most, static_cast<float>(widened * widened));
  }
  return most;
}

double typical_depth(const Medium& medium) {
  if (medium.empty())
    return 0;
  double depth = typical_depth(medium, medium.bounds);
  for (const std::vector<std::size_t>& nest : medium.nests) // next to no line would meet it
    depth = std::max(depth, typical_depth(medium, nest_bounds(medium, nest)));
  return depth;
}

const World& PassWorlds::of(int order) {
  if (order == 0)
    return world_;
  const auto [at, is_new] = similar_.try_emplace(order);
  if (is_new)
    if (const auto medium = similar_medium(world_.medium, order)) {
      at->second = std::make_unique<World>(world_);
      at->second->medium = *medium;
    }
  return at->second ? *at->second : world_;
}

} // namespace vdbeam
