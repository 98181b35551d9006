#include "choose/pass_renderer.h"

#include <utility>

namespace vdbeam {

FramePasses::FramePasses(const EstimatorType& type, const EstimatorInput& input)
    : input_(input), worlds_(input.world), choices_(choose(input_, estimator_kind(type), worlds_)) {
  if (estimator_kind(type).shoots_photons())
    photons_.emplace(input_, worlds_, planned_world(choices_.peak, worlds_), choices_.photons);
  estimator_ = estimator_kind({choices_.estimator}).make(input_, photons_ ? &*photons_ : nullptr);
}

void FramePasses::render_pass(int pass, PassImage& image, RenderStatistics& statistics) {
  // The pilot belongs to no pass; its counts go with the first.
  if (!std::exchange(pilot_counted_, true)) {
    statistics.pilot_paths += choices_.photons.pilot_paths;
    statistics.importance_rays += choices_.photons.importance_rays;
  }
  try {
    estimator_->render(specify(pass), image, statistics);
  } catch (const Stopped&) {
    image.finished_tiles.clear();
    if (photons_)
      photons_->release();
  }
}

std::unique_ptr<PassRenderer> make_pass_renderer(const EstimatorType& type,
                                                 const EstimatorInput& input) {
  return std::make_unique<FramePasses>(type, input);
}

} // namespace vdbeam
