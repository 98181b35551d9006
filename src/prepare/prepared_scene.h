#pragma once

#include "math/stop_token.h"
#include "photons/photon_cache.h"
#include "prepare/source_grid.h"
#include "transport/world.h"
#include "vdb/vector_reader.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"

#include <memory>
#include <string>
#include <vector>

namespace vdbeam {

/// One volume of a scene as it was read, so that the next frame need not read it again.
struct ReadVolume {
  std::string
      emission_identity; ///< file, its size and time of change, what the emission is made of
  EmissionGrid emission;
  std::string identity; ///< file, its size and time of change, grid; empty: nothing was read
  DensityGrid facts;    ///< all but the field
  int index = -1;       ///< where the medium holds its field; -1: it is empty
  /// Its velocity, read where passes see it at several moments; null where it has none.
  std::shared_ptr<const VectorField> velocity;
  std::string velocity_identity; ///< what it was read from; empty: nothing was read
  Colors colors;                 ///< of its color_grid
  std::string color_identity;    ///< what they were read from; empty: nothing was read
  /// Data for making motion samples of its scene, beyond the world.
  std::vector<SourceGrid> sources;
  std::uint64_t grids_read = 0; ///< from its file; not those that were kept
};

class PreparedScene {
public:
  std::shared_ptr<const World> world;
  WorldFacts facts;
  std::vector<ReadVolume> volumes;
  std::string world_settings;  ///< all but the volumes' contents that the world is made from
  std::string photon_settings; ///< and what its photons depend on beyond that
  /// Photons of earlier frames with this world; null where no frame can use those of another.
  std::shared_ptr<PhotonCache> photons;
  double seconds_read = 0, seconds_build = 0;
  std::uint64_t grids_read = 0;

  /// Bytes of the grids that are kept for the moments of the scene.
  std::uint64_t source_bytes() const;
};

/// As the public prepare_scene, but throws Stopped where the token ends it.
PreparedScenePtr prepare_scene(const Scene& scene, const PreparedScenePtr& previous,
                               const StopToken& stop);

/// Seconds that preparing a scene may take: those of its stop rule, if any, and half a second, in
/// which a small scene is ready for a quick look however short its time is.
double preparation_limit(const RenderSettings& settings);
/// Why there is no image where it took longer. `what`: the frame.
FrameError preparation_failure(const std::string& what, const RenderSettings& settings);

/// Bytes for photons that later frames may use: at most an eighth of the memory.
std::uint64_t photon_cache_capacity();

/// Adds what preparing the scene took.
void add_work(RenderStatistics& statistics, const PreparedScene& prepared);

/// Every value that the world of a scene is made from, as text; of moments of a scene that is
/// prepared also by how much its volumes are moved.
std::string moved_world_settings(const Scene& moment, const PreparedScene& prepared);

} // namespace vdbeam
