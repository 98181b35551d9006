#include "batch/frame_texts.h"

#include "text/text.h"

#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace vdbeam::cli {
namespace {

/// " of gather", " of beam and, from pass 8 on, gather": which estimators rendered the passes.
std::string estimators_text(const RenderResult& result) {
  std::string text;
  std::string_view last;
  for (const PassSpec& spec : result.plan.schedule) {
    if (spec.pass >= result.passes.back().pass || spec.estimator == last)
      continue;
    text += last.empty() ? fmt::format(" of {}", spec.estimator)
                         : fmt::format(" and, from pass {} on, {}", spec.pass + 1, spec.estimator);
    last = spec.estimator;
  }
  return text;
}

/// Description of an image for the log, so that a wrong one is noticed.
std::string picture_text(const PictureFacts& facts) {
  if (facts.optical_depth == 0 && facts.opacity == 0 && facts.black == 0 && facts.over_one == 0)
    return {}; // of a part of the passes
  const std::string opacity =
      std::isnan(facts.opacity) ? "" : fmt::format(" opacity {:.2g},", facts.opacity);
  return fmt::format("; optical depth up to {:.2g},{} {:.0f} % black, {:.0f} % above 1",
                     facts.optical_depth, opacity, 100 * facts.black, 100 * facts.over_one);
}

} // namespace

std::string start_text(const Scene& scene) {
  return fmt::format("{}, {}, {}x{}", scene.path, scene.render.estimator.name, scene.image.width,
                     scene.image.height);
}

std::string passes_text(int passes) {
  return count_text(static_cast<std::uint64_t>(passes), "pass");
}

std::string end_text(const RenderResult& result, const std::string& output) {
  if (result.draft > 0)
    return fmt::format("{}: a draft in 1/{} of the pixels each way", output, result.draft);
  const PassRecord& last = result.passes.back();
  std::string text = fmt::format("{}: {}{} in {}", output, passes_text(last.pass),
                                 estimators_text(result), format_duration(last.seconds));
  if (std::isfinite(last.error_estimate))
    text += fmt::format(", estimated error (MRSE) {:.2g}", last.error_estimate);
  if (std::isfinite(last.error_low))
    text += fmt::format(" ({:.2g} to {:.2g})", last.error_low, last.error_high);
  if (std::isfinite(last.bias_margin) && !result.plan.unbiased)
    text += fmt::format(", estimated bias {:+.1f} +- {:.1f} %", 100 * last.bias_estimate,
                        100 * last.bias_margin);
  if (last.has_reference)
    text += fmt::format(", MRSE {:.3g}, bias {:+.2f} %", last.mrse, 100 * last.bias);
  text += ", peak memory " + format_bytes(static_cast<double>(result.statistics.peak_memory));
  return text + picture_text(result.picture);
}

std::string stop_text(const RenderResult& result, const std::string& checkpoint,
                      const std::string& snapshot) {
  if (result.quick_look)
    return "interrupted before the first pass was finished" +
           (snapshot.empty() ? snapshot : fmt::format("; {} is a quick look", snapshot));
  return fmt::format(
      "interrupted after {}; the same command resumes from {}, which opens as the image so far",
      passes_text(result.passes.back().pass), checkpoint);
}

} // namespace vdbeam::cli
