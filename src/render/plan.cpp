#include "render/plan.h"

#include "film/film.h"
#include "transport/camera.h"
#include "volume/vdb_reader.h"

#include <limits>

namespace vdbeam {

namespace {

bool is_grey(const Rgb& c) {
  return c.x == c.y && c.y == c.z;
}

/// What of the scene decides the stages.
struct Needs {
  bool medium = false, visible = false, scatters = false, photons = false, first_flight = false;
  bool shadow_rays = false, anisotropic = false, chromatic = false, coloured = false;
  bool environment = false, several_bounces = true;
  bool glows = false, glow_visible = false;
};

/// Light that comes smoothly from all around: escaping rays find it as well as shadow rays would.
bool is_smooth_sky(const LightSettings& light) {
  return light.type == LightType::sky ||
         (light.type == LightType::environment && light.image.empty());
}

/// Whether single scattering of a light is left to photons (the rule that the renderer follows).
bool left_to_photons(const LightSettings& light, const RenderSettings& render) {
  DirectLight direct = light.direct.value_or(render.direct);
  if (direct == DirectLight::automatic)
    direct = is_smooth_sky(light) ? DirectLight::photons : DirectLight::sampled;
  return direct == DirectLight::photons;
}

Needs find_needs(const Scene& scene, const std::vector<VolumeFacts>& volumes) {
  Needs needs;
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    const VolumeSettings& volume = scene.volumes[i];
    if (volumes[i].glowing_voxels > 0) {
      needs.glows = true;
      needs.glow_visible = needs.glow_visible || volumes[i].in_view;
      needs.coloured =
          needs.coloured || !volume.emission.temperature.empty() || !is_grey(volume.emission.color);
    }
    if (volumes[i].empty || !(volume.extinction > 0))
      continue;
    needs.medium = true;
    needs.visible = needs.visible || volumes[i].in_view;
    needs.scatters = needs.scatters || max_component(volume.albedo) > 0;
    needs.anisotropic = needs.anisotropic || volume.phase.type == PhaseType::rayleigh ||
                        volume.phase.type == PhaseType::mie || volume.phase.g != 0 ||
                        (volume.phase.type == PhaseType::two_lobe && volume.phase.g2 != 0);
    needs.chromatic = needs.chromatic || !is_grey(volume.extinction_scale);
    needs.coloured = needs.coloured || !is_grey(volume.albedo);
  }
  needs.several_bounces = !scene.render.max_bounces || *scene.render.max_bounces > 1;
  for (const LightSettings& light : scene.lights) {
    const bool environment = light.type == LightType::environment || light.type == LightType::sky;
    needs.environment = needs.environment || environment;
    const Rgb& colour = light.type == LightType::distant ? light.irradiance
                        : environment                    ? light.radiance
                                                         : light.intensity;
    needs.coloured =
        needs.coloured || !is_grey(colour) || !light.image.empty() || light.type == LightType::sky;
    const bool escaping_rays = is_smooth_sky(light);
    if (scene.render.estimator == EstimatorType::path ? escaping_rays
                                                      : left_to_photons(light, scene.render))
      needs.first_flight = true;
    else
      needs.shadow_rays = true;
  }
  // What glows shines on what scatters; its photons need no shadow rays.
  if (scene.render.estimator != EstimatorType::path)
    needs.first_flight = needs.first_flight || needs.glows;
  needs.coloured = needs.coloured || needs.chromatic;
  const bool photon_estimator = scene.render.estimator != EstimatorType::path;
  const bool bounces = !scene.render.max_bounces || *scene.render.max_bounces > 0;
  const bool lit = !scene.lights.empty() || needs.glows;
  needs.scatters = needs.scatters && needs.visible && lit && bounces;
  needs.photons =
      photon_estimator && needs.scatters && (needs.several_bounces || needs.first_flight);
  needs.shadow_rays = needs.shadow_rays && needs.scatters;
  return needs;
}

/// The largest number stands for whatever does not fit in 64 bits.
std::uint64_t photon_memory(std::uint64_t photons, bool coloured) {
  const std::uint64_t bytes = coloured ? 110 : 90;
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  return photons > most / bytes ? most : photons * bytes;
}

std::string first_reason(std::initializer_list<std::pair<bool, const char*>> reasons) {
  for (const auto& [applies, reason] : reasons)
    if (applies)
      return reason;
  return "the scene uses it";
}

} // namespace

RenderPlan plan_stages(const Scene& scene, const std::vector<VolumeFacts>& volumes) {
  const Needs needs = find_needs(scene, volumes);
  const RenderSettings& render = scene.render;
  const bool path = render.estimator == EstimatorType::path;
  RenderPlan plan;
  const auto add = [&plan](const char* name, bool needed, const std::string& reason) {
    plan.stages.push_back({name, needed, reason});
  };
  const char* const no_medium = "no volume has any density";
  const char* const out_of_view = "the camera sees no medium";
  const char* const no_scattering = needs.medium && !needs.visible
                                        ? out_of_view
                                        : "nothing scatters: albedo 0, no light, or no bounces";
  add("read", !scene.volumes.empty(),
      scene.volumes.empty() ? "no volumes"
      : needs.glows         ? "density and emission grids only"
                            : "density grids only");
  add("majorants", needs.medium, needs.medium ? "the medium is not empty" : no_medium);
  add("surfaces", false, "no surfaces in the scene");
  add("photons", needs.photons,
      first_reason({{!needs.scatters, no_scattering},
                    {path, "the path estimator shoots none"},
                    {!needs.photons, "single bounce, all by shadow rays"}}));
  const bool beam = render.estimator == EstimatorType::beam;
  const bool by_view = beam && render.thinning != PhotonThinning::even && !(render.keep > 0);
  add("photon importance", needs.photons && by_view,
      first_reason({{!needs.photons, "no photons"},
                    {!beam, "only beam knows where its rays see photons"},
                    {!by_view, "photons are kept evenly, as asked for"}}));
  add("map", needs.photons, needs.photons ? "photons are gathered" : "no photons");
  add("neighbours", needs.photons && render.kernel == KernelRadius::adaptive,
      first_reason({{!needs.photons, "no photons"},
                    {render.kernel == KernelRadius::fixed, "the kernel's radius is fixed"}}));
  add("photon directions", needs.photons && needs.anisotropic,
      first_reason({{!needs.photons, "no photons"},
                    {!needs.anisotropic, "all phase functions are isotropic"}}));
  add("photon colour", needs.photons && needs.coloured,
      first_reason({{!needs.photons, "no photons"}, {!needs.coloured, "all colours are grey"}}));
  add("spectral tracking", needs.scatters && needs.chromatic,
      needs.chromatic ? "extinction differs between channels" : "extinction is grey");
  add("depth profiles", needs.visible,
      first_reason({{!needs.medium, no_medium}, {!needs.visible, out_of_view}}));
  add("emission", needs.glow_visible,
      first_reason({{!needs.glows, "no volume glows"},
                    {!needs.glow_visible, "the camera sees nothing of what glows"},
                    {true, "a volume glows"}}));
  add("shadow rays", needs.shadow_rays,
      first_reason({{!needs.scatters, no_scattering},
                    {!needs.shadow_rays, "every light is left to photons or to escaping rays"}}));
  add("beam query", needs.photons && beam,
      first_reason({{!needs.photons, "no photons"}, {!beam, "another estimator"}}));
  add("march", needs.photons && render.estimator == EstimatorType::march,
      first_reason({{!needs.photons, "no photons"},
                    {render.estimator != EstimatorType::march, "another estimator"}}));
  add("paths", path && needs.scatters,
      first_reason({{!path, "another estimator"}, {!needs.scatters, no_scattering}}));
  add("bias", needs.photons && render.bias_rays > 0,
      needs.photons && render.bias_rays > 0
          ? "kernels blur: some rays are followed by path tracing to tell how much"
          : first_reason({{!needs.photons, "no photons"}, {true, "render.bias_rays is 0"}}));
  add("environment", needs.environment,
      needs.environment ? "a light surrounds the scene" : "no environment light");

  constexpr std::uint64_t bytes_per_voxel = 6; // a brick of 9^3 floats per 8^3 voxels
  for (const VolumeFacts& volume : volumes)
    plan.volume_bytes +=
        volume.active_voxels * bytes_per_voxel + volume.glowing_voxels * 3 * bytes_per_voxel;
  if (needs.photons)
    plan.photon_bytes = photon_memory(render.photons.value_or(400000), needs.coloured);
  plan.film_bytes = film_memory(scene.image, scene.image.width, scene.image.height, scene.glows());
  return plan;
}

std::uint64_t film_memory(const ImageSettings& image, int width, int height, bool glows) {
  const auto pixels = [](int w, int h) {
    return static_cast<std::uint64_t>(w) * static_cast<std::uint64_t>(h);
  };
  const std::uint64_t pass = glows ? 56 : 44, developed = glows ? 72 : 60;
  return pass * pixels(image.width, image.height) +
         (Film::bytes_per_pixel(glows) + developed) * pixels(width, height);
}

namespace {

/// World bounds of all that a grid can make visible: a border voxel ramps to 0 over one voxel.
Boxd visible_bounds(const GridSummary& grid, const std::array<double, 12>& m) {
  Affine placed;
  placed.rows = {Vec3d{m[0], m[1], m[2]}, Vec3d{m[4], m[5], m[6]}, Vec3d{m[8], m[9], m[10]}};
  placed.translation = {m[3], m[7], m[11]};
  const Affine map = placed.after(grid.index_to_world);
  const Vec3d lower = Vec3d(grid.index_lower) - Vec3d(1),
              upper = Vec3d(grid.index_upper) + Vec3d(1);
  Boxd bounds;
  for (int corner = 0; corner < 8; ++corner)
    bounds.extend(map.point({corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y,
                             corner & 4 ? upper.z : lower.z}));
  return bounds;
}

} // namespace

namespace {

/// Voxels of the grids that a volume's emission is made from, as their headers say; 0 where one of
/// them is empty.
std::uint64_t count_glowing_voxels(const VolumeSettings& volume, Boxd& bounds) {
  std::uint64_t voxels = 0;
  if (!volume.glows())
    return voxels;
  for (const std::string& name : {volume.emission.temperature, volume.emission.intensity}) {
    if (name.empty())
      continue;
    const GridSummary grid = read_grid_header(volume.file, name);
    if (grid.active_voxels == 0)
      return 0;
    voxels += grid.active_voxels;
    bounds.extend(visible_bounds(grid, volume.transform));
  }
  return voxels;
}

} // namespace

RenderPlan make_plan(const Scene& scene) {
  std::vector<VolumeFacts> facts;
  Boxd bounds;
  for (const VolumeSettings& volume : scene.volumes) {
    VolumeFacts fact{true, 0};
    if (volume.needs_density()) {
      const GridSummary grid = read_grid_header(volume.file, volume.density);
      fact = {grid.active_voxels == 0, grid.active_voxels};
      if (!fact.empty)
        bounds.extend(visible_bounds(grid, volume.transform));
    }
    fact.glowing_voxels = count_glowing_voxels(volume, bounds);
    facts.push_back(fact);
  }
  const Camera camera(scene.camera, scene.image, {});
  for (VolumeFacts& fact : facts)
    fact.in_view = (!fact.empty || fact.glowing_voxels > 0) && camera.may_see(bounds);
  return plan_stages(scene, facts);
}

} // namespace vdbeam
