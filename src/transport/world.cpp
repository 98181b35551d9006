#include "transport/world.h"

#include "lights/light_groups.h"
#include "lights/light_table.h"
#include "lights/surface_light.h"
#include "lights/volume_light.h"
#include "math/color.h"
#include "transport/build_surfaces.h"
#include "transport/photon_targets.h"
#include "transport/target_regions.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbeam {

namespace {

/// Local coordinates of a field -> world.
Affine local_to_world(const Vec3<std::int64_t>& origin, const Affine& index_to_world,
                      const VolumeSettings& settings) {
  Affine shift;
  shift.translation = Vec3d(origin);
  return Affine::from_matrix(settings.transform).after(index_to_world).after(shift);
}

Boxd mapped_bounds(const Affine& map, const Boxf& box) {
  return map.bounds({Vec3d(box.lower), Vec3d(box.upper)});
}

/// Light must not leave single precision: sums of photons would be infinite.
void check_lights(const Scene& scene, const World& world) {
  const auto finite = [](const Rgb& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (!finite(world.lights[i].power()))
      throw InputError(
          fmt::format("light.{}: its power exceeds single precision (3.4e38): divide all lights by "
                      "the same factor, and correct the exposure of the image",
                      i));
  for (const Emitter& emitter : world.medium.emitters)
    if (!finite(emitter.strength))
      throw InputError(fmt::format("volume.{}.emission.scale: the emission exceeds single "
                                   "precision (3.4e38 per unit of length): use a smaller value",
                                   emitter.setting));
}

/// Moves the bounds' centre to 0 and scales by the power of two that brings the size to [1, 2).
RenderSpace choose_space(const Boxd& bounds) {
  RenderSpace space;
  if (bounds.empty())
    return space;
  space.origin = bounds.center();
  const double size = max_component(bounds.size());
  if (size > 0)
    space.scale = std::exp2(-std::floor(std::log2(size)));
  return space;
}

int phase_index_of(std::vector<PhaseFunction>& phases, std::vector<PhaseSettings>& known,
                   const PhaseSettings& phase) {
  if (const auto found = std::find(known.begin(), known.end(), phase); found != known.end())
    return static_cast<int>(found - known.begin());
  known.push_back(phase);
  phases.emplace_back(phase);
  return static_cast<int>(phases.size()) - 1;
}

/// Extinction per render unit beyond which a mean free path is no longer than what single precision
/// resolves: a walk would never move. What goes into two million mean free paths does not come back
/// in any way that could be seen, so a denser medium looks the same.
constexpr double most_extinction = 1 << 21;

/// Keeps densities to what can be tracked.
void limit_density(Volume& volume, const VolumeSettings& settings, double scale,
                   std::vector<std::string>& notes) {
  const auto extinction = static_cast<double>(volume.extinction);
  const auto densest = static_cast<double>(volume.field.maximum());
  if (!(densest * extinction > most_extinction))
    return;
  const auto most = static_cast<float>(most_extinction / extinction);
  volume.limited = most > 0 && volume.field.limit_values(most) > 0;
  notes.push_back(fmt::format("{}: densities above {:.2g} (an extinction of {:.2g} per world unit) "
                              "are clamped to it; the greatest is {:.2g}",
                              settings.file.empty() ? "a volume" : settings.file,
                              static_cast<double>(most), most_extinction * scale, densest));
}

Volume make_volume(DensityGrid&& grid, const VolumeSettings& settings,
                   const Affine& local_to_render, double scale, std::vector<std::string>& notes) {
  Volume volume;
  volume.field = std::move(grid.field);
  const float strongest = max_component(settings.extinction_scale);
  // With an extinction beyond single precision all densities are limited anyway.
  constexpr double greatest = std::numeric_limits<float>::max();
  const double extinction =
      std::min(settings.extinction * static_cast<double>(strongest) / scale, greatest);
  volume.extinction = static_cast<float>(extinction);
  limit_density(volume, settings, scale, notes);
  volume.to_local = Affinef(local_to_render.inverse());
  volume.channel_scale = strongest > 0 ? settings.extinction_scale / strongest : Rgb(1);
  volume.albedo = settings.albedo;
  volume.color = std::move(grid.color);
  double edge = infinity;
  for (int a = 0; a < 3; ++a) {
    Vec3d unit{};
    unit[a] = 1;
    edge = std::min(edge, length(local_to_render.vector(unit)));
  }
  volume.voxel_size = static_cast<float>(edge);
  return volume;
}

/// Gives a volume the majorants of an earlier one with the same values, or its own.
void share_majorants(const std::vector<Volume>& earlier, Volume& volume) {
  const auto same = std::find_if(earlier.begin(), earlier.end(), [&](const Volume& other) {
    return other.field.values() == volume.field.values();
  });
  volume.majorants = same == earlier.end() ? MajorantGrid(volume.field) : same->majorants;
}

Emitter make_emitter(const EmissionGrid& grid, const VolumeSettings& settings,
                     const RenderSpace& space) {
  Emitter emitter;
  emitter.field = grid.field;
  emitter.to_render =
      space.map().after(local_to_world(grid.field->origin(), grid.index_to_world, settings));
  emitter.to_local = Affinef(emitter.to_render.inverse());
  emitter.strength = Rgb(Vec3d(settings.emission.color) * (settings.emission.scale / space.scale));
  return emitter;
}

void add_facts(WorldFacts& facts, const DensityGrid& density, const EmissionGrid& emission) {
  facts.notes.insert(facts.notes.end(), density.notes.begin(), density.notes.end());
  facts.notes.insert(facts.notes.end(), emission.notes.begin(), emission.notes.end());
  facts.volumes.push_back({density.field.empty() ? 0 : density.active_voxels,
                           emission.empty() ? 0 : emission.active_voxels});
}

/// Adds every emitting volume as a light for the scattering ones.
void add_volume_lights(World& world) {
  bool scatters = false;
  for (const Volume& volume : world.medium.volumes)
    scatters = scatters || max_component(volume.albedo) > 0;
  for (const Emitter& emitter : world.medium.emitters)
    if (scatters)
      world.lights.add(std::make_unique<VolumeLight>(emitter), {.is_emission = true});
}

/// The shape of a surface if lights can be drawn by solid angle: a sphere that is not stretched, or
/// a quad with perpendicular edges.
SolidAngleShape solid_angle_shape(const SurfaceSettings& settings, const RenderSpace& space) {
  const Affine map = space.map().after(Affine::from_matrix(settings.transform));
  const Vec3d x = map.vector({1, 0, 0}), y = map.vector({0, 1, 0}), z = map.vector({0, 0, 1});
  const auto perpendicular = [](const Vec3d& a, const Vec3d& b) {
    return std::abs(dot(a, b)) < 1e-9 * length(a) * length(b);
  };
  if (settings.shape == SurfaceShape::quad && perpendicular(x, y)) {
    const Vec3d normal = normalize(cross(x, y)) * std::copysign(1.0, map.determinant());
    return Rectangle{map.translation - x - y, x * 2.0, y * 2.0, normal};
  }
  const double radius = length(x), most = 1e-9 * radius;
  const bool round = perpendicular(x, y) && perpendicular(y, z) && perpendicular(z, x) &&
                     std::abs(length(y) - radius) < most && std::abs(length(z) - radius) < most;
  if (settings.shape == SurfaceShape::sphere && round)
    return Ball{map.translation, radius};
  return {};
}

/// Adds every surface that shines as a light.
void add_surface_lights(const std::vector<SurfaceSettings>& settings, World& world) {
  auto surfaces = std::make_shared<Surfaces>(*world.surfaces);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const Material& material = *surfaces->materials[i];
    if (!material.shines())
      continue;
    const bool two_sided = max_component(material.emitted(false)) > 0;
    surfaces->lights[i] = static_cast<int>(world.lights.size());
    const auto make = [&](const OccupiedRegion* medium) {
      return std::make_unique<SurfaceLight>(
          surfaces->set, static_cast<int>(i), material.emitted(true), two_sided,
          solid_angle_shape(settings[i], world.space), surfaces->textures[i], medium);
    };
    world.lights.add(aim_surface_light(world, make), {settings[i].visible, false});
  }
  world.surfaces = std::move(surfaces);
}

/// Each light has the group that its settings name. Volumes that glow belong to the rest.
void sort_lights_into_groups(const Scene& scene, World& world) {
  const LightGroups groups(scene);
  std::vector<int> of_light(world.lights.size(), groups.number(""));
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    of_light[i] = groups.number(scene.lights[i].group);
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
    if (const int light = world.surfaces->lights[i]; light >= 0)
      of_light[static_cast<std::size_t>(light)] = groups.number(scene.surfaces[i].group);
  world.lights.sort_into_groups(groups.count(), of_light, groups.number(""));
}

void add_air(const std::vector<LightSettings>& lights, const Vec3d& up, World& world) {
  const int light = light_with_air(lights);
  if (light < 0)
    return;
  world.air_light = static_cast<std::size_t>(light);
  world.air =
      std::make_shared<const AerialPerspective>(tinted(lights[world.air_light]), up, world.space);
}

void bound_region(World& world, const Boxd& bounds) {
  world.medium.bounds = {Vec3f(world.space.point(bounds.lower)),
                         Vec3f(world.space.point(bounds.upper))};
  // A little wider, so that a ray that grazes the last voxel is not cut by rounding.
  const Vec3f margin = world.medium.bounds.size() * 1e-5f + Vec3f(1e-6f);
  world.medium.bounds.lower -= margin;
  world.medium.bounds.upper += margin;
  world.region.center = world.medium.bounds.center();
  world.region.radius = 0.5f * length(world.medium.bounds.size());
}

} // namespace

namespace {

/// Sorts the volumes by extinction and by size. The world's region has their boxes in their order.
void sort_volumes(World& world) {
  std::vector<float> peaks;
  for (const Volume& volume : world.medium.volumes)
    peaks.push_back(volume.extinction * volume.field.maximum());
  world.medium.parts = MediumParts(peaks);
  std::vector<double> areas;
  for (const Parallelepiped& box : world.region.boxes)
    areas.push_back(box.surface_area());
  world.medium.nests = find_nests(areas);
}

/// The transform of each volume to the world, and the bounds of their contents [world].
std::vector<Affine> place_volumes(const Scene& scene, const std::vector<DensityGrid>& grids,
                                  const std::vector<EmissionGrid>& emissions, Boxd& bounds) {
  std::vector<Affine> maps;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const VolumeSettings& settings = scene.volumes[i];
    maps.push_back(local_to_world(grids[i].field.origin(), grids[i].index_to_world, settings));
    if (!grids[i].field.empty())
      bounds.extend(mapped_bounds(maps[i], grids[i].field.occupied()));
    if (const EmissionGrid& glow = emissions[i]; !glow.empty())
      bounds.extend(
          mapped_bounds(local_to_world(glow.field->origin(), glow.index_to_world, settings),
                        glow.field->occupied()));
  }
  return maps;
}

/// Puts the volumes into the world, whose space is known; takes the grids' fields.
void add_medium(const Scene& scene, std::vector<DensityGrid>& grids,
                const std::vector<EmissionGrid>& emissions, const std::vector<Affine>& maps,
                World& world, std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < grids.size(); ++i)
    if (!emissions[i].empty()) {
      world.medium.emitters.push_back(make_emitter(emissions[i], scene.volumes[i], world.space));
      world.medium.emitters.back().setting = i;
    }
  std::vector<PhaseSettings> known_phases;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const VolumeSettings& settings = scene.volumes[i];
    if (grids[i].field.empty() || !settings.absorbs_or_scatters())
      continue;
    const Affine map = world.space.map().after(maps[i]);
    add_region(world.region, grids[i].field, map);
    Volume volume = make_volume(std::move(grids[i]), settings, map, world.space.scale, notes);
    volume.setting = i;
    share_majorants(world.medium.volumes, volume);
    volume.phase_index = phase_index_of(world.medium.phases, known_phases, settings.phase);
    world.medium.chromatic = world.medium.chromatic || !is_grey(volume.channel_scale);
    world.medium.volumes.push_back(std::move(volume));
  }
  world.medium.grow_tree();
  sort_volumes(world);
  if (!world.medium.isotropic())
    world.medium.angles = std::make_shared<const ScatteringAngles>(world.medium.phases);
}

} // namespace

World build_world(const Scene& scene, std::vector<DensityGrid> grids,
                  std::vector<EmissionGrid> emissions, WorldFacts* facts, const World* previous) {
  World world;
  WorldFacts found;
  Boxd bounds;
  emissions.resize(grids.size());
  for (std::size_t i = 0; i < grids.size(); ++i)
    add_facts(found, grids[i], emissions[i]);
  const std::vector<Affine> maps = place_volumes(scene, grids, emissions, bounds);
  const Surfaces* known = previous ? previous->surfaces.get() : nullptr;
  const auto store =
      std::make_shared<SurfaceStore>(scene.surfaces, known ? known->store.get() : nullptr);
  const std::vector<WorldShape> shapes = read_shapes(scene.surfaces, *store, found.notes);
  world.space = choose_space(bounds.empty() ? world_bounds(shapes) : bounds);
  add_medium(scene, grids, emissions, maps, world, found.notes);
  if (world.medium.visible())
    bound_region(world, bounds);
  world.surfaces = build_surfaces(scene.surfaces, shapes, world.space, world.region, store,
                                  known ? known->set.get() : nullptr, found.notes);
  store->close();
  if (world.surfaces)
    found.surfaces = {store->meshes_read(), store->textures_read(),
                      world.surfaces->set->trees_built()};
  const std::vector<LightSettings> lights = lights_at_camera(scene);
  add_air(lights, scene.camera.up, world);
  choose_targets(world);
  if (!world.targets.empty()) {
    add_aimed_lights(lights, scene.camera.up, found.notes, world);
  } else {
    world.lights = LightSet(lights, scene.camera.up, world.space, world.region, &found.notes);
  }
  check_lights(scene, world);
  if (world.surfaces)
    add_surface_lights(scene.surfaces, world);
  add_volume_lights(world);
  sort_lights_into_groups(scene, world);
  if (world.surfaces && !world.medium.emitters.empty())
    world.emission = std::make_shared<const EmissionDirections>(world.medium.emitters);
  if (facts)
    *facts = std::move(found);
  return world;
}

Segment flight_segment(const World& world, const Vec3d& origin, const Vec3f& direction,
                       std::optional<SurfaceHit>& end) {
  Segment segment{{Vec3f(origin), direction}};
  if (const Surfaces* surfaces = world.surfaces.get()) {
    end = surfaces->set->intersect(origin, Vec3d(direction), 0, static_cast<double>(infinity));
    segment.t_end = surfaces->medium_end(end, direction);
  }
  return segment;
}

} // namespace vdbeam
