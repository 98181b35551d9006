#pragma once

#include "photons/photon_plan.h"

namespace vdbeam {

/// Learns from a pilot of plain light paths where flux is of importance for the picture.
///
/// The contribution of a photon is its power times the view importance of its cell over the fluence
/// there, so that dark parts of the picture are worth as much as bright ones (forward-weighted
/// CADIS, Wagner, Blakeman and Peplow 2009). The importance of a cell is what paths brought after
/// they were there, over the flux with which they were. Null if the pilot stores too few photons.
/// Counts the paths that it traces in the plan.
std::shared_ptr<const PathGuide> fit_path_guide(const EstimatorInput& input, PhotonPlan& plan,
                                                const CellTables& view, double mean_collisions);

} // namespace vdbeam
