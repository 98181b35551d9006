#include "prepare/prepared_scene.h"

#include "geometry/gltf/gltf_files.h"
#include "keys/scene_keys.h"
#include "lights/sky/aerial_perspective.h"
#include "machine/memory.h"
#include "machine/stop_reading.h"
#include "machine/stopwatch.h"
#include "prepare/read_volumes.h"
#include "scene/working_space.h"
#include "text/text.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace vdbeam {
namespace {

/// The values of all keys that `wanted` names.
template <class Wanted>
std::string settings_text(const Scene& scene, const Wanted& wanted) {
  std::string text;
  for (const SceneKey& key : scene_keys()) {
    if (!key.get || !wanted(key))
      continue;
    for (std::size_t i = 0; i < section_count(scene, key.section); ++i) {
      const std::string value = key.format(key.get(scene, i));
      text += key_path(key, i) + "=" + value + ";";
      if (key.kind == KeyKind::file)
        text += model_identity(std::get<std::string>(key.get(scene, i))) + ";";
    }
  }
  return text;
}

/// Every value that a world is made from. Sizes and cameras are not among them, but for the way up,
/// about which skies turn, and the altitude where it decides about the air.
std::string world_settings(const Scene& scene) {
  std::string text = settings_text(scene, [](const SceneKey& key) { return key.changes_world; });
  for (const VolumeSettings& volume : scene.volumes)
    text += volume.present ? "+" : "-";
  for (const SurfaceSettings& surface : scene.surfaces)
    text += fmt::format("{}/{};", surface.file_seconds.value_or(-1),
                        fmt::join(surface.material.texture_images, ","));
  if (light_with_air(scene.lights) >= 0)
    for (const LightSettings& light : lights_at_camera(scene))
      text += fmt::format("{};", light.altitude);
  return text;
}

std::string photon_settings(const Scene& scene) {
  return settings_text(scene,
                       [](const SceneKey& key) { return key.section == SceneSection::render; });
}

void keep_facts(const DensityGrid& grid, ReadVolume& read) {
  read.facts.index_to_world = grid.index_to_world;
  read.facts.repairs = grid.repairs;
  read.facts.active_voxels = grid.active_voxels;
  read.facts.notes = grid.notes;
  read.facts.color = grid.color;
}

/// A volume at the moments that passes see.
std::vector<VolumeSettings> moments_of(const Scene& scene, std::size_t volume) {
  std::vector<VolumeSettings> moments;
  for (const Scene& moment : scene.moments) // several may differ by the camera alone
    if (moments.empty() || moments.back().velocity.time != moment.volumes[volume].velocity.time)
      moments.push_back(moment.volumes[volume]);
  return moments;
}

} // namespace

double preparation_limit(const RenderSettings& settings) {
  constexpr double grace = 0.5;
  return settings.time ? *settings.time + grace : std::numeric_limits<double>::infinity();
}

FrameError preparation_failure(const std::string& what, const RenderSettings& settings) {
  return FrameError(fmt::format("{}: the time limit of {} ended the frame while its files were "
                                "read and its volumes prepared, so there is no image; give it more "
                                "time",
                                what, format_duration(*settings.time)));
}

std::uint64_t photon_cache_capacity() {
  return std::min<std::uint64_t>(granted_memory() / 8, std::uint64_t{1} << 30);
}

void add_work(RenderStatistics& statistics, const PreparedScene& prepared) {
  statistics.read += prepared.seconds_read;
  statistics.prepare += prepared.seconds_build;
  statistics.grids_read += prepared.grids_read;
  const WorldFacts::SurfaceWork& work = prepared.facts.surfaces;
  statistics.meshes_read += static_cast<std::uint64_t>(work.meshes_read);
  statistics.textures_read += static_cast<std::uint64_t>(work.textures_read);
  statistics.trees_built += static_cast<std::uint64_t>(work.trees_built);
}

std::uint64_t PreparedScene::source_bytes() const {
  std::uint64_t bytes = 0;
  for (const ReadVolume& volume : volumes)
    for (const SourceGrid& source : volume.sources)
      bytes += source.grid.field.bytes();
  return bytes;
}

std::string moved_world_settings(const Scene& moment, const PreparedScene& prepared) {
  std::string text = world_settings(moment);
  for (std::size_t i = 0; i < moment.volumes.size() && i < prepared.volumes.size(); ++i)
    if (prepared.volumes[i].velocity && moment.volumes[i].velocity.time != 0)
      text += fmt::format("volume.{} moved by {};", i, moment.volumes[i].velocity.time);
  return text;
}

namespace {

/// Notes a file whose Z is up in a scene whose Y is: nothing turns it, so it lies on its side.
void note_axes(const Scene& scene, std::size_t i, const DensityGrid& grid,
               std::vector<std::string>& notes) {
  const std::array<double, 12>& m = scene.volumes[i].transform;
  const Vec3d up = normalize(scene.camera.up), z{m[2], m[6], m[10]};
  constexpr double along = 0.9; // cosine
  if (!grid.from_mantaflow || !(length(z) > 0) || std::abs(normalize(z).z) < along ||
      std::abs(up.y) < along)
    return;
  const std::string note =
      fmt::format("{}: its Z is up, as in Blender, whose simulator wrote it, but camera.up is Y: "
                  "turn it by volume.{}.rotate = [-90, 0, 0], or write camera.up = [0, 0, 1]",
                  scene.volumes[i].file, i);
  if (notes.empty())
    notes.push_back(note);
}

/// The same of a scene whose colours are in its working space.
/// A frame whose world is that of the one before: only what is animated about its motion is read.
void take_over(const Scene& scene, const PreparedScenePtr& previous, const StopToken& stop,
               PreparedScene& prepared) {
  prepared.world = previous->world;
  prepared.facts = previous->facts;
  prepared.facts.surfaces = {};
  prepared.volumes = previous->volumes;
  if (previous->photon_settings == prepared.photon_settings)
    prepared.photons = previous->photons;
  if (!prepared.photons && scene.render.seeds == SeedPolicy::correlated)
    prepared.photons = std::make_shared<PhotonCache>(photon_cache_capacity());
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    ReadVolume& read = prepared.volumes[i];
    read.sources.clear();
    take_velocity(scene, i, previous, stop, read);
    keep_sources(scene.volumes[i], moments_of(scene, i), previous, stop, read);
    prepared.grids_read += std::exchange(read.grids_read, 0);
  }
}

/// Data read for the volumes of a scene, in their order.
struct ReadGrids {
  std::vector<DensityGrid> density;
  std::vector<EmissionGrid> emission;
  std::vector<std::string> axis_notes;
  std::map<std::string, std::size_t> readers; ///< the volume that was read, by what decides it
};

/// The density of a volume: that of an earlier volume of the scene which is read from the same file
/// in the same way, or a grid of its own.
void read_density(const VolumeSettings& volume, const PreparedScenePtr& previous, std::size_t index,
                  const StopToken& stop, ReadGrids& grids, ReadVolume& read) {
  const std::string identity = volume.needs_density() ? density_identity(volume) : "";
  const auto same = grids.readers.find(identity);
  if (!identity.empty() && stands_still(volume, read) && same != grids.readers.end()) {
    DensityGrid shared = grids.density[same->second]; // copies share the values
    shared.notes.clear(); // which are about the file, and are there once
    grids.density.push_back(std::move(shared));
    read.identity = identity;
    return;
  }
  grids.density.push_back(take_grid(volume, previous, stop, read));
  take_colors(volume, previous, stop, read, grids.density.back());
  if (!identity.empty() && stands_still(volume, read))
    grids.readers.try_emplace(identity, index);
}

ReadGrids read_grids(const Scene& scene, const PreparedScenePtr& previous, const StopToken& stop,
                     PreparedScene& prepared) {
  ReadGrids grids;
  int kept = 0;
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    const VolumeSettings& volume = scene.volumes[i];
    ReadVolume read;
    take_velocity(scene, i, previous, stop, read);
    keep_sources(volume, moments_of(scene, i), previous, stop, read);
    read_density(volume, previous, i, stop, grids, read);
    const DensityGrid& grid = grids.density.back();
    note_axes(scene, i, grid, grids.axis_notes);
    keep_facts(grid, read);
    grids.emission.push_back(take_emission(volume, previous, prepared.volumes, stop, read));
    read.emission = grids.emission.back();
    prepared.grids_read += std::exchange(read.grids_read, 0);
    // As build_world leaves volumes out.
    const bool empty = grid.field.empty() || !volume.absorbs_or_scatters();
    read.index = empty ? -1 : kept++;
    if (empty && !grid.field.empty())
      read.identity.clear(); // its field is not kept
    prepared.volumes.push_back(std::move(read));
  }
  return grids;
}

PreparedScenePtr prepare(const Scene& scene, const PreparedScenePtr& previous,
                         const StopToken& stop) {
  Stopwatch watch;
  auto prepared = std::make_shared<PreparedScene>();
  prepared->world_settings =
      previous ? moved_world_settings(scene, *previous) : world_settings(scene);
  prepared->photon_settings = photon_settings(scene);
  if (previous && previous->world_settings == prepared->world_settings) {
    take_over(scene, previous, stop, *prepared);
    note_velocities(scene, *prepared);
    prepared->seconds_read = prepared->grids_read > 0 ? watch.seconds() : 0;
    return prepared;
  }
  ReadGrids grids = read_grids(scene, previous, stop, *prepared);
  return_freed_memory();
  stop.check();
  prepared->seconds_read = watch.restart();
  prepared->world = std::make_shared<const World>(
      build_world(scene, std::move(grids.density), std::move(grids.emission), &prepared->facts,
                  previous ? previous->world.get() : nullptr));
  return_freed_memory();
  prepared->seconds_build = watch.seconds();
  prepared->facts.notes.insert(prepared->facts.notes.end(), grids.axis_notes.begin(),
                               grids.axis_notes.end());
  note_velocities(scene, *prepared);
  for (ReadVolume& read : prepared->volumes)
    if (read.index >= 0 &&
        prepared->world->medium.volumes[static_cast<std::size_t>(read.index)].limited)
      read.identity.clear(); // another frame's extinction may ask for other limits
  return prepared;
}

} // namespace

PreparedScenePtr prepare_scene(const Scene& scene, const PreparedScenePtr& previous,
                               const StopToken& stop) {
  const StopReading reading(stop);
  if (scene.image.working_space == ColorSpace::rec709)
    return prepare(scene, previous, stop);
  return prepare(in_working_space(scene), previous, stop);
}

PreparedScenePtr prepare_scene(const Scene& scene, const PreparedScenePtr& previous,
                               const std::atomic<bool>* stop) {
  try {
    return prepare_scene(scene, previous, StopToken(stop));
  } catch (const Stopped&) {
    throw FrameError(scene.path + ": was stopped while its files were read and prepared");
  }
}

} // namespace vdbeam
