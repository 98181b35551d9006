#include "plan/plan.h"

#include "estimators/gather/gather_pass.h"
#include "film/cryptomatte.h"
#include "film/film.h"
#include "layers/plane_layers.h"
#include "lights/light_groups.h"
#include "photonmap/photon_map.h"
#include "plan/plan_needs.h"
#include "shading/surface_fit.h"
#include "transport/camera_ray.h"
#include "volume/emission_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace vdbeam {
namespace {

/// Photons of a pass where their number is chosen by the estimator.
constexpr std::uint64_t usual_photons = 800000;

std::string first_reason(std::initializer_list<std::pair<bool, std::string>> reasons) {
  for (const auto& [applies, reason] : reasons)
    if (applies)
      return reason;
  return {};
}

/// The rules, one group of stages after the other. A stage that the estimator cannot run is left
/// out, whatever the scene.
class Planner {
public:
  Planner(const Scene& scene, const EstimatorKind& estimator, const PlanNeeds& needs)
      : scene_(scene), estimator_(estimator), needs_(needs),
        no_scattering_(needs.medium && !needs.visible
                           ? out_of_view
                           : "nothing scatters: albedo 0, no light, or no bounces") {}

  std::vector<PlanStage> plan() {
    add_medium();
    add_photons();
    add_map();
    add_camera_rays();
    add_gathering();
    add_bias();
    add(Stage::environment, needs_.surrounded,
        needs_.surrounded ? "a light surrounds the scene" : "no light surrounds the scene");
    const bool moves = !scene_.moments.empty();
    add(Stage::moments, moves,
        moves ? "the shutter is open: each pass renders one motion sample"
              : "nothing moves, or the shutter is closed");
    add(Stage::deep, scene_.image.deep,
        scene_.image.deep ? "image.deep: light and opacity are accumulated per deep sample"
                          : "image.deep is false");
    return std::move(stages_);
  }

private:
  static constexpr const char* out_of_view = "the camera sees no medium";
  static constexpr const char* no_medium = "no volume has any density";
  static constexpr const char* no_photons = "no photons";
  static constexpr const char* other_estimator = "another estimator";

  void add(Stage stage, bool needed, const std::string& reason) {
    stages_.push_back({stage, needed, reason});
  }
  bool runs(Stage stage) const { return estimator_.stages.contains(stage); }

  void add_medium() {
    const bool files = std::any_of(scene_.volumes.begin(), scene_.volumes.end(),
                                   [](const VolumeSettings& volume) { return !volume.fog.made(); });
    add(Stage::read, files,
        scene_.volumes.empty()    ? "no volumes"
        : !files                  ? "no volume has a file: their densities are formulas"
        : !scene_.moments.empty() ? "density, emission and velocity grids"
        : needs_.glows            ? "density and emission grids only"
                                  : "density grids only");
    add(Stage::majorants, needs_.medium,
        needs_.medium ? "free flights need an upper bound of the extinction" : no_medium);
    const bool surfaces = !scene_.surfaces.empty();
    add(Stage::surfaces, surfaces,
        surfaces ? "rays are intersected with the meshes" : "no meshes in the scene");
  }

  void add_photons() {
    const RenderSettings& render = scene_.render;
    const bool sees = runs(Stage::photon_importance);
    const bool by_view = render.thinning != PhotonThinning::even;
    add(Stage::photons, needs_.photons,
        first_reason({{!needs_.scatters, no_scattering_},
                      {!runs(Stage::photons),
                       fmt::format("the {} estimator traces no photons", estimator_.name)},
                      {!needs_.photons, "single scattering only, all by shadow rays"},
                      {true, "photons carry the multiple scattering"}}));
    const bool importance = needs_.photons && sees && by_view;
    add(Stage::photon_importance, importance,
        first_reason({{!needs_.photons, no_photons},
                      {!sees, "the estimator stores photons independently of the view"},
                      {!by_view, "render.thinning is \"even\""},
                      {true, "photons are stored by their importance for the camera"}}));
    // Where photons may serve frames with other views, kernels must not depend on the view either.
    const bool pilot = importance && runs(Stage::kernel_pilot) &&
                       render.kernel == KernelRadius::adaptive && render.neighbours == 0 &&
                       render.store == PhotonStore::fluence;
    add(Stage::kernel_pilot, pilot,
        first_reason(
            {{pilot, "a few small photon maps choose the kernel width, unless photons are few"},
             {!needs_.photons, no_photons},
             {render.kernel == KernelRadius::fixed, "render.kernel is \"fixed\""},
             {render.neighbours > 0, "render.neighbours is given"},
             {render.store != PhotonStore::fluence, "render.store is \"scatter\""},
             {true, "photons are independent of the view"}}));
    add(Stage::surface_photons, needs_.surface_photons,
        first_reason({{needs_.surface_photons,
                       "caustics and light scattered onto surfaces come from photons"},
                      {!runs(Stage::surface_photons),
                       fmt::format("the {} estimator traces no photons", estimator_.name)},
                      {true, "paths find what the medium sends on to surfaces"}}));
  }

  void add_map() {
    add(Stage::map, needs_.photons,
        needs_.photons ? "photons are sorted into a kd-tree" : no_photons);
    const bool fixed = scene_.render.kernel == KernelRadius::fixed;
    add(Stage::neighbours, needs_.photons && !fixed,
        first_reason({{!needs_.photons, no_photons},
                      {fixed, "the kernel's radius is fixed"},
                      {true, "each kernel's radius follows the local photon density"}}));
    add(Stage::photon_directions, needs_.photons && needs_.anisotropic,
        first_reason({{!needs_.photons, no_photons},
                      {!needs_.anisotropic, "all phase functions are isotropic"},
                      {true, "the phase function depends on the photon's direction"}}));
    const bool grid = std::any_of(scene_.volumes.begin(), scene_.volumes.end(),
                                  [](const VolumeSettings& v) { return !v.color_grid.empty(); });
    add(Stage::photon_color, needs_.photons && needs_.colored,
        first_reason({{!needs_.photons, no_photons},
                      {grid, "a colour grid multiplies the albedo"},
                      {!needs_.colored, "albedo, extinction and lights are achromatic"},
                      {true, "albedo, extinction or lights differ between channels"}}));
  }

  void add_camera_rays() {
    add(Stage::spectral_tracking, needs_.scatters && needs_.chromatic,
        needs_.chromatic ? "extinction differs between channels" : "extinction is achromatic");
    add(Stage::depth_profiles, needs_.visible,
        first_reason({{!needs_.medium, no_medium},
                      {!needs_.visible, out_of_view},
                      {true, "transmittance along each camera ray"}}));
    add(Stage::emission, needs_.glow_visible,
        first_reason({{!needs_.glows, "no volume emits light"},
                      {!needs_.glow_visible, "no emission is visible to the camera"},
                      {true, "a volume emits light"}}));
    add(Stage::shadow_rays, needs_.shadow_rays(),
        first_reason(
            {{!needs_.scatters, no_scattering_},
             {!needs_.shadow_rays(), "every light is sampled by photons or by escaping rays"},
             {true, "single scattering by next-event estimation from camera rays"}}));
  }

  void add_gathering() {
    for (const Stage stage : {Stage::beam_query, Stage::march})
      add(stage, needs_.photons && runs(stage),
          first_reason(
              {{!needs_.photons, no_photons},
               {!runs(stage), other_estimator},
               {stage == Stage::march, "photons are gathered step by step along each camera ray"},
               {true, "photons are gathered along camera rays, or where walks from them end"}}));
    const bool paths = runs(Stage::paths);
    add(Stage::paths, needs_.scatters && paths,
        first_reason({{!paths, other_estimator},
                      {!needs_.scatters, no_scattering_},
                      {true, "multiple scattering by random walks"}}));
  }

  void add_bias() {
    const bool asked = scene_.render.bias_rays > 0;
    add(Stage::bias, needs_.photons && asked && runs(Stage::bias),
        first_reason(
            {{!needs_.photons, no_photons},
             {!asked, "render.bias_rays is 0"},
             {needs_.specular,
              "the kernels' bias is measured; path tracing may miss caustics, so no "
              "rays are path traced"},
             {true, "a fraction of the rays is path traced to estimate the kernels' bias"}}));
  }

  const Scene& scene_;
  const EstimatorKind& estimator_;
  const PlanNeeds& needs_;
  const char* no_scattering_;
  std::vector<PlanStage> stages_;
};

/// A ray that ends in opaque matter after the whole medium has the most pieces.
std::uint64_t deep_memory(const ImageSettings& image) {
  constexpr double by_depth = 16, share = 1.0 / 3;
  const double pieces = share * (1 / image.deep_alpha + by_depth);
  return static_cast<std::uint64_t>(pieces * image.raster_width() * image.raster_height() *
                                    static_cast<double>(DeepFilm::bytes_per_piece()));
}

/// The largest number stands for whatever does not fit in 64 bits.
std::uint64_t photon_memory(std::uint64_t photons, int channels, bool directions, bool groups) {
  const std::uint64_t bytes = PhotonMap::build_bytes_per_photon(channels, directions, groups);
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  return photons > most / bytes ? most : photons * bytes;
}

} // namespace

RenderPlan plan_stages(const Scene& scene, const std::vector<VolumeFacts>& volumes) {
  const EstimatorKind& estimator = estimator_kind(scene.render.estimator);
  const PlanNeeds needs = find_needs(scene, volumes, estimator);
  RenderPlan plan;
  plan.estimator = estimator.name;
  plan.stages = Planner(scene, estimator, needs).plan();
  plan.shadow_ray_lights = needs.shadow_ray_lights;
  plan.motion_samples = scene.moments.size();
  plan.unbiased =
      !scene.render.clamp && (estimator.unbiased || (estimator.shoots_photons() && !needs.photons));
  const std::size_t groups = light_group_names(scene).size();
  const std::uint64_t pixels = static_cast<std::uint64_t>(scene.image.raster_width()) *
                               static_cast<std::uint64_t>(scene.image.raster_height());
  if (needs.photons)
    plan.photon_bytes = photon_memory(scene.render.photons.value_or(usual_photons),
                                      needs.colored ? 3 : 1, needs.anisotropic, groups > 0);
  if (scene.image.deep)
    plan.deep_bytes = deep_memory(scene.image);
  plan.film_bytes = film_memory(
      scene.image, scene.image.raster_width(), scene.image.raster_height(), scene.glows(), groups,
      scene.image.cryptomatte ? scene_objects(scene).names.size() : 0, plane_names(scene).size());
  if (!scene.surfaces.empty() && estimator.shoots_photons())
    plan.film_bytes += SurfaceFit::bytes_per_pixel(groups) * pixels;
  if (plan.needs(Stage::photons) && plan.needs(Stage::beam_query) && estimator.may_gather())
    plan.film_bytes += GatherPass::bytes_per_pixel(groups) * pixels;
  return plan;
}

std::vector<VolumeFacts> volume_facts(const WorldFacts& facts, const World& world,
                                      const Camera& camera, bool moves) {
  std::vector<VolumeFacts> volumes;
  // Where the shutter is open, what is out of view may come into it.
  for (const WorldFacts::Voxels& voxels : facts.volumes)
    volumes.push_back({voxels.density == 0, voxels.density, moves || may_see_medium(world, camera),
                       voxels.emission});
  return volumes;
}

RenderPlan plan_paths(Scene scene, const std::vector<VolumeFacts>& volumes) {
  scene.render.estimator = EstimatorType::path;
  return plan_stages(scene, volumes);
}

std::uint64_t film_memory(const ImageSettings& image, int width, int height, bool glows,
                          std::size_t groups, std::size_t objects, std::size_t planes) {
  const auto pixels = [](int w, int h) {
    return static_cast<std::uint64_t>(w) * static_cast<std::uint64_t>(h);
  };
  constexpr std::size_t cryptomatte = 2 * CryptomatteWriter::ranks * sizeof(float);
  return (objects > 0 ? cryptomatte : 0) * pixels(width, height) +
         objects * Film::bytes_per_pixel_of_object() * pixels(width, height) +
         planes * Film::bytes_per_pixel_of_plane() * pixels(width, height) +
         PassImage::bytes_per_pixel(glows) * pixels(image.raster_width(), image.raster_height()) +
         groups * sizeof(Rgb) * pixels(image.raster_width(), image.raster_height()) +
         (Film::bytes_per_pixel(glows) + Film::developed_bytes_per_pixel(glows) +
          groups * Film::bytes_per_pixel_of_group()) *
             pixels(width, height);
}

} // namespace vdbeam
