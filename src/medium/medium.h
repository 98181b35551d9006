#pragma once

#include "math/affine.h"
#include "math/ray.h"
#include "medium/grid_traversal.h"
#include "medium/majorant_grid.h"
#include "medium/medium_parts.h"
#include "medium/nests.h"
#include "medium/volume_tree.h"
#include "phase/aureole.h"
#include "phase/phase_function.h"
#include "phase/scattering_angles.h"
#include "volume/color_field.h"
#include "volume/emitter.h"
#include "volume/render_space.h"

#include <memory>
#include <vector>

namespace vdbeam {

/// A volume in render space: density grid, coefficients, phase function.
///   sigma_t(x) = density(x) * extinction * channel_scale,  sigma_s = albedo * color(x) * sigma_t
struct Volume {
  DensityField field;
  MajorantGrid majorants;                  ///< of the density
  Affinef to_local;                        ///< render space -> local coordinates of the field
  float extinction = 1;                    ///< per render unit, of the strongest channel
  Rgb channel_scale{1, 1, 1};              ///< in [0, 1], the largest is 1
  Rgb albedo{1, 1, 1};                     ///< where `color` does not multiply it
  std::shared_ptr<const ColorField> color; ///< multiplies the albedo; null: nothing does
  std::size_t setting = 0;                 ///< which volume of the scene it is
  int phase_index = 0;                     ///< index into Medium::phases
  float voxel_size = 1;                    ///< smallest edge of a voxel, render units
  bool limited = false;                    ///< densities were reduced to what can be tracked

  Vec3f local_point(const Vec3f& p) const { return to_local.point(p); }
  Vec3f local_vector(const Vec3f& v) const { return to_local.vector(v); }
  float density(const Vec3f& p) const { return field.sample(local_point(p)); }
  /// The density at a point that is known to lie inside: rounding may have put it beyond
  /// a face, where a field that ends sharply is 0.
  float density_inside(const Vec3f& p) const { return field.sample(field.nearest(local_point(p))); }
  Rgb albedo_at(const Vec3f& p) const {
    return color ? albedo * color->sample(local_point(p)) : albedo;
  }
  /// Offset of the 8^3 cell of a point, outside of the nearest one.
  std::size_t cell_at(const Vec3f& p) const;
  /// sigma_t of the strongest channel's majorant at a point; 0 outside.
  float majorant(const Vec3f& p) const;
  Affine to_render() const;
  /// Bounds of all of the field's cells, also of empty ones: light paths collide there, too.
  Boxd bounds() const;
  /// The segment in units of the field's 8^3 cells.
  GridTraversal traverse(const Segment& segment) const {
    return {local_point(segment.ray.origin) * 0.125f, local_vector(segment.ray.direction) * 0.125f,
            field.cell_counts(), segment.t_begin, segment.t_end};
  }
};

/// A value for each 8^3 cell of each volume of a medium.
using CellTables = std::vector<std::vector<float>>;

/// Delta-M truncation that made a medium from the scene's (similar_medium).
struct PeakTakenOut {
  int order = 0;                       ///< M of the delta-M method
  std::vector<PhaseFunction> original; ///< per phase function: the scene's
  std::vector<PhaseFunction> gathered; ///< smooth rests, under which photons are gathered
  std::vector<float> forward;          ///< shares of the peaks
  std::vector<Aureole> aureoles;       ///< about narrow lights, by the peaks
  /// Per volume: the scene's extinction, of its strongest channel, over the one at hand.
  std::vector<float> extinction_factor;
  /// Per volume: optical depth that was taken out, by channel, per optical depth at hand.
  std::vector<Rgb> excess;
};

/// All volumes of a scene; they may overlap, and coefficients add.
struct Medium {
  std::vector<Volume> volumes;       ///< only those with something in them
  std::vector<Emitter> emitters;     ///< of the volumes that glow, whether or not they do more
  std::vector<PhaseFunction> phases; ///< one per group of volumes with the same phase function
  std::shared_ptr<const ScatteringAngles> angles; ///< of the scene's phase functions; null: even
  std::shared_ptr<const PeakTakenOut> peak;       ///< null: this is the scene's own medium
  std::shared_ptr<const VolumeTree> tree;         ///< over the volumes; null: they are few
  MediumParts parts;                              ///< of like extinction
  Nests nests;                                    ///< of small volumes in large ones
  Boxf bounds;                                    ///< of all that is not empty, render space
  bool chromatic = false;                         ///< extinction differs between channels

  /// Phase functions by which camera rays weigh photons.
  const std::vector<PhaseFunction>& gathered_phases() const {
    return peak ? peak->gathered : phases;
  }
  /// Nothing absorbs or scatters.
  bool empty() const { return volumes.empty(); }
  /// There is something to look at.
  bool visible() const { return !volumes.empty() || !emitters.empty(); }
  bool isotropic() const;
  /// The albedo of a volume changes from place to place.
  bool colored() const {
    for (const Volume& volume : volumes)
      if (volume.color)
        return true;
    return false;
  }
  std::size_t bytes() const;
  /// Number of one of the volumes.
  std::size_t index_of(const Volume& volume) const {
    return static_cast<std::size_t>(&volume - volumes.data());
  }
  std::size_t part_of(const Volume& volume) const { return parts[index_of(volume)]; }
  /// Sum of the majorants of a part's volumes at a point, without that of `but`: the rate of
  /// tentative collisions in the part.
  float majorant(const Vec3f& point, std::size_t part, const Volume* but = nullptr) const;
  /// Puts a tree over the volumes, where they are many.
  void grow_tree();
  /// Calls visit(v) for the volumes that the segment may meet, in the order of their numbers; it
  /// must not call this function.
  template <class Visit>
  void for_each_met(const Segment& segment, const Visit& visit) const {
    if (!tree) {
      for (std::size_t v = 0; v < volumes.size(); ++v)
        visit(v);
      return;
    }
    static thread_local std::vector<std::uint32_t> met;
    met.clear();
    tree->find(segment, met);
    for (const std::uint32_t v : met)
      visit(std::size_t{v});
  }
  /// The same for those in whose box a point may lie; all of them where there is no tree.
  template <class Visit>
  void for_each_at(const Vec3f& point, const Visit& visit) const {
    for_each_met({{point, Vec3f(0)}, 0, 0}, visit);
  }
  /// Part of the segment inside `bounds`; empty where it misses.
  Segment clip(Segment segment) const;
};

inline std::size_t Volume::cell_at(const Vec3f& p) const {
  const Vec3<int>& n = field.cell_counts();
  const Vec3f last = Vec3f(n) - Vec3f(1);
  const Vec3f cell = min(max(local_point(p) * 0.125f, Vec3f(0)), last);
  return field.cell_offset(static_cast<int>(cell.x), static_cast<int>(cell.y),
                           static_cast<int>(cell.z));
}

inline float Volume::majorant(const Vec3f& p) const {
  const Vec3f cell = local_point(p) * 0.125f;
  const Vec3<int>& n = field.cell_counts();
  if (!(cell.x >= 0 && cell.y >= 0 && cell.z >= 0 && cell.x < static_cast<float>(n.x) &&
        cell.y < static_cast<float>(n.y) && cell.z < static_cast<float>(n.z)))
    return 0;
  return extinction *
         majorants[field.cell_offset(static_cast<int>(cell.x), static_cast<int>(cell.y),
                                     static_cast<int>(cell.z))];
}

} // namespace vdbeam
