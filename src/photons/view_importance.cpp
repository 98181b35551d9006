#include "photons/view_importance.h"

#include "medium/depth_profile.h"
#include "transport/camera_ray.h"
#include "tuning/constants.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <atomic>

namespace vdbeam {

namespace {

/// Raises a value that other threads may raise too; the result does not depend on their order.
void raise(float& value, float to) {
  const std::atomic_ref<float> shared(value);
  float seen = shared.load(std::memory_order_relaxed);
  while (seen < to && !shared.compare_exchange_weak(seen, to, std::memory_order_relaxed))
    continue;
}

/// Infinite in channels in which nothing scatters, so that no photon is of use.
Rgb hidden_channels(const Medium& medium) {
  Rgb hidden(infinity);
  for (const Volume& volume : medium.volumes)
    for (int c = 0; c < 3; ++c)
      if (volume.channel_scale[c] * volume.albedo[c] > 0)
        hidden[c] = 0;
  return hidden;
}

/// Raises the cells that the ray meets to the transmittance with which it enters them, of the
/// clearest channel that is not hidden, times `weight`.
void mark_cells(const Medium& medium, std::size_t volume, const Rgb& hidden, float weight,
                const Ray& ray, const DepthProfile& profile, std::vector<float>& table) {
  GridTraversal walk = medium.volumes[volume].traverse({ray, profile.front(), profile.back()});
  if (walk.done()) // as most of many small volumes are
    return;
  const DensityField& field = medium.volumes[volume].field;
  ProfileCursor cursor(profile);
  for (; !walk.done(); walk.advance()) {
    cursor.move_to(walk.t());
    const Rgb tau = hidden + cursor.channels(medium);
    const Vec3<int>& cell = walk.cell();
    raise(table[field.cell_offset(cell.x, cell.y, cell.z)],
          weight * std::exp(-std::min(tau.x, std::min(tau.y, tau.z))));
  }
}

/// A way that light takes to the camera, from the camera on.
struct Sight {
  CameraRay ray;
  float weight = 1; ///< of what is seen at its end, in the strongest channel
  int mirrors = 0;  ///< that it has met
};

/// Marks what camera rays see, behind mirrors and glass too.
class ViewMarker {
public:
  ViewMarker(const World& world, float floor, CellTables& tables)
      : world_(world), floor_(floor), hidden_(hidden_channels(world.medium)), tables_(tables) {}

  /// `number`: of the ray, from which its random numbers follow.
  void mark(const CameraRay& ray, std::uint64_t number, DepthProfile& profile) const {
    const Medium& medium = world_.medium;
    Rng rng({}, RngStage::line, number);
    std::vector<Sight> sights{{ray}};
    while (!sights.empty()) {
      const Sight sight = std::move(sights.back());
      sights.pop_back();
      profile.build(medium, sight.ray.segment, floor_);
      if (!profile.empty())
        medium.for_each_met({sight.ray.segment.ray, profile.front(), profile.back()},
                            [&](std::size_t v) {
                              mark_cells(medium, v, hidden_, sight.weight, sight.ray.segment.ray,
                                         profile, tables_[v]);
                            });
      if (sight.ray.hit && sight.mirrors < most_mirrors)
        go_on(sight, rng, sights);
    }
  }

private:
  static constexpr int most_mirrors = 6;

  /// The ways on from the surface at which the ray ends.
  void go_on(const Sight& sight, Rng& rng, std::vector<Sight>& sights) const {
    const SurfaceVertex vertex(*world_.surfaces, *sight.ray.hit, sight.ray.ray().direction);
    const Material& material = vertex.material();
    if (!material.shows_surroundings())
      return;
    std::vector<MaterialSample> ways;
    if (material.is_specular()) {
      const SpecularBranches both = vertex.branches(Carried::radiance);
      ways = {both.reflected, both.refracted};
    } else {
      ways = {vertex.sample(Carried::radiance, rng)};
    }
    for (const MaterialSample& way : ways) {
      const float weight = sight.weight * max_component(way.weight * vertex.absorbed());
      if (!(weight > floor_))
        continue;
      sights.push_back({ray_from_surface(world_, vertex.hit().leave(way.wi), way.wi), weight,
                        sight.mirrors + 1});
    }
  }

  const World& world_;
  float floor_;
  Rgb hidden_;
  CellTables& tables_;
};

/// Lets values fall no faster than to `falls[axis]` from cell to cell along each axis of the grid.
void spread(const Vec3<int>& counts, const Vec3f& falls, std::vector<float>& table) {
  const Vec3<std::ptrdiff_t> strides{static_cast<std::ptrdiff_t>(counts.y) * counts.z, counts.z, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const std::ptrdiff_t stride = strides[axis];
    const float fall = falls[axis];
    tbb::parallel_for(0, counts[u], [&](int i) {
      for (int j = 0; j < counts[v]; ++j) {
        float* line = table.data() + i * strides[u] + j * strides[v];
        for (int k = 1; k < counts[axis]; ++k)
          line[k * stride] = std::max(line[k * stride], fall * line[(k - 1) * stride]);
        for (int k = counts[axis] - 2; k >= 0; --k)
          line[k * stride] = std::max(line[k * stride], fall * line[(k + 1) * stride]);
      }
    });
  }
}

/// Remaining fraction per cell along each axis of a volume's grid, at 1 / e per `reach`.
Vec3f falls_per_cell(const Volume& volume, float reach) {
  const Affine to_render = volume.to_render();
  Vec3f falls;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d edge;
    edge[axis] = cell_width;
    falls[axis] = std::exp(-static_cast<float>(length(to_render.vector(edge))) / reach);
  }
  return falls;
}

} // namespace

CellTables view_importance(const World& world, const Camera& camera, float reach, float floor,
                           std::uint64_t& rays, const StopToken* stop) {
  const Medium& medium = world.medium;
  CellTables tables;
  for (const Volume& volume : medium.volumes) {
    const Vec3<int>& n = volume.field.cell_counts();
    tables.emplace_back(static_cast<std::size_t>(n.x) * n.y * n.z, 0.0f);
  }
  const int longer = std::max(camera.width(), camera.height());
  const double spacing = static_cast<double>(longer) / tuning::importance_rays_across;
  const int columns = static_cast<int>(std::ceil(camera.width() / spacing));
  const int rows = static_cast<int>(std::ceil(camera.height() / spacing));
  const ViewMarker marker(world, floor, tables);
  tbb::enumerable_thread_specific<DepthProfile> profiles;
  tbb::parallel_for(0, rows, [&](int row) {
    DepthProfile& profile = profiles.local();
    for (int column = 0; column < columns && !(stop && stop->stopped()); ++column) {
      const EyeRay eye = camera.ray((column + 0.5) * camera.width() / columns,
                                    (row + 0.5) * camera.height() / rows);
      marker.mark(camera_ray(world, camera, eye),
                  static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(columns) +
                      static_cast<std::uint64_t>(column),
                  profile);
    }
  });
  rays += static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
  for (std::size_t v = 0; v < medium.volumes.size(); ++v) {
    const Volume& volume = medium.volumes[v];
    spread(volume.field.cell_counts(), falls_per_cell(volume, reach), tables[v]);
    for (float& value : tables[v])
      value = std::max(value, floor);
  }
  return tables;
}

} // namespace vdbeam
