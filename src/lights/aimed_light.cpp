#include "lights/aimed_light.h"

namespace vdbeam {

AimedLight::AimedLight(std::vector<Aim> aims, std::size_t medium_aim)
    : aims_(std::move(aims)), medium_aim_(medium_aim) {
  // Lights share the photons by what they send to the medium, and by a part of what they send to
  // the surfaces around it. Shares by all of their flux would leave a lamp over a wide ground
  // without photons.
  constexpr float sent_on = 0.1f;
  power_ = light().power();
  if (aims_.size() > medium_aim + 1)
    power_ += aims_[medium_aim + 1].light->power() * sent_on;
  for (std::size_t i = 0; i <= medium_aim; ++i)
    fluxes_to_medium_.push_back(max_component(aims_[i].light->power()) /
                                static_cast<float>(aims_[i].share));
}

EmittedPhoton AimedLight::emit(double place, Rng& rng) const {
  std::size_t i = 0;
  while (i + 1 < aims_.size() && place >= aims_[i].share)
    place -= aims_[i++].share;
  const Aim& aim = aims_[i];
  EmittedPhoton photon = aim.light->emit(std::clamp(place / aim.share, 0.0, 1 - 0x1p-32), rng);
  photon.flux *= static_cast<float>(1 / aim.share);
  photon.fluxes_to_medium = fluxes_to_medium_;
  photon.first_target = aim.first_target;
  photon.last_target = aim.last_target;
  return photon;
}

} // namespace vdbeam
