#include "render/prepared_scene.h"

#include "machine/stopwatch.h"
#include "render/memory_check.h"
#include "scene/scene_keys.h"
#include "volume/moved_field.h"

#include <fmt/format.h>
#include <sys/stat.h>

namespace vdbeam {
namespace {

/// Tells one state of a file from another.
std::string file_identity(const std::string& path) {
  struct stat status {};
  if (path.empty() || stat(path.c_str(), &status) != 0)
    return path;
  return fmt::format("{}|{}|{}|{}.{:09}", path, status.st_ino, status.st_size,
                     status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
}

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
        text += file_identity(std::get<std::string>(key.get(scene, i))) + ";";
    }
  }
  return text;
}

/// Every value that a world is made from. Sizes and cameras are not among them, but for the way up,
/// about which skies turn.
std::string world_settings(const Scene& scene) {
  std::string text = settings_text(scene, [](const SceneKey& key) { return key.changes_world; });
  for (const VolumeSettings& volume : scene.volumes)
    text += volume.present ? "+" : "-";
  return text;
}

std::string photon_settings(const Scene& scene) {
  return settings_text(scene,
                       [](const SceneKey& key) { return key.section == SceneSection::render; });
}

/// The grid from the last frame, or nothing where it is another one.
const ReadVolume* find_read(const PreparedScenePtr& previous, const std::string& identity) {
  if (previous)
    for (const ReadVolume& volume : previous->volumes)
      if (!identity.empty() && volume.identity == identity)
        return &volume;
  return nullptr;
}

DensityGrid take_still_grid(const VolumeSettings& volume, const PreparedScenePtr& previous,
                            ReadVolume& read) {
  read.identity = file_identity(volume.file) + "|" + volume.density;
  if (const ReadVolume* known = find_read(previous, read.identity)) {
    DensityGrid grid = known->facts;
    if (known->index >= 0)
      grid.field = previous->world->medium.volumes[static_cast<std::size_t>(known->index)].field;
    return grid;
  }
  return read_density_grid(volume.file, volume.density);
}

/// Motion of a volume between the moment that its file shows and this one.
std::optional<Motion> motion_of(const VolumeSettings& volume, const ReadVolume& read) {
  if (!read.velocity || volume.velocity.time == 0)
    return std::nullopt;
  return Motion{*read.velocity, volume.velocity};
}

DensityGrid take_grid(const VolumeSettings& volume, const PreparedScenePtr& previous,
                      ReadVolume& read) {
  if (!volume.needs_density())
    return {};
  DensityGrid grid = take_still_grid(volume, previous, read);
  const auto motion = motion_of(volume, read);
  if (!motion)
    return grid;
  read.identity.clear(); // other frames have no use for it
  return moved_grid(grid, *motion, volume.file, granted_memory());
}

/// Reads the velocities of volumes that passes see at several moments.
void take_velocities(const Scene& scene, const PreparedScenePtr& previous,
                     PreparedScene& prepared) {
  for (std::size_t i = 0; i < scene.volumes.size() && !scene.moments.empty(); ++i) {
    const VolumeSettings& volume = scene.volumes[i];
    ReadVolume& read = prepared.volumes[i];
    if (!volume.present || volume.velocity.grid == "none" || volume.velocity.scale == 0)
      continue;
    const std::string identity = fmt::format(
        "{}|{}|{}|{}|{}", file_identity(volume.file), volume.velocity.grid, volume.velocity.fps,
        volume.velocity.scale, static_cast<int>(volume.velocity.units));
    if (previous && i < previous->volumes.size() &&
        previous->volumes[i].velocity_identity == identity)
      read.velocity = previous->volumes[i].velocity;
    else
      read.velocity = read_velocity(volume.file, volume.velocity);
    read.velocity_identity = identity;
    if (read.velocity && read.velocity->outliers() > 0)
      prepared.facts.notes.push_back(fmt::format(
          "{}: {} voxels have a velocity that is not a number or crosses the whole grid "
          "within a frame; they move like their neighbours",
          volume.file, read.velocity->outliers()));
  }
}

/// Moves the grids that emission is made from.
EmissionGrid read_moved_emission(const VolumeSettings& volume, const Motion& motion) {
  const auto read = [&](const std::string& name) -> DensityGrid {
    if (name.empty())
      return {};
    const DensityGrid grid = read_density_grid(volume.file, name, {}, Background::ignored);
    return moved_grid(grid, motion, volume.file, granted_memory());
  };
  return make_emission(volume.emission, read(volume.emission.intensity),
                       read(volume.emission.temperature), volume.file, granted_memory());
}

/// Everything that decides an emission field but the contents of the file; its strength does not.
std::string emission_identity(const VolumeSettings& volume) {
  std::string text = file_identity(volume.file);
  Scene scene;
  scene.volumes.push_back(volume);
  for (const SceneKey& key : scene_keys())
    if (key.section == SceneSection::emission && !key.scales_emission)
      text += fmt::format("|{}", key.format(key.get(scene, 0)));
  return text;
}

EmissionGrid take_emission(const VolumeSettings& volume, const PreparedScenePtr& previous,
                           ReadVolume& read) {
  if (!volume.glows())
    return {};
  if (const auto motion = motion_of(volume, read))
    return read_moved_emission(volume, *motion);
  read.emission_identity = emission_identity(volume);
  if (previous)
    for (const ReadVolume& known : previous->volumes)
      if (known.emission_identity == read.emission_identity)
        return known.emission;
  return read_emission_grid(volume.file, volume.emission);
}

/// Bytes for photons that later frames may use: at most an eighth of the memory, which is less than
/// what `vdbeam farm` asks for beyond its estimate.
std::uint64_t cache_capacity() {
  return std::min<std::uint64_t>(granted_memory() / 8, std::uint64_t{1} << 30);
}

void keep_facts(const DensityGrid& grid, ReadVolume& read) {
  read.facts.index_to_world = grid.index_to_world;
  read.facts.repairs = grid.repairs;
  read.facts.active_voxels = grid.active_voxels;
  read.facts.notes = grid.notes;
}

} // namespace

std::string moved_world_settings(const Scene& moment, const PreparedScene& prepared) {
  std::string text = world_settings(moment);
  for (std::size_t i = 0; i < moment.volumes.size() && i < prepared.volumes.size(); ++i)
    if (prepared.volumes[i].velocity && moment.volumes[i].velocity.time != 0)
      text += fmt::format("volume.{} moved by {};", i, moment.volumes[i].velocity.time);
  return text;
}

PreparedScenePtr prepare_scene(const Scene& scene, const PreparedScenePtr& previous) {
  Stopwatch watch;
  auto prepared = std::make_shared<PreparedScene>();
  prepared->world_settings =
      previous ? moved_world_settings(scene, *previous) : world_settings(scene);
  prepared->photon_settings = photon_settings(scene);
  if (previous && previous->world_settings == prepared->world_settings) {
    prepared->world = previous->world;
    prepared->facts = previous->facts;
    prepared->volumes = previous->volumes;
    if (previous->photon_settings == prepared->photon_settings)
      prepared->photons = previous->photons;
    if (!prepared->photons && scene.render.seeds == SeedPolicy::correlated)
      prepared->photons = std::make_shared<PhotonCache>(cache_capacity());
    take_velocities(scene, previous, *prepared);
    return prepared;
  }
  std::vector<DensityGrid> grids;
  std::vector<EmissionGrid> emissions;
  int kept = 0;
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    const VolumeSettings& volume = scene.volumes[i];
    ReadVolume read;
    if (volume.velocity.time != 0 && previous) // a moment of the scene that is prepared
      read.velocity = previous->volumes[i].velocity;
    grids.push_back(take_grid(volume, previous, read));
    keep_facts(grids.back(), read);
    emissions.push_back(take_emission(volume, previous, read));
    read.emission = emissions.back();
    // As build_world leaves volumes out.
    const bool empty = grids.back().field.empty() || !volume.absorbs_or_scatters();
    read.index = empty ? -1 : kept++;
    if (empty && !grids.back().field.empty())
      read.identity.clear(); // its field is not kept
    prepared->volumes.push_back(std::move(read));
  }
  prepared->seconds_read = watch.restart();
  prepared->world = std::make_shared<const World>(
      build_world(scene, std::move(grids), std::move(emissions), &prepared->facts));
  prepared->seconds_build = watch.seconds();
  take_velocities(scene, previous, *prepared);
  for (ReadVolume& read : prepared->volumes)
    if (read.index >= 0 &&
        prepared->world->medium.volumes[static_cast<std::size_t>(read.index)].limited)
      read.identity.clear(); // another frame's extinction may ask for other limits
  return prepared;
}

} // namespace vdbeam
