#pragma once

#include "layers/ray_sink.h"
#include "math/rng.h"
#include "math/stop_token.h"
#include "medium/depth_profile.h"
#include "medium/shadow_lattice.h"
#include "transport/world.h"

#include <memory>

namespace vdbeam {

/// By light; null for lights that do without.
using ShadowLattices = std::vector<std::unique_ptr<const ShadowLattice>>;

/// Which lights shadow rays look for along a camera ray, and how.
struct LightSampling {
  const std::vector<bool>& sampled; ///< per light: it is looked for
  int samples = 1;
  const ShadowLattices* shadows = nullptr; ///< null: there are none
  const StopToken* stop = nullptr;         ///< asks to end meanwhile: the result is of no use then
  float weight = 1;                        ///< factor of all that they find
};

/// Single scattering along a camera ray by shadow rays: distances are drawn from the depth profile
/// by inverse CDF, stratified over the samples; at each, next-event estimation, with multiple
/// importance sampling against the phase function for lights that a ray can meet. Lights near the
/// ray also get distances drawn by their 1 / r^2 (EquiAngular), combined by the balance heuristic.
/// Lights with a shadow lattice (grey media only) get distances of their own, drawn by what
/// scatters times what of the light is expected there. Adds the number of traced rays to
/// `shadow_rays`, and the light to `sink`.
GroupedLight direct_light(const World& world, const Ray& ray, const DepthProfile& profile,
                          const LightSampling& sampling, Rng& rng, std::uint64_t& shadow_rays,
                          const RaySink& sink = {});

/// A lattice for each light that is sampled and comes from one direction; `rays`: shadow rays to
/// spend on each.
ShadowLattices make_shadow_lattices(const World& world, const std::vector<bool>& sampled,
                                    double rays);

} // namespace vdbeam
