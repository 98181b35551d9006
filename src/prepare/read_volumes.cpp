#include "prepare/read_volumes.h"

#include "grids/edited_field.h"
#include "keys/scene_keys.h"
#include "layers/plane_layers.h"
#include "machine/input_file.h"
#include "machine/memory.h"
#include "vdbeam/error.h"
#include "volume/noise.h"

#include <fmt/format.h>

#include <cmath>

namespace vdbeam {
namespace {

/// The grid from the last frame, or nothing where it is another one.
const ReadVolume* find_read(const PreparedScenePtr& previous, const std::string& identity) {
  if (previous)
    for (const ReadVolume& volume : previous->volumes)
      if (!identity.empty() && volume.identity == identity)
        return &volume;
  return nullptr;
}

/// Motion of a volume between the moment that its file shows and this one.
std::optional<Motion> motion_of(const VolumeSettings& volume, const ReadVolume& read) {
  if (!read.velocity || volume.velocity.time == 0)
    return std::nullopt;
  return Motion{*read.velocity, volume.velocity};
}

/// The settings that edit a volume's density, as text.
std::string edits_text(const VolumeSettings& volume) {
  const DensityRemap& r = volume.remap;
  return noise_text(volume) + fmt::format("|{}|{}|{}|{}|{}|{}|{}|{}|{}", volume.add, volume.mask,
                                          r.scale, r.offset, r.least, r.most.value_or(-1), r.power,
                                          r.curve, static_cast<int>(volume.interpolation));
}

/// Settings that decide the colours which multiply a volume's albedo.
std::string colors_text(const VolumeSettings& volume) {
  return volume.color_grid.empty() ? ""
                                   : fmt::format("|colors {} {}", volume.color_grid,
                                                 static_cast<int>(volume.emission.color_space));
}

/// The clipping box of a volume and its place. A volume without a file has its shape instead, which
/// is placed afterwards.
std::string box_text(const VolumeSettings& volume) {
  if (volume.fog.made() || !volume.box_lower || !volume.box_upper)
    return fog_text(volume);
  const Vec3d &a = *volume.box_lower, &b = *volume.box_upper;
  std::string text = fmt::format("|{} {} {} {} {} {}", a.x, a.y, a.z, b.x, b.y, b.z);
  for (const double x : volume.transform)
    text += fmt::format(" {}", x);
  return text;
}

/// All but the file that decides a volume's density and its colours.
std::string density_text(const VolumeSettings& volume) {
  return "|" + volume.density + edits_text(volume) + box_text(volume) + colors_text(volume);
}

/// The edits of a grid that lies in its place; those of the density where `density`.
GridEdits edits_of(const VolumeSettings& volume, const DensityGrid& grid, bool density) {
  GridEdits edits;
  edits.to_world = Affine::from_matrix(volume.transform).after(grid.index_to_world);
  if (density)
    edits.remap = volume.remap;
  if (!volume.fog.made() && volume.box_lower && volume.box_upper)
    edits.box = Boxd{*volume.box_lower, *volume.box_upper};
  return edits;
}

/// The colours of a volume, read, or taken from `previous`.
Colors find_colors(const VolumeSettings& volume, const PreparedScenePtr& previous,
                   const std::string& identity, const StopToken& stop, ReadVolume& read) {
  if (previous)
    for (const ReadVolume& known : previous->volumes)
      if (known.color_identity == identity)
        return known.colors;
  ++read.grids_read;
  return read_colors(volume.file, volume.color_grid, {.stop = &stop});
}

/// A grid that the volume keeps, or one of `previous` does; null: there is none.
const DensityGrid* find_source(const std::string& identity, const std::optional<WantedBox>& wanted,
                               const PreparedScenePtr& previous, const ReadVolume& read) {
  for (const SourceGrid& source : read.sources)
    if (source.has(identity, wanted))
      return &source.grid;
  if (previous)
    for (const ReadVolume& volume : previous->volumes)
      for (const SourceGrid& source : volume.sources)
        if (source.has(identity, wanted))
          return &source.grid;
  return nullptr;
}

DensityGrid take_density_source(const VolumeSettings& volume,
                                const std::optional<WantedBox>& wanted,
                                const PreparedScenePtr& previous, const StopToken& stop,
                                ReadVolume& read) {
  if (const DensityGrid* known =
          find_source(density_source_identity(volume), wanted, previous, read))
    return *known;
  return read_density_source(volume, wanted, stop, read.grids_read);
}

DensityGrid take_emission_source(const VolumeSettings& volume, const std::string& name,
                                 const std::optional<WantedBox>& wanted,
                                 const PreparedScenePtr& previous, const StopToken& stop,
                                 ReadVolume& read) {
  if (const DensityGrid* known =
          find_source(emission_source_identity(volume, name), wanted, previous, read))
    return *known;
  return read_emission_source(volume, name, wanted, stop, read.grids_read);
}

} // namespace

std::string emission_identity(const VolumeSettings& volume) {
  std::string text = file_identity(volume.file) + box_text(volume) + noise_text(volume) +
                     fmt::format("|{}|{}", static_cast<int>(volume.emission.color_space),
                                 static_cast<int>(volume.interpolation));
  Scene scene;
  scene.volumes.push_back(volume);
  for (const SceneKey& key : scene_keys())
    if (key.section == SceneSection::emission && !key.scales_emission)
      text += fmt::format("|{}", key.format(key.get(scene, 0)));
  return text;
}

std::string density_identity(const VolumeSettings& volume) {
  return file_identity(volume.file) + density_text(volume);
}

bool stands_still(const VolumeSettings& volume, const ReadVolume& read) {
  return !motion_of(volume, read);
}

std::optional<WantedBox> wanted_box(const VolumeSettings& volume, const Motion* motion) {
  const Affine placed = Affine::from_matrix(volume.transform);
  if (volume.fog.made() || !volume.box_lower || !volume.box_upper ||
      !(std::abs(placed.determinant()) > 0))
    return std::nullopt;
  Boxd box = placed.inverse().bounds({*volume.box_lower, *volume.box_upper});
  const Vec3d noise(volume.noise.amplitude);
  const Boxd ways = motion ? ways_of(*motion) : Boxd{Vec3d(0), Vec3d(0)};
  return WantedBox{{box.lower - noise - ways.upper, box.upper + noise - ways.lower}};
}

void keep_sources(const VolumeSettings& volume, const std::vector<VolumeSettings>& moments,
                  const PreparedScenePtr& previous, const StopToken& stop, ReadVolume& read) {
  bool density = false, glows = false;
  std::optional<WantedBox> wanted = wanted_box(volume, nullptr);
  const std::string edits = density_text(volume), emission = emission_identity(volume);
  for (const VolumeSettings& moment : moments) {
    const auto motion = motion_of(moment, read);
    density |= (motion && edits_of(moment, {}, true).changes()) || density_text(moment) != edits;
    glows |= motion || emission_identity(moment) != emission;
    const auto part = wanted_box(moment, motion ? &*motion : nullptr);
    if (wanted && part)
      wanted->world.extend(part->world);
    else
      wanted.reset();
  }
  if (density && volume.needs_density())
    read.sources.push_back({density_source_identity(volume), wanted,
                            take_density_source(volume, wanted, previous, stop, read)});
  if (glows && volume.glows())
    for (const std::string& name : {volume.emission.intensity, volume.emission.temperature})
      if (!name.empty())
        read.sources.push_back({emission_source_identity(volume, name), wanted,
                                take_emission_source(volume, name, wanted, previous, stop, read)});
}

DensityGrid take_grid(const VolumeSettings& volume, const PreparedScenePtr& previous,
                      const StopToken& stop, ReadVolume& read) {
  if (!volume.needs_density())
    return {};
  read.identity = density_identity(volume);
  const auto motion = motion_of(volume, read);
  const bool edited = edits_of(volume, {}, true).changes();
  // What was edited cannot be moved: the box would move too.
  if (const ReadVolume* known = find_read(previous, read.identity); known && !(motion && edited)) {
    DensityGrid grid = known->facts;
    if (known->index >= 0)
      grid.field = previous->world->medium.volumes[static_cast<std::size_t>(known->index)].field;
    if (!motion)
      return grid;
    read.identity.clear(); // other frames have no use for it
    return moved_grid(grid, *motion, volume.file, {granted_memory(), &stop});
  }
  DensityGrid grid = take_density_source(volume, wanted_box(volume, motion ? &*motion : nullptr),
                                         previous, stop, read);
  if (motion) {
    read.identity.clear();
    grid = moved_grid(grid, *motion, volume.file, {granted_memory(), &stop});
  }
  grid.field = edited_field(grid.field, edits_of(volume, grid, true), &stop);
  return grid;
}

EmissionGrid take_emission(const VolumeSettings& volume, const PreparedScenePtr& previous,
                           const std::vector<ReadVolume>& earlier, const StopToken& stop,
                           ReadVolume& read) {
  if (!volume.glows())
    return {};
  const auto motion = motion_of(volume, read);
  if (!motion) {
    read.emission_identity = emission_identity(volume);
    for (const ReadVolume& known : earlier)
      if (known.emission_identity == read.emission_identity) {
        EmissionGrid shared = known.emission;
        shared.notes.clear(); // which are about the file, and are there once
        return shared;
      }
    if (previous)
      for (const ReadVolume& known : previous->volumes)
        if (known.emission_identity == read.emission_identity)
          return known.emission;
  }
  const std::optional<WantedBox> wanted = wanted_box(volume, motion ? &*motion : nullptr);
  const auto take = [&](const std::string& name) {
    DensityGrid grid = take_emission_source(volume, name, wanted, previous, stop, read);
    if (motion)
      grid = moved_grid(grid, *motion, volume.file, {granted_memory(), &stop});
    grid.field = edited_field(grid.field, edits_of(volume, grid, false), &stop);
    return grid;
  };
  return make_emission(volume.emission, take(volume.emission.intensity),
                       take(volume.emission.temperature), volume.file, {granted_memory(), &stop});
}

void take_colors(const VolumeSettings& volume, const PreparedScenePtr& previous,
                 const StopToken& stop, ReadVolume& read, DensityGrid& grid) {
  if (volume.color_grid.empty() || grid.field.empty() || grid.color)
    return;
  read.color_identity = file_identity(volume.file) + colors_text(volume);
  read.colors = find_colors(volume, previous, read.color_identity, stop, read);
  if (!read.colors.field) {
    grid.notes.push_back(volume.file + ": has no colour grid (color_grid = \"auto\")");
    return;
  }
  const VectorField& colors = *read.colors.field;
  const auto note = [&](std::uint64_t voxels, const char* what) {
    if (voxels > 0)
      grid.notes.push_back(fmt::format("{}: color_grid \"{}\": {} voxels {}", volume.file,
                                       volume.color_grid, voxels, what));
  };
  note(read.colors.limited, "have a component outside [0, 1], clamped");
  note(colors.outliers(), "are not finite; they take the colour of their neighbours");
  if (ColorField::bytes_of(grid.field) > granted_memory())
    throw FrameError(volume.file + ": its colours need more memory than there may be");
  const auto motion = motion_of(volume, read);
  const std::function<Vec3d(const Vec3d&)> source =
      motion ? sources_of(grid, *motion) : [](const Vec3d& index) { return index; };
  const ColorMatrix matrix = rgb_matrix(chromaticities_of(ColorSpace::rec709),
                                        chromaticities_of(volume.emission.color_space));
  const bool converts = volume.emission.color_space != ColorSpace::rec709;
  const Affine to_colors = colors.index_to_world().inverse();
  const Vec3d origin(grid.field.origin());
  grid.color = std::make_shared<const ColorField>(
      grid.field,
      [&](const Vec3d& local) {
        Vec3d world = grid.index_to_world.point(source(local + origin));
        if (volume.noise.amplitude > 0)
          world += noise_displacement(volume.noise, world);
        const Vec3d color = colors.sample(to_colors.point(world));
        return converts ? Rgb(min(max(matrix.apply(color), Vec3d(0)), Vec3d(1))) : Rgb(color);
      },
      &stop);
}

void take_velocity(const Scene& scene, std::size_t i, const PreparedScenePtr& previous,
                   const StopToken& stop, ReadVolume& read) {
  const VolumeSettings& volume = scene.volumes[i];
  const bool wanted = !scene.moments.empty() || asks_for_layer(scene, "motion");
  if (volume.velocity.time != 0 && previous) // a moment of the scene that is prepared
    read.velocity = previous->volumes[i].velocity;
  if (!wanted || !volume.present || volume.fog.made() || volume.velocity.grid == "none" ||
      volume.velocity.scale == 0)
    return;
  const std::string identity = fmt::format(
      "{}|{}|{}|{}|{}", file_identity(volume.file), volume.velocity.grid, volume.velocity.fps,
      volume.velocity.scale, static_cast<int>(volume.velocity.units));
  if (previous && i < previous->volumes.size() &&
      previous->volumes[i].velocity_identity == identity) {
    read.velocity = previous->volumes[i].velocity;
  } else {
    read.velocity = read_velocity(volume.file, volume.velocity, {.stop = &stop});
    ++read.grids_read;
  }
  read.velocity_identity = identity;
}

void note_velocities(const Scene& scene, PreparedScene& prepared) {
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    const ReadVolume& read = prepared.volumes[i];
    if (!read.velocity_identity.empty() && !read.velocity && !scene.moments.empty())
      prepared.facts.notes.push_back(fmt::format(
          "{}: has no velocity grid (\"velocity\", \"vel\", \"v\" or three components), so it has "
          "no motion blur of its own; set volume.{}.velocity to a grid, or to \"none\"",
          scene.volumes[i].file, i));
    if (!read.velocity_identity.empty() && read.velocity && read.velocity->outliers() > 0)
      prepared.facts.notes.push_back(
          fmt::format("{}: {} voxels have a velocity that is not finite or crosses the whole grid "
                      "within a frame; they move like their neighbours",
                      scene.volumes[i].file, read.velocity->outliers()));
  }
}

} // namespace vdbeam
