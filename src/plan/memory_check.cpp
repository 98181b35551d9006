#include "plan/memory_check.h"

#include "layers/plane_layers.h"
#include "lights/light_groups.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <filesystem>
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
           "raise image.deep_alpha or image.deep_depth, or render a smaller image");
}

std::optional<MemoryPlan> plan_large_frame(const Scene& scene, int references,
                                           std::uint64_t granted) {
  // Bricks take 40 bytes for each byte of a file that holds nothing but leaves of one value; steps
  // of the preparation need a second field, and cubic interpolation one of eight times the size.
  constexpr double bytes_per_byte = 160, of_cubic = 10, bytes_per_pixel = 1000;
  double bound = 1e9 +
                 bytes_per_pixel * scene.image.raster_width() * scene.image.raster_height() *
                     (1.0 + static_cast<double>(light_group_names(scene).size())) +
                 200 * static_cast<double>(scene.render.photons.value_or(0));
  for (const VolumeSettings& volume : scene.volumes) {
    std::error_code error;
    const double bytes = static_cast<double>(std::filesystem::file_size(volume.file, error));
    const bool may_grow = volume.noise.amplitude > 0 || !scene.moments.empty() || error;
    bound += may_grow ? std::numeric_limits<double>::infinity()
                      : bytes * bytes_per_byte *
                            (volume.interpolation == Interpolation::cubic ? of_cubic : 1);
  }
  if (bound < 0.5 * static_cast<double>(granted) && scene.surfaces.empty() && !scene.image.deep)
    return std::nullopt;
  try {
    return plan_memory(scene, references);
  } catch (const Error&) {
    return std::nullopt; // reading the files says what is wrong with them
  }
}

void check_planned_memory(const Scene& scene, const MemoryPlan& plan, std::uint64_t granted) {
  if (plan.peak() > granted)
    throw InputError(fmt::format("{}: the frame would take {} of the {} that this machine grants, "
                                 "most of it for {}: {}",
                                 scene.path.empty() ? "scene" : scene.path, gigabytes(plan.peak()),
                                 gigabytes(granted), plan.largest_part, plan.remedy));
}

void check_memory(const Scene& scene, const RenderPlan& plan, std::uint64_t granted) {
  const std::uint64_t photons = scene.render.photons.value_or(0);
  if (plan.needs(Stage::photons) && (plan.photon_bytes > granted || photons > most_photons))
    refuse(scene, fmt::format("render.photons: a map of {} photons", photons), plan.photon_bytes,
           granted, "use fewer photons and more passes, which give the same image");
  if (plan.film_bytes <= granted)
    return;
  const std::string size = fmt::format("{} x {} pixels", scene.image.width, scene.image.height);
  if (const std::size_t planes = plane_names(scene).size(); planes > 0)
    refuse(scene, fmt::format("image: {} with {} channels of layers", size, planes),
           plan.film_bytes, granted, "render a smaller image or fewer layers");
  refuse(scene, "image: " + size, plan.film_bytes, granted, "render a smaller image");
}

} // namespace vdbeam
