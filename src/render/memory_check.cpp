#include "render/memory_check.h"

#include "estimators/plane_layers.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <limits>

namespace vdbeam {

namespace {

/// The map numbers its photons with 32 bits.
constexpr std::uint64_t most_photons = std::numeric_limits<std::uint32_t>::max();

std::string gigabytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} GB", static_cast<double>(bytes) * 1e-9);
}

[[noreturn]] void refuse(const Scene& scene, const std::string& what, std::uint64_t needed,
                         std::uint64_t granted, const std::string& remedy) {
  throw InputError(fmt::format("{}: {} would take {} of the {} that this machine grants: {}",
                               scene.path.empty() ? "scene" : scene.path, what, gigabytes(needed),
                               gigabytes(granted), remedy));
}

} // namespace

void check_deep_memory(const Scene& scene, std::uint64_t bytes, std::uint64_t granted) {
  if (bytes > granted)
    refuse(scene, "image.deep: its samples", bytes, granted,
           "ask for fewer by greater image.deep_alpha and image.deep_depth, or for a smaller "
           "picture");
}

void check_memory(const Scene& scene, const RenderPlan& plan, std::uint64_t granted) {
  const std::uint64_t photons = scene.render.photons.value_or(0);
  if (plan.needs(Stage::photons) && (plan.photon_bytes > granted || photons > most_photons))
    refuse(scene, fmt::format("render.photons: a map of {} photons", photons), plan.photon_bytes,
           granted, "ask for fewer photons and more passes, which give the same picture");
  if (plan.film_bytes <= granted)
    return;
  const std::string size = fmt::format("{} x {} pixels", scene.image.width, scene.image.height);
  if (const std::size_t planes = plane_names(scene).size(); planes > 0)
    refuse(scene, fmt::format("image: {} with {} channels of layers", size, planes),
           plan.film_bytes, granted, "ask for a smaller picture or fewer layers");
  refuse(scene, "image: " + size, plan.film_bytes, granted, "ask for a smaller picture");
}

} // namespace vdbeam
