#include "lights/aimed_light.h"

namespace vdbeam {

AimedLight::AimedLight(std::vector<Aim> aims) : aims_(std::move(aims)) {
  // Lights share the photons by what they send to the medium, and by a part of what they send to
  // the surfaces around it. Shares by all of their flux would leave a lamp over a wide ground
  // without photons.
  constexpr float sent_on = 0.1f;
  power_ = light().power();
  if (aims_.size() > 1)
    power_ += aims_[1].light->power() * sent_on;
  flux_to_medium_ = max_component(light().power()) / static_cast<float>(aims_[0].share);
}

EmittedPhoton AimedLight::emit(double place, Rng& rng) const {
  std::size_t i = 0;
  while (i + 1 < aims_.size() && place >= aims_[i].share)
    place -= aims_[i++].share;
  const Aim& aim = aims_[i];
  EmittedPhoton photon = aim.light->emit(std::clamp(place / aim.share, 0.0, 1 - 0x1p-32), rng);
  photon.flux *= static_cast<float>(1 / aim.share);
  photon.flux_to_medium = flux_to_medium_;
  photon.first_target = aim.first_target;
  photon.last_target = aim.last_target;
  return photon;
}

} // namespace vdbeam
