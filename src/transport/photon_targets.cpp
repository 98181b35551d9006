#include "transport/photon_targets.h"

#include "lights/aimed_light.h"
#include "lights/light_table.h"
#include "medium/optical_depth.h"
#include "tuning/constants.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// Half the width of the first box about the medium in radii of the medium, and how much wider each
/// further box is.
constexpr double first_box = 1.5, next_box = 4;
/// Greatest number of a target's boxes: more than these are merged into one.
constexpr std::size_t most_boxes = 64;
constexpr std::size_t most_targets = 8; ///< from the medium on
/// Photons that find out how much of an aim's light counts.
constexpr std::uint64_t trial_photons = 256;

/// A flat box has no inside at which photons can be aimed.
Parallelepiped thick_box(const Boxd& box) {
  const Vec3d margin = Vec3d(1e-3 * max_component(box.size()) + 1e-9);
  const Vec3d lower = box.lower - margin, size = box.size() + margin * 2.0;
  return {Vec3f(lower),
          {Vec3f(Vec3d{size.x, 0, 0}), Vec3f(Vec3d{0, size.y, 0}), Vec3f(Vec3d{0, 0, size.z})}};
}

bool contains(const Boxd& box, const Boxd& other) {
  for (int i = 0; i < 3; ++i)
    if (!(other.lower[i] >= box.lower[i] && other.upper[i] <= box.upper[i]))
      return false;
  return true;
}

bool contains_all(const Boxd& box, const SurfaceSet& surfaces) {
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (!contains(box, surfaces.bounds(i)))
      return false;
  return true;
}

/// The surfaces within a box, and the medium's boxes.
OccupiedRegion region_within(const Boxd& box, const OccupiedRegion& medium,
                             const SurfaceSet& surfaces) {
  OccupiedRegion region;
  Boxd all;
  std::vector<Boxd> parts;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Boxd whole = surfaces.bounds(i);
    const Boxd part{max(whole.lower, box.lower), min(whole.upper, box.upper)};
    if (!part.empty())
      parts.push_back(part);
  }
  for (const Boxd& part : parts)
    all.extend(part);
  if (parts.size() > most_boxes)
    parts = {all};
  for (const Boxd& part : parts)
    region.boxes.push_back(thick_box(part));
  for (const Parallelepiped& own : medium.boxes) {
    all.extend(own.bounds());
    region.boxes.push_back(own);
  }
  region.center = Vec3f(all.center());
  region.radius = static_cast<float>(0.5 * length(all.size()) * 1.01);
  return region;
}

/// Whether a line from its origin on meets one of the boxes.
bool meets(const std::vector<Parallelepiped>& boxes, const Ray& ray) {
  for (const Parallelepiped& box : boxes) {
    const float volume = dot(box.edges[0], cross(box.edges[1], box.edges[2]));
    if (!(std::abs(volume) > 0)) // EntrySampler leaves flat boxes out, too
      continue;
    float enter = 0, leave = infinity;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3f dual = cross(box.edges[(i + 1) % 3], box.edges[(i + 2) % 3]) / volume;
      const float x = dot(dual, ray.origin - box.corner), slope = dot(dual, ray.direction);
      if (slope == 0) {
        if (x < 0 || x > 1)
          leave = -1;
        continue;
      }
      const float a = -x / slope, b = (1 - x) / slope;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave)
      return true;
  }
  return false;
}

/// Distance from a photon's origin back to its light, or, where that is far away, to before all.
double distance_to_light(const World& world, const Light& light, const EmittedPhoton& photon) {
  if (light.surface() >= 0)
    return 0;
  const Vec3d origin(photon.ray.origin);
  const OccupiedRegion& all = world.targets.back();
  return light.position()
             ? length(origin - *light.position())
             : 2 * (length(origin - Vec3d(all.center)) + static_cast<double>(all.radius));
}

/// Whether a line meets the sphere around a region, from a distance `back` before its origin on.
/// Nests are met there, not at their cells: light that the medium around them scatters into the
/// sphere is aimed, too. A sphere may reach beyond the medium.
bool meets_sphere(const OccupiedRegion& region, const Ray& ray, double back) {
  const Vec3d to_center = Vec3d(region.center) - Vec3d(ray.origin);
  const double along = dot(to_center, Vec3d(ray.direction));
  const double radius = static_cast<double>(region.radius);
  const double beside = dot(to_center, to_center) - along * along;
  return beside < radius * radius && along > -std::sqrt(radius * radius - beside) - back;
}

/// Whether a line from its origin on meets a cell in which there may be medium; `only`: of these
/// volumes.
bool meets(const Medium& medium, const Ray& ray, const std::vector<std::size_t>* only = nullptr) {
  const Segment segment = medium.clip({ray});
  if (segment.empty())
    return false;
  bool met = false;
  medium.for_each_met(segment, [&](std::size_t v) {
    if (only && std::find(only->begin(), only->end(), v) == only->end())
      return;
    const Volume& volume = medium.volumes[v];
    for (GridTraversal walk = volume.traverse(segment); !met && !walk.done(); walk.advance()) {
      const Vec3<int>& cell = walk.cell();
      met = volume.majorants[volume.field.cell_offset(cell.x, cell.y, cell.z)] > 0;
    }
  });
  return met;
}

/// The ray from a distance `back` before its origin on.
Ray from_light(const Ray& ray, double back) {
  return {ray.origin - ray.direction * static_cast<float>(back), ray.direction};
}

bool meets_target(const World& world, std::size_t target, const Ray& ray, double back) {
  const Medium& medium = world.medium;
  if (target >= world.medium_targets)
    return meets(world.targets[target].boxes, ray);
  if (target + 1 == world.medium_targets)
    return meets(medium, ray);
  return target < world.first_sphere ? meets(medium, from_light(ray, back), &medium.nests[0])
                                     : meets_sphere(world.targets[target], ray, back);
}

/// What an aim's photons find that count, in the strongest channel.
struct CountedFlux {
  double sum = 0;     ///< up to a factor
  double opacity = 0; ///< of the medium on their straight ways from the light, the mean
};

CountedFlux counted_flux(const World& world, const AimedLight::Aim& aim) {
  CountedFlux flux;
  for (std::uint64_t n = 0; n < trial_photons; ++n) {
    Rng rng({}, RngStage::light, n);
    EmittedPhoton photon = aim.light->emit((static_cast<double>(n) + 0.5) / trial_photons, rng);
    photon.first_target = aim.first_target;
    photon.last_target = aim.last_target;
    if (!counts_for_its_target(world, *aim.light, photon))
      continue;
    const auto own = static_cast<double>(max_component(photon.flux));
    flux.sum += own;
    const Ray way = from_light(photon.ray, distance_to_light(world, *aim.light, photon));
    if (const Segment segment = world.medium.clip({way}); !segment.empty()) {
      const Rgb left = exact_transmittance(world.medium, segment);
      flux.opacity += own * (1 - static_cast<double>(std::min({left.x, left.y, left.z})));
    }
  }
  if (flux.sum > 0)
    flux.opacity /= flux.sum;
  return flux;
}

/// Shares of the photons: equal ones for the volumes of the nest and the medium, half of them for
/// each sphere between these. Each target after the medium gets half of the previous one, at most
/// the flux that counts there in units of that to the medium. Next to none where the light does not
/// shine or the medium around the nests is not seen. Returns the aim at the medium.
std::size_t share_out(const World& world, std::vector<AimedLight::Aim>& aims) {
  const std::size_t medium = std::max<std::size_t>(world.medium_targets, 1) - 1;
  std::vector<double> weights;
  double sum = 0, to_medium = 0, full_opacity = 0;
  for (std::size_t i = 0; i < aims.size(); ++i) {
    const CountedFlux flux = counted_flux(world, aims[i]);
    if (i <= medium)
      to_medium += flux.sum;
    double relative = flux.sum > 0;
    if (i == 0 && medium == 0)
      relative = 1;
    else if (i > 0 && i <= medium)
      relative = flux.opacity < full_opacity ? flux.opacity / full_opacity : 1;
    else if (i > medium)
      relative = to_medium > 0 ? std::min(1.0, flux.sum / to_medium) : 1;
    if (i < medium)
      full_opacity = std::max(full_opacity, tuning::faint_opacity * flux.opacity);
    // Trial photons may miss a cloud that some of the lines in a wide sphere cross.
    const double least = i > 0 && i <= medium ? 1.0 / 32 : 1e-3;
    double usual = std::exp2(-static_cast<double>(std::max(i, medium) - medium));
    if (i >= world.first_sphere && i < medium)
      usual = 0.5;
    weights.push_back(std::max(least, relative) * usual);
    sum += weights.back();
  }
  for (std::size_t i = 0; i < aims.size(); ++i)
    aims[i].share = weights[i] / sum;
  return medium;
}

} // namespace

void add_surface_targets(const OccupiedRegion& medium, const SurfaceSet& surfaces,
                         std::vector<OccupiedRegion>& targets) {
  const Boxd everywhere{Vec3d(-1e300), Vec3d(1e300)};
  if (!medium.boxes.empty()) {
    const std::size_t most = targets.size() - 1 + most_targets;
    double half = first_box * static_cast<double>(medium.radius);
    const Vec3d center(medium.center);
    while (targets.size() + 1 < most) {
      const Boxd box{center - Vec3d(half), center + Vec3d(half)};
      if (contains_all(box, surfaces))
        break;
      OccupiedRegion region = region_within(box, medium, surfaces);
      if (region.boxes.size() > medium.boxes.size())
        targets.push_back(std::move(region));
      half *= next_box;
    }
  }
  targets.push_back(region_within(everywhere, medium, surfaces));
}

bool counts_for_its_target(const World& world, const Light& light, const EmittedPhoton& photon) {
  const auto first = static_cast<std::size_t>(photon.first_target);
  const auto last = static_cast<std::size_t>(photon.last_target);
  const double back = distance_to_light(world, light, photon);
  for (std::size_t target = 0; target < first; ++target)
    if (meets_target(world, target, photon.ray, back))
      return false;
  if (last + 1 >= world.targets.size()) // beyond the last there is nothing to be met
    return true;
  for (std::size_t target = first; target <= last; ++target)
    if (meets_target(world, target, photon.ray, back))
      return true;
  return false;
}

double surface_extent(const World& world) {
  constexpr double plane_share = 10;
  const SurfaceSet& set = *world.surfaces->set;
  const double shapes = set.bounds().empty() ? 0 : length(set.bounds().size());
  bool plane = false;
  for (std::size_t i = 0; i < set.size(); ++i)
    plane = plane || set.is_infinite(i);
  const double medium = 2 * static_cast<double>(world.region.radius);
  return plane ? plane_share * std::max(shapes, medium) : shapes;
}

bool may_hold_photons(const World& world, const SurfaceHit& hit) {
  const SurfaceSet& set = *world.surfaces->set;
  if (!set.is_infinite(static_cast<std::size_t>(hit.surface)))
    return true;
  constexpr double farthest = 100;
  const Vec3d center = world.medium.visible() ? Vec3d(world.region.center) : set.bounds().center();
  return length(hit.position - center) < farthest * surface_extent(world);
}

Vec3d beginning_of_flight(const World& world, const Light& light, const EmittedPhoton& photon) {
  const Vec3d origin(photon.ray.origin), direction(photon.ray.direction);
  if (photon.fluxes_to_medium.empty())
    return origin;
  const double back = distance_to_light(world, light, photon);
  const bool at_nest =
      photon.first_target + 1 < static_cast<int>(world.medium_targets); // within the medium
  return back > 0 && (at_nest || (world.surfaces &&
                                  world.surfaces->set->occluded(origin, -direction, 0, back)))
             ? origin - direction * back
             : origin;
}

TargetCones::TargetCones(const World& world, const Vec3d& point, std::size_t end)
    : first_(world.first_sphere) {
  for (std::size_t i = first_; i < std::min(end, world.targets.size()); ++i) {
    const OccupiedRegion& target = world.targets[i];
    const Vec3d way = Vec3d(target.center) - point;
    const double distance = length(way), sine = static_cast<double>(target.radius) / distance;
    if (!(sine < 1))
      return;
    cones_.push_back({way / distance, sine * sine / (1 + std::sqrt(1 - sine * sine))});
  }
}

std::size_t TargetCones::first_of(const Vec3f& direction) const {
  std::size_t i = 0;
  while (i < cones_.size() && !cones_[i].holds(direction))
    ++i;
  return i;
}

Copies copies_into(const Cone& cone, float value, float flux, Rng& rng) {
  // Where nothing goes along the cone's axis, something may still go into parts of the cone.
  constexpr float least_value = 0.01f;
  const auto solid_angle = static_cast<float>(cone.solid_angle());
  const float wanted = flux * std::max(value, least_value) * solid_angle;
  if (wanted < 1)
    return {rng.uniform() < wanted ? 1 : 0, solid_angle / wanted};
  const float copies = std::min(std::floor(wanted + 0.5f), static_cast<float>(Copies::most));
  return {static_cast<int>(copies), solid_angle / copies};
}

void add_aimed_lights(const std::vector<LightSettings>& settings, const Vec3d& up,
                      std::vector<std::string>& notes, World& world) {
  const auto count = static_cast<int>(world.targets.size());
  for (const LightSettings& light : settings) {
    const LightKind& kind = light_kind(light.type);
    std::vector<AimedLight::Aim> aims;
    for (int target = 0; target < count; ++target) {
      const LightContext context{up, world.space, world.targets[static_cast<std::size_t>(target)],
                                 target == 0 ? &notes : nullptr,
                                 target == 0 ? nullptr : aims[0].light.get()};
      aims.push_back({make_light(light, context), target, target, 1});
    }
    const std::size_t medium = share_out(world, aims);
    world.lights.add(std::make_unique<AimedLight>(std::move(aims), medium),
                     {light.visible, kind.surrounds, kind.wants_shadow_rays(light)});
  }
}

std::unique_ptr<Light>
aim_surface_light(const World& world,
                  const std::function<std::unique_ptr<Light>(const OccupiedRegion*)>& make) {
  const auto count = static_cast<int>(world.targets.size());
  const auto of_medium = static_cast<int>(world.medium_targets);
  if (world.medium.empty() || count < 2)
    return make(nullptr);
  std::vector<AimedLight::Aim> aims;
  aims.reserve(world.medium_targets + 1);
  for (int target = 0; target < of_medium; ++target)
    aims.push_back({make(&world.targets[static_cast<std::size_t>(target)]), target, target, 1});
  aims.push_back({make(nullptr), of_medium, count - 1, 1});
  const std::size_t medium = share_out(world, aims);
  return std::make_unique<AimedLight>(std::move(aims), medium);
}

} // namespace vdbeam
