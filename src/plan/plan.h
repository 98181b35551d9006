#pragma once

#include "transport/world.h"
#include "vdbeam/render.h"

namespace vdbeam {

/// Facts of each volume that the plan needs beyond the scene file.
struct VolumeFacts {
  bool empty = false;
  std::uint64_t active_voxels = 0;
  bool in_view = true;              ///< false where no camera ray can meet it
  std::uint64_t glowing_voxels = 0; ///< of its emission grids; 0: it does not glow
};

/// The same of a world that is built already. `moves`: passes see other moments than this one, so
/// that nothing counts as out of view.
std::vector<VolumeFacts> volume_facts(const WorldFacts& facts, const World& world,
                                      const Camera& camera, bool moves = false);

/// Plan of the path estimator for the frame: quick looks are made by it, and the bias of
/// the other estimators is measured against it.
RenderPlan plan_paths(Scene scene, const std::vector<VolumeFacts>& volumes);

/// The stages that the scene needs, each with the reason why it runs or is left out, and estimates
/// of the memory that they take. A pure function of its arguments.
RenderPlan plan_stages(const Scene& scene, const std::vector<VolumeFacts>& volumes);

/// Bytes of a pass over the picture, and of the film and the picture developed from it where only
/// `width` x `height` pixels are wanted. `glows`: with emission; `groups`: of lights;
/// `objects`: whose coverage is asked for; `planes`: that layers ask for beyond the usual ones.
std::uint64_t film_memory(const ImageSettings& image, int width, int height, bool glows = false,
                          std::size_t groups = 0, std::size_t objects = 0, std::size_t planes = 0);

} // namespace vdbeam
