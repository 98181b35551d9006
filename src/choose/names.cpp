#include "choose/names.h"

#include <fmt/format.h>

namespace vdbeam {

void add_name(const std::string& name, std::string& list) {
  if ((", " + list + ",").find(", " + name + ",") != std::string::npos)
    return;
  list += (list.empty() ? "" : ", ") + name;
}

std::string light_name(const World& world, std::size_t light) {
  if (world.lights.traits(light).is_emission)
    return "emission of volumes";
  if (const int surface = world.lights[light].surface(); surface >= 0)
    return fmt::format("mesh.{}", surface);
  return fmt::format("light.{}", light);
}

namespace {

/// "75 %" of a pass, "2.5 %" where it is little.
std::string share_of_pass(double work, double pass) {
  const double percent = 100 * work / pass;
  return percent < 10 ? fmt::format("{:.2g} % of a pass", percent)
                      : fmt::format("{:.0f} % of a pass", percent);
}

} // namespace

std::string work_text(const FeatureFacts& facts, const Choices& choices, const PilotWork& work) {
  std::string text;
  if (work.light_paths > 0 && choices.photons.paths > 0)
    text = fmt::format("{} light paths ({})", work.light_paths,
                       share_of_pass(static_cast<double>(work.light_paths),
                                     static_cast<double>(choices.photons.paths)));
  const Camera& camera = facts.input.camera;
  if (work.camera_rays > 0)
    text += fmt::format("{}{} camera rays ({})", text.empty() ? "" : " and ", work.camera_rays,
                        share_of_pass(static_cast<double>(work.camera_rays),
                                      static_cast<double>(camera.width()) * camera.height()));
  return text.empty() ? text : "a pilot of " + text;
}

} // namespace vdbeam
