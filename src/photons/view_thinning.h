#pragma once

#include "camera/camera.h"
#include "photonmap/photon.h"
#include "transport/world.h"

namespace vdbeam {

/// With which probability the collisions in each cell are stored (PhotonPassSettings), and how many
/// photons a path leaves.
struct ViewThinning {
  CellTables store_probability;
  float factor = 0; ///< of the importance
  double stored_per_path = 0;
};

/// View importance at each photon: of the volume of its part of the medium that is seen best, where
/// several overlap.
std::vector<float> view_importance_at(const World& world, const CellTables& importance,
                                      const PhotonList& photons);

/// Probabilities in proportion to what the camera sees of each cell (view_importance), such that a
/// path leaves `wanted_per_path` photons, or fewer where most of them would go unseen, if they are
/// multiplied by towards_camera(). `pilot` holds all collisions of a sample of paths, `per_path` on
/// average. Nothing is lost: a photon that is stored with probability q weighs 1 / q.
ViewThinning thin_by_view(const World& world, const Camera& camera, CellTables importance,
                          const PhotonList& pilot, double per_path, double wanted_per_path);

/// The probabilities that belong to this importance and factor.
CellTables store_by_view(CellTables importance, float factor);

} // namespace vdbeam
