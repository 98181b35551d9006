#pragma once

#include <string>
#include <string_view>

namespace vdbeam {

/// A feature of the method, and whether a frame's passes use it.
struct FeatureChoice {
  std::string_view name; ///< "forward peak", ...
  std::string_view key;  ///< key of the scene file that controls it; empty: none
  bool on = false;
  std::string reason; ///< one clause: what it does, or why it is left out
  /// What exactly it leaves out, be it on or off: lights, volumes, paths, rays or the scene. Empty:
  /// nothing.
  std::string scope;
  std::string cost; ///< work or error that a pilot measured or forecast; empty: no pilot did
};

/// Where a number of a plan comes from.
enum class NumberOrigin { scene, standard, measured };

/// Name of an origin in plans and reports: "scene", "default" or "measured".
constexpr std::string_view origin_name(NumberOrigin origin) {
  return origin == NumberOrigin::scene      ? "scene"
         : origin == NumberOrigin::standard ? "default"
                                            : "measured";
}

/// A number by which passes are rendered.
struct PlanNumber {
  std::string_view name; ///< "light paths", ...
  std::string_view key;  ///< key of the scene file that sets it; empty: none
  double first = 0;      ///< in the first pass, or the least
  double last = 0;       ///< in the last pass, or the greatest
  NumberOrigin origin = NumberOrigin::standard;
  std::string reason; ///< one clause: how it was found
};

} // namespace vdbeam
