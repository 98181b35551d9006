#include "scene/default_look.h"

#include "scene/default_emission.h"
#include "text/text.h"

#include <algorithm>

namespace vdbeam {
namespace {

/// A cloud is deep enough to shade its form and thin enough that light comes through its edges.
constexpr DefaultLook cloud{25, 100, 0.98f, 0.5, {-0.75, -0.5, -0.42}, {7.0f, 5.6f, 4.0f}, 0};
/// Smoke is thinner and darker, so that its inner form shows, and lit from the side and a little
/// from behind: its shade is then seen, and its edges glow.
constexpr DefaultLook smoke{12, 45, 0.75f, 0.3, {-0.85, -0.5, 0.25}, {7.0f, 5.6f, 4.0f}, 0};
/// The smoke of a fire is sooty and covers the flames in places, which sets off their core;
/// voxels as coarse as those of drafts would show as blocks in the flames.
constexpr DefaultLook fire{40, 120, 0.5f, 0.3, {-0.75, -0.5, -0.42}, {0.12f, 0.16f, 0.25f}, 100};

bool moves(const std::string& name) {
  const std::string plain = lower_case(name);
  return plain == "velocity" || plain == "vel" || plain == "v" || plain == "vel.x";
}

} // namespace

bool is_simulated(const std::vector<std::vector<GridSummary>>& summaries) {
  return std::any_of(summaries.begin(), summaries.end(), [](const auto& grids) {
    return std::any_of(grids.begin(), grids.end(), [](const GridSummary& grid) {
      return grid.from_mantaflow || is_fire_grid(grid.name) || moves(grid.name);
    });
  });
}

const DefaultLook& default_look(Subject subject) {
  switch (subject) {
  case Subject::smoke:
    return smoke;
  case Subject::fire:
    return fire;
  case Subject::cloud:
    break;
  }
  return cloud;
}

} // namespace vdbeam
