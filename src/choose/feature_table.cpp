#include "choose/feature.h"

#include <array>

namespace vdbeam {

// This list stands alone in its file, so that a program may link another in its place.
std::span<const Feature* const> feature_table() {
  static constexpr std::array table{&view_importance_feature, &path_guide_feature,
                                    &kernel_pilot_feature,    &forward_peak_feature,
                                    &final_gather_feature,    &hidden_lights_feature,
                                    &shadow_lattice_feature,  &boundary_share_feature,
                                    &edges_feature,           &branches_feature};
  return table;
}

} // namespace vdbeam
