#include "transport/similar_medium.h"

#include "phase/truncated_phase.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// Passes of the first order. Measured on backlit and on Mie clouds: the bias of order 4 is under
/// the noise of as many passes (docs/decisions.md).
constexpr int passes_of_first_order = 64;

/// The first order takes no larger share than this for a peak. With more, light that is scattered
/// twice by small angles, towards which one looks at a sun through the medium, is too dark.
constexpr float largest_first_peak = 0.6f;

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

PassWorlds::PassWorlds(const World& world, bool take_out)
    : world_(world), take_out_(take_out), first_order_(least_truncation_order) {
  const auto leaves_enough = [&](const PhaseFunction& phase) {
    return truncate_peak(phase, first_order_).forward <= largest_first_peak;
  };
  if (take_out)
    while (first_order_ < most_truncation_order &&
           !std::all_of(world.medium.phases.begin(), world.medium.phases.end(), leaves_enough))
      ++first_order_;
}

int PassWorlds::order(int pass) const {
  int result = first_order_;
  for (std::int64_t until = passes_of_first_order; pass >= until && result < most_truncation_order;
       until *= 3)
    ++result;
  return result;
}

const World& PassWorlds::of(int pass) {
  if (!take_out_)
    return world_;
  if (order_ != order(pass)) {
    order_ = order(pass);
    similar_.reset();
    if (const auto medium = similar_medium(world_.medium, order_)) {
      similar_ = std::make_unique<World>(world_);
      similar_->medium = *medium;
    }
  }
  return similar_ ? *similar_ : world_;
}

} // namespace vdbeam
