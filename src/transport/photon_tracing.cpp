#include "transport/photon_tracing.h"

#include "camera/towards_camera.h"
#include "transport/light_path.h"
#include "transport/photon_targets.h"
#include "tuning/constants.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace vdbeam {

namespace {

/// Paths in a task: its photons stay together and in order, so the list does not depend on threads.
constexpr std::uint64_t paths_per_chunk = 512;
/// Collisions of every path under way between two looks at the clock.
constexpr std::uint32_t rounds_per_check = 128;

/// Traces one chunk of paths into one list.
class PathTracer {
public:
  PathTracer(const World& world, const PhotonPassSettings& settings)
      : world_(world), settings_(settings),
        single_scattering_(world.surfaces != nullptr ||
                           std::ranges::count(settings.skip_first_flight, false) > 0) {}

  /// The paths `begin` to `end` of a pass; light i emits first[i] to first[i + 1]. Several
  /// are under way at a time and take turns at every collision, so that one path computes while the
  /// voxels of the others are on their way from memory.
  void trace(std::uint64_t begin, std::uint64_t end, const std::vector<std::uint64_t>& first) {
    constexpr std::size_t paths_under_way = 6;
    std::array<std::optional<LightPath>, paths_under_way> paths;
    std::size_t light = 0;
    std::uint64_t next = begin;
    std::uint32_t rounds = 0;
    for (bool any = true; any;) {
      any = false;
      if (rounds++ % rounds_per_check == 0 && settings_.stop && settings_.stop->stopped())
        return;
      for (std::optional<LightPath>& path : paths) {
        if (path && !step_flight(world_.medium, *path, *this))
          path.reset();
        if (!path && !split_.empty()) {
          path.emplace(split_.back());
          split_.pop_back();
        }
        for (; !path && next < end; ++next) {
          while (next >= first[light + 1])
            ++light;
          emit(path, next, light, next - first[light], first[light + 1] - first[light]);
        }
        any = any || path;
      }
    }
  }

  // What happens at the collisions of a flight (step_flight).

  static constexpr bool bounds_null_collisions = false;
  void meet(LightPath& path, const Collision& hit) {
    if (may_store(path) && settings_.store == PhotonStore::fluence)
      store(path, hit);
  }
  bool pass(LightPath& path) const { return path.length.survive(path.throughput, path.rng); }
  bool collide(LightPath& path, const Collision& hit) {
    if (!path.length.survive(path.throughput, path.rng))
      return false;
    const Vec3f point = path.segment.ray.at(hit.t);
    const Rgb albedo = hit.volume->albedo_at(point);
    if (may_store(path) && settings_.store == PhotonStore::scatter)
      store(path, hit);
    if (!absorption_roulette(albedo, path.throughput, path.rng))
      return false;
    if (++path.bounces == 1 && !path.met_surface)
      path.for_surfaces = lights_surfaces(path.light) && world_.lights[path.light].is_near();
    // What has been scattered as often as it may counts no more but where it meets a surface.
    if (settings_.max_bounces &&
        path.bounces >= *settings_.max_bounces + (path.for_surfaces ? 1 : 0))
      return false;
    const PhaseFunction& phase = world_.medium.phases[hit.volume->phase_index];
    const std::optional<TargetCones> aimed = send_to_nests(path, phase, point);
    const int paths = settings_.guide ? hold_in_window(path, point) : 1;
    if (paths == 2)
      split(path, phase, point, aimed);
    return paths > 0 && scatter(path, phase, point, aimed);
  }
  /// A path that leaves the scene ends. At a surface it continues by the material.
  bool leave(LightPath& path) { return path.end && reflect(path); }

  PhotonList photons, caustics, surface_photons;
  std::uint64_t collisions = 0;

private:
  /// The paths that go on: none, one or two, each with the throughput that `path` has afterwards.
  int hold_in_window(LightPath& path, const Vec3f& point) const {
    const float value =
        settings_.guide->relative_value(max_component(path.throughput), point, settings_.paths);
    if (value < tuning::lowest_window) {
      const float chance = std::max(value, tuning::least_window_chance);
      if (path.rng.uniform() >= chance)
        return 0;
      path.throughput *= 1 / chance;
    } else if (value > tuning::highest_window && !path.length.begun()) {
      path.throughput *= 0.5f;
      return 2;
    }
    return 1;
  }

  /// Sends a copy of the path on its own way; it is traced when one of those under way has ended.
  void split(LightPath& path, const PhaseFunction& phase, const Vec3f& point,
             const std::optional<TargetCones>& aimed) {
    LightPath copy = copy_of(path);
    if (scatter(copy, phase, point, aimed))
      split_.push_back(std::move(copy));
  }

  /// False where the path leaves the medium without another collision, or goes where it is `aimed`.
  bool scatter(LightPath& path, const PhaseFunction& phase, const Vec3f& point,
               const std::optional<TargetCones>& aimed) {
    const Vec3f direction = path.sample_direction(phase);
    if (aimed && aimed->first_of(direction) < aimed->size())
      return false;
    path.set_out(world_, Vec3d(point), direction);
    return advance_flight(path, *this);
  }

  /// False where the path ends at the surface.
  bool reflect(LightPath& path) {
    const SurfaceVertex vertex(*world_.surfaces, *path.end, path.segment.ray.direction);
    if (vertex.material().is_black() ||
        !absorption_roulette(vertex.absorbed(), path.throughput, path.rng))
      return false;
    if (path.for_surfaces && vertex.material().takes_photons() &&
        may_hold_photons(world_, vertex.hit()))
      store_at(vertex, path);
    else if (!path.met_surface && path.bounces == 0)
      path.for_surfaces = vertex.material().throws_light() && lights_surfaces(path.light);
    const std::optional<TargetCones> aimed = send_to_targets(path, vertex);
    const MaterialSample next = vertex.sample(Carried::power, path.rng);
    if (!absorption_roulette(next.weight, path.throughput, path.rng) ||
        !path.surfaces.survive(path.throughput, path.rng) ||
        (aimed && aimed->first_of(next.wi) < aimed->size()))
      return false;
    path.met_surface = true;
    path.by_mirrors = path.by_mirrors && vertex.material().is_specular();
    path.set_out(world_, vertex.hit().leave(next.wi), next.wi);
    return true;
  }

  /// Sends copies of the path from a surface to the world's targets, and returns the cones of their
  /// directions, in which the path itself does not go on. Within the medium's sphere it is shared.
  std::optional<TargetCones> send_to_targets(LightPath& path, const SurfaceVertex& vertex) {
    const Material& material = vertex.material();
    if (path.fair_fluxes.empty() || !(path.fair_fluxes.back() > 0) || material.is_specular() ||
        material.refracts() || world_.medium.empty())
      return std::nullopt;
    TargetCones cones(world_, vertex.hit().position);
    for (std::size_t i = 0; i < cones.size(); ++i) {
      const Vec3f axis(cones[i].axis);
      send_into(cones, i, max_component(vertex.evaluate(axis, Carried::power)), path,
                [&](const Vec3f& wi, float solid_angle) {
                  send_copy(path, vertex, wi, vertex.evaluate(wi, Carried::power) * solid_angle);
                });
    }
    if (cones.target(cones.size()) < world_.medium_targets)
      share_flux(path, vertex, cones);
    return cones;
  }

  /// Draws the directions of the path's copies into cone i of a target, beside those of smaller
  /// ones. `value` [1 / sr]: the part of its flux that goes along the cone's axis.
  template <class Send>
  void send_into(const TargetCones& cones, std::size_t i, float value, LightPath& path,
                 const Send& send) const {
    const Copies copies =
        copies_into(cones[i], value, path.relative_flux(cones.target(i)), path.rng);
    for (int n = 0; n < copies.count; ++n) {
      const float u = path.rng.uniform(), v = path.rng.uniform();
      const Vec3f wi(cones[i].sample(static_cast<double>(u), static_cast<double>(v)));
      if (cones.first_of(wi) == i)
        send(wi, copies.solid_angle);
    }
  }

  /// Sends copies of the path, which the medium scatters, to the nests around which it is. As
  /// send_to_targets does: few paths would find a small cloud in a wide fog, and those that do
  /// would be far brighter than others.
  std::optional<TargetCones> send_to_nests(LightPath& path, const PhaseFunction& phase,
                                           const Vec3f& point) {
    const std::size_t medium = std::max<std::size_t>(world_.medium_targets, 1) - 1;
    if (medium == 0 || path.fair_fluxes.size() <= medium || !(path.fair_fluxes.back() > 0))
      return std::nullopt;
    TargetCones cones(world_, Vec3d(point), medium);
    // Paths of no more flux than those aimed at a sphere go there by themselves, since copies would
    // be rare: a cloud beside a nest would lose its light to them.
    cones.keep_while([&](std::size_t target) { return path.relative_flux(target) > 1; });
    const Vec3f& travel = path.segment.ray.direction;
    for (std::size_t i = 0; i < cones.size(); ++i) {
      const float value = phase.evaluate(dot(travel, Vec3f(cones[i].axis)));
      send_into(cones, i, value, path, [&](const Vec3f& wi, float solid_angle) {
        LightPath copy = copy_of(path);
        copy.throughput *= phase.evaluate(dot(travel, wi)) * solid_angle;
        if (!(max_component(copy.throughput) > 0))
          return;
        copy.set_out(world_, Vec3d(point), wi);
        if (advance_flight(copy, *this))
          split_.push_back(std::move(copy));
      });
    }
    return cones;
  }

  /// The path goes on as one of several of equal flux, outside of the cones.
  void share_flux(LightPath& path, const SurfaceVertex& vertex, const TargetCones& cones) {
    constexpr auto most = static_cast<float>(Copies::most);
    const int paths =
        static_cast<int>(std::clamp(path.relative_flux(cones.target(cones.size())), 1.0f, most));
    path.throughput *= 1 / static_cast<float>(paths);
    for (int i = 1; i < paths; ++i) {
      const MaterialSample next = vertex.sample(Carried::power, path.rng);
      if (cones.first_of(next.wi) == cones.size())
        send_copy(path, vertex, next.wi, next.weight);
    }
  }

  /// Puts a copy that a surface scatters to those that wait for their turn.
  void send_copy(LightPath& path, const SurfaceVertex& vertex, const Vec3f& wi, const Rgb& weight) {
    LightPath copy = copy_of(path);
    copy.throughput *= weight;
    if (!(max_component(copy.throughput) > 0) || !copy.surfaces.survive(copy.throughput, copy.rng))
      return;
    copy.met_surface = true;
    copy.by_mirrors = copy.by_mirrors && vertex.material().is_specular();
    copy.set_out(world_, vertex.hit().leave(wi), wi);
    if (advance_flight(copy, *this))
      split_.push_back(std::move(copy));
  }

  /// The same path with random numbers of its own.
  LightPath copy_of(LightPath& path) {
    LightPath copy = path;
    const std::uint64_t high = path.rng.bits(), low = path.rng.bits();
    copy.rng = Rng(settings_.key, RngStage::split, high << 32 | low);
    return copy;
  }

  /// Shadow rays find what comes straight from their light, and nothing that a surface sent on.
  bool may_store(const LightPath& path) const {
    if (settings_.max_bounces && path.bounces >= *settings_.max_bounces)
      return false;
    return path.bounces > 0 || path.met_surface || !settings_.skip_first_flight[path.light];
  }

  /// Path `number` of the pass, the `index`-th of `light_paths` from its light, up to its first
  /// tentative collision; none where it meets nothing.
  void emit(std::optional<LightPath>& path, std::uint64_t number, std::size_t light,
            std::uint64_t index, std::uint64_t light_paths) {
    Rng rng(settings_.key, RngStage::photon, number);
    const double place = (static_cast<double>(index) + static_cast<double>(rng.uniform())) /
                         static_cast<double>(light_paths);
    const PathGuide::Emission start =
        settings_.guide ? settings_.guide->emission(light, place) : PathGuide::Emission{place, 1};
    const EmittedPhoton photon = world_.lights[light].emit(start.place, rng);
    if (!photon.fluxes_to_medium.empty() &&
        !counts_for_its_target(world_, world_.lights[light], photon))
      return;
    const Rgb flux =
        photon.flux / static_cast<float>(static_cast<double>(light_paths) * start.density);
    if (!(max_component(flux) > 0) ||
        (settings_.max_bounces && *settings_.max_bounces <= 0 && !lights_surfaces(light)))
      return;
    path.emplace(rng, flux);
    path->light = light;
    path->number = static_cast<std::uint32_t>(number);
    path->fair_fluxes = photon.fluxes_to_medium;
    path->flux_unit = static_cast<float>(light_paths);
    path->set_out(world_, beginning_of_flight(world_, world_.lights[light], photon),
                  photon.ray.direction);
    if (!advance_flight(*path, *this))
      path.reset();
  }

  bool lights_surfaces(std::size_t light) const {
    return !settings_.surface_photon_lights.empty() && settings_.surface_photon_lights[light];
  }
  void store_at(const SurfaceVertex& vertex, const LightPath& path) {
    surface_photons.position.emplace_back(vertex.hit().position);
    surface_photons.direction.push_back(path.segment.ray.direction);
    surface_photons.power.push_back(path.throughput *
                                    vertex.arriving_factor(-path.segment.ray.direction));
    store_group(surface_photons, path);
  }

  float store_probability(const Volume& volume, const Vec3f& point, const Vec3f& direction) const {
    if (!settings_.store_probability_by_cell)
      return settings_.store_probability;
    const std::size_t index = world_.medium.index_of(volume);
    const float by_cell = (*settings_.store_probability_by_cell)[index][volume.cell_at(point)];
    if (!settings_.camera || !settings_.directions)
      return by_cell;
    return by_cell * towards_camera(*settings_.camera, world_.medium, volume, point, direction);
  }

  void store_group(PhotonList& list, const LightPath& path) const {
    if (world_.lights.group_count() > 0)
      list.group.push_back(static_cast<std::uint16_t>(world_.lights.group(path.light)));
  }

  void store(LightPath& path, const Collision& hit) {
    ++collisions;
    const Vec3f point = path.segment.ray.at(hit.t);
    const float probability =
        std::min(1.0f, store_probability(*hit.volume, point, path.segment.ray.direction));
    if (probability < 1 && path.rng.uniform() >= probability)
      return;
    const Rgb stored = path.throughput * settings_.albedo / probability *
                       (settings_.store == PhotonStore::scatter
                            ? hit.volume->albedo_at(point)
                            : Rgb(1 / majorant_of_part(world_.medium, hit, point)));
    append(photons, path, point, *hit.volume, stored);
    if (settings_.path_numbers)
      photons.path.push_back(path.number);
    if (single_scattering_)
      photons.first_flight.push_back(path.bounces == 0);
    if (is_caustic(path))
      append(caustics, path, point, *hit.volume, stored);
  }

  void append(PhotonList& list, const LightPath& path, const Vec3f& point, const Volume& volume,
              const Rgb& power) const {
    list.position.push_back(point);
    if (!world_.medium.parts.single())
      list.part.push_back(static_cast<std::uint8_t>(world_.medium.part_of(volume)));
    if (settings_.directions)
      list.direction.push_back(path.segment.ray.direction);
    list.power.push_back(power);
    store_group(list, path);
  }

  bool is_caustic(const LightPath& path) const {
    return path.met_surface && path.by_mirrors && path.bounces == 0 &&
           !settings_.caustic_lights.empty() && settings_.caustic_lights[path.light];
  }

  std::vector<LightPath> split_; ///< paths that wait for their turn
  const World& world_;
  const PhotonPassSettings& settings_;
  bool single_scattering_; ///< photons may bring light that the medium has not scattered yet
};

/// What the tracers have in one of their lists.
PhotonList joined(const std::vector<PathTracer>& tracers, PhotonList PathTracer::*list,
                  int groups) {
  std::vector<const PhotonList*> lists;
  lists.reserve(tracers.size());
  for (const PathTracer& tracer : tracers)
    lists.push_back(&(tracer.*list));
  return join(lists, groups);
}

} // namespace

TracedPhotons trace_photons(const World& world, const PhotonPassSettings& settings) {
  TracedPhotons pass;
  if ((world.medium.empty() && settings.surface_photon_lights.empty()) || settings.paths == 0)
    return pass;
  const std::vector<std::uint64_t> first =
      share_paths(world.lights, settings.paths, settings.guide.get());
  const std::uint64_t paths = first.back();
  const std::uint64_t chunks = (paths + paths_per_chunk - 1) / paths_per_chunk;
  std::vector<PathTracer> tracers(chunks, PathTracer(world, settings));
  tbb::parallel_for(tbb::blocked_range<std::uint64_t>(0, chunks, 1),
                    [&](const tbb::blocked_range<std::uint64_t>& range) {
                      for (std::uint64_t chunk = range.begin(); chunk < range.end(); ++chunk)
                        tracers[chunk].trace(chunk * paths_per_chunk,
                                             std::min(paths, (chunk + 1) * paths_per_chunk), first);
                    });
  for (const PathTracer& tracer : tracers) // in whole numbers, so that their order is no matter
    pass.mean_collisions += static_cast<double>(tracer.collisions);
  pass.mean_collisions /= static_cast<double>(std::max<std::uint64_t>(paths, 1));
  if (settings.stop && settings.stop->stopped())
    return pass; // what there is is of no use, and there may be much of it
  const int groups = world.lights.group_count();
  pass.photons = joined(tracers, &PathTracer::photons, groups);
  pass.caustics = joined(tracers, &PathTracer::caustics, groups);
  pass.surface_photons = joined(tracers, &PathTracer::surface_photons, groups);
  return pass;
}

} // namespace vdbeam
