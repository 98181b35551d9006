#include "plan/memory_model.h"

#include "camera/camera.h"
#include "estimators/estimator_table.h"
#include "estimators/gather/gather_pass.h"
#include "film/deep_film.h"
#include "film/film.h"
#include "image/deep_layout.h"
#include "layers/plane_layers.h"
#include "lights/light_groups.h"
#include "machine/threads.h"
#include "materials/material_table.h"
#include "medium/nests.h"
#include "medium/shadow_lattice.h"
#include "photonmap/photon_blocks.h"
#include "photonmap/photon_map.h"
#include "photons/photon_pass.h"
#include "plan/plan.h"
#include "prepare/prepared_scene.h"
#include "vdbeam/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

constexpr std::uint64_t mib = std::uint64_t{1} << 20;
/// Libraries and the program itself before it has read anything.
constexpr std::uint64_t program_bytes = 46 * mib;
/// Stack, allocator and the tile of a thread.
constexpr std::uint64_t thread_bytes = 2 * mib;
/// Majorants, importance of a field's cells, and where light is sampled.
constexpr std::uint64_t cell_bytes = 3 * sizeof(float);
/// A mesh with its tree, of what it takes while it is read.
constexpr double kept_of_surfaces = 0.3;
/// Photons that a light path leaves in a thin medium per optical depth of the medium: the middle of
/// the sample scenes, which have 0.5 to 1.6; and the fewest, so that paths remain to be counted.
constexpr double stored_per_depth = 0.9, fewest_stored = 0.01;
/// Memory per pixel while an image is written: half floats beside its own channels, and the
/// preview.
constexpr std::uint64_t written_bytes_per_pixel = 24;

/// Whether a ray meets a cell of the set.
bool meets(const CellSet& set, const Affine& from_world, const EyeRay& ray) {
  const Vec3d origin = from_world.point(ray.origin), along = from_world.vector(ray.direction);
  const Boxd box = set.bounds();
  double begin = 0, end = 1e300;
  for (int a = 0; a < 3; ++a) {
    double near = (box.lower[a] - origin[a]) / along[a],
           far = (box.upper[a] - origin[a]) / along[a];
    if (near > far)
      std::swap(near, far);
    begin = std::fmax(begin, near);
    end = std::fmin(end, far);
  }
  constexpr int most_steps = 4096;
  constexpr double voxel = 1.0 / cell_width;
  const double step = std::max(voxel / length(along), (end - begin) / most_steps);
  for (double t = begin; t <= end; t += step)
    if (set.may_hold(origin + along * t))
      return true;
  return false;
}

/// Share of the picture's rays that meet a volume. `glow`: also where it does nothing but glow.
double share_of_hits(const Scene& scene, const VolumesMemory& volumes, bool glow) {
  constexpr int samples = 48;
  const Camera camera(scene.camera, scene.image, {});
  std::vector<Affine> from_world;
  for (const SeenCells& seen : volumes.seen)
    from_world.push_back(seen.to_world.inverse());
  int hits = 0;
  for (int y = 0; y < samples; ++y)
    for (int x = 0; x < samples; ++x) {
      const EyeRay ray =
          camera.ray((x + 0.5) * camera.width() / samples, (y + 0.5) * camera.height() / samples);
      bool met = false;
      for (std::size_t i = 0; i < volumes.seen.size() && !met; ++i)
        met = (glow || volumes.seen[i].dims) && !volumes.seen[i].cells.empty() &&
              meets(volumes.seen[i].cells, from_world[i], ray);
      hits += met ? 1 : 0;
    }
  return hits / static_cast<double>(samples * samples);
}

class MemoryModel {
public:
  MemoryModel(const Scene& scene, const VolumesMemory& volumes, const RenderPlan& plan)
      : scene_(scene), volumes_(volumes), plan_(plan),
        pixels_(static_cast<std::uint64_t>(scene.image.raster_width()) *
                static_cast<std::uint64_t>(scene.image.raster_height())),
        hits_(share_of_hits(scene, volumes, true)) {}

  MemoryPlan estimate(int references) {
    result_.kept = volumes_.kept;
    result_.film = plan_.film_bytes + plan_.deep_bytes;
    const std::uint64_t program =
        program_bytes + static_cast<std::uint64_t>(thread_count(scene_.render)) * thread_bytes;
    add("program", "", "", program, program, program);
    add("volumes", volumes_.largest, volume_remedy(), volumes_.reading, volumes_.kept,
        volumes_.kept);
    const std::uint64_t cells = cell_bytes * volumes_.cells;
    add("cells", volumes_.largest, volume_remedy(), 0, cells, cells);
    const std::uint64_t surfaces = times(kept_of_surfaces, plan_.surface_bytes);
    add("surfaces", "mesh", "use meshes of fewer triangles and smaller textures",
        plan_.surface_bytes, surfaces, surfaces);
    add_photons();
    add_shadows();
    add_film();
    add_deep();
    add_references(references);
    result_.program = program;
    return std::move(result_);
  }

private:
  void add(const std::string& name, const std::string& part, const std::string& remedy,
           std::uint64_t reading, std::uint64_t rendering, std::uint64_t writing) {
    const std::uint64_t most = std::max({reading, rendering, writing});
    if (most == 0)
      return;
    result_.parts.push_back({name, reading, rendering, writing});
    result_.reading += reading;
    result_.rendering += rendering;
    result_.writing += writing;
    if (!part.empty() && most > largest_) {
      largest_ = most;
      result_.largest_part = part;
      result_.remedy = remedy;
    }
  }

  std::string volume_remedy() const {
    return volumes_.why.empty()
               ? "crop the volume by box_lower and box_upper, or use a coarser one"
               : fmt::format("leave out {}, or use a coarser volume", volumes_.why);
  }

  /// Photons of a pass.
  double photons() const {
    if (!plan_.needs(Stage::photons) && !plan_.needs(Stage::surface_photons))
      return 0;
    const double stored = volumes_.depth < 0 ? tuning::stored_per_path
                                             : std::clamp(stored_per_depth * volumes_.depth,
                                                          fewest_stored, tuning::stored_per_path);
    const auto& asked = scene_.render.photons;
    const double hits = share_that_wants_photons() * static_cast<double>(pixels_);
    return stored * (asked ? paths_for_photons(static_cast<double>(*asked), stored)
                           : automatic_paths(hits, stored, stored));
  }

  /// Where mirrors, metal or glass may throw light onto surfaces, every pixel may show one: how
  /// much of the image they cover is not known before the meshes are read.
  double share_that_wants_photons() const {
    const bool throws = std::any_of(
        scene_.surfaces.begin(), scene_.surfaces.end(), [](const SurfaceSettings& surface) {
          return material_kind(surface.material.type).make(surface.material, 1)->throws_light();
        });
    return throws && plan_.needs(Stage::surface_photons) ? 1
                                                         : share_of_hits(scene_, volumes_, false);
  }

  void add_photons() {
    const double count = photons();
    const bool directions = plan_.needs(Stage::photon_directions);
    const bool groups = !light_group_names(scene_).empty();
    const int channels = plan_.needs(Stage::photon_color) ? 3 : 1;
    const std::size_t each = PhotonMap::build_bytes_per_photon(channels, directions, groups);
    add("photons", "render.photons", "use fewer photons and more passes", 0, times(count, each), 0);
    // Where nothing but the camera moves and photons are stored evenly, frames share their maps.
    if (scene_.render.seeds == SeedPolicy::correlated &&
        scene_.render.thinning == PhotonThinning::even && count > 0) {
      const std::uint64_t maps =
          times(count * scene_.render.passes.value_or(1 << 20),
                PhotonBlocks::bytes_per_photon(channels, directions, groups));
      const std::uint64_t kept = std::min(maps, photon_cache_capacity());
      add("photon cache", "render.seeds", "set render.seeds = \"per_frame\"", 0, kept, kept);
    }
  }

  /// Each light has shadows of its own, each moment of the shutter coarse ones.
  void add_shadows() {
    if (!plan_.needs(Stage::shadow_rays) ||
        !estimator_kind(scene_.render.estimator).shoots_photons())
      return;
    std::vector<Boxd> boxes;
    std::vector<double> areas;
    std::vector<std::vector<std::size_t>> lattices(1); // over all volumes, and over each nest
    for (const SeenCells& seen : volumes_.seen) {
      if (!seen.dims || seen.cells.empty())
        continue;
      lattices[0].push_back(boxes.size());
      boxes.push_back(seen.to_world.bounds(seen.cells.bounds()));
      const Vec3d size = boxes.back().size();
      areas.push_back(size.x * size.y + size.y * size.z + size.z * size.x);
    }
    if (boxes.empty())
      return;
    const Nests nests = find_nests(areas);
    lattices.insert(lattices.end(), nests.begin(), nests.end());
    const bool moves = volumes_.moments > 0 && plan_.needs(Stage::photon_importance);
    const double rays = PhotonPass::shadow_rays_per_pixel(moves) * static_cast<double>(pixels_);
    std::uint64_t bytes = 0;
    for (const std::vector<std::size_t>& lattice : lattices) {
      Boxd bounds;
      for (const std::size_t i : lattice)
        bounds.extend(boxes[i]);
      for (std::size_t i = 0; i < scene_.lights.size(); ++i)
        if ((scene_.lights[i].type == LightType::distant ||
             scene_.lights[i].type == LightType::sun) &&
            plan_.shadow_ray_lights[i])
          bytes += ShadowLattice::bytes(Boxf{Vec3f(bounds.lower), Vec3f(bounds.upper)},
                                        Vec3f(normalize(scene_.lights[i].direction)) * -1.0f, rays);
    }
    bytes *= std::max<std::uint64_t>(1, volumes_.moments);
    add("shadows", "", "", 0, bytes, bytes);
  }

  void add_film() {
    const bool walks = plan_.needs(Stage::photons) && plan_.needs(Stage::beam_query) &&
                       estimator_kind(scene_.render.estimator).may_gather();
    // The picture that is written is developed once photons are gone.
    const std::uint64_t film = plan_.film_bytes,
                        developed = pixels_ * (Film::developed_bytes_per_pixel(scene_.glows()) +
                                               sizeof(float) * plane_names(scene_).size());
    add("film", "image", "render a smaller image", 0, film - developed, film);
    if (walks)
      add("walks", "image", "render a smaller image", 0,
          pixels_ * PassImage::bytes_per_pixel(scene_.glows()), 0);
    add("writing", "", "", 0, 0, pixels_ * written_bytes_per_pixel);
  }

  void add_deep() {
    if (!scene_.image.deep)
      return;
    // The film has a layout; passes have another one, with the rows that it was cut in.
    constexpr std::uint64_t layout = 8 * sizeof(float);
    // A developed sample has colour, opacity and two ends; writing it takes two floats more.
    constexpr std::uint64_t developed = 8 * sizeof(float);
    const std::uint64_t pieces =
        times(hits_, plan_.deep_bytes / DeepFilm::bytes_per_piece()) + pixels_;
    const std::uint64_t kept = pieces * (DeepFilm::bytes_per_piece() + layout);
    add("deep", "image.deep", "raise image.deep_alpha or image.deep_depth", 0, kept,
        kept + pieces * developed);
  }

  /// Their colours and, where they are compared, two errors of each pixel, whose memory the
  /// allocator keeps. For that the picture is developed after each pass.
  void add_references(int count) {
    const std::uint64_t bytes =
        static_cast<std::uint64_t>(count) * pixels_ * (3 * sizeof(float) + 2 * sizeof(double));
    const std::uint64_t developed = pixels_ * Film::developed_bytes_per_pixel(scene_.glows());
    add("references", "--reference", "render a smaller image, or without a reference", 0,
        count > 0 ? bytes + developed : 0, bytes);
  }

  const Scene& scene_;
  const VolumesMemory& volumes_;
  const RenderPlan& plan_;
  MemoryPlan result_;
  std::uint64_t pixels_;
  double hits_;
  std::uint64_t largest_ = 0;
};

} // namespace

MemoryPlan estimate_memory(const Scene& scene, const RenderPlan& plan, const VolumesMemory& volumes,
                           int references) {
  return MemoryModel(scene, volumes, plan).estimate(references);
}

MemoryPlan plan_memory(const Scene& scene, int references) {
  return estimate_memory(scene, make_plan(scene), estimate_volumes(scene), references);
}

} // namespace vdbeam
