#pragma once

#include "choose/choose.h"
#include "choose/schedule.h"
#include "estimators/estimator.h"
#include "photons/photon_pass.h"

namespace vdbeam {

/// Renders independent passes of one frame. A pass is a pure function of (scene, seed, frame, pass
/// number), whatever the threads.
class PassRenderer {
public:
  virtual ~PassRenderer() = default;

  /// Renders pass `pass` (from 0) into `image`, which is resized; adds to `statistics`. Where the
  /// input's `stop` asked to end meanwhile, only `image.finished_tiles` hold what the pass is to
  /// be.
  virtual void render_pass(int pass, PassImage& image, RenderStatistics& statistics) = 0;

  /// What pass `pass` (from 0) is.
  virtual PassSpec specify(int pass) const = 0;

  /// What was chosen.
  virtual const Choices& choices() const = 0;
};

/// The passes of a frame under all of its lights:
///   choices = choose(input), spec = schedule(choices, pass), image = estimator(spec).
class FramePasses final : public PassRenderer {
public:
  FramePasses(const EstimatorType& type, const EstimatorInput& input);
  FramePasses(const FramePasses&) = delete;

  void render_pass(int pass, PassImage& image, RenderStatistics& statistics) override;

  PassSpec specify(int pass) const override { return schedule(choices_, input_.settings, pass); }
  const Choices& choices() const override { return choices_; }
  /// Requires an estimator that shoots photons.
  const PhotonPass& photons() const { return *photons_; }

private:
  EstimatorInput input_;
  PassWorlds worlds_;
  Choices choices_;
  std::optional<PhotonPass> photons_;
  std::unique_ptr<Estimator> estimator_;
  bool pilot_counted_ = false;
};

/// The passes of the estimator that a scene names. Throws InputError for one that there is not.
std::unique_ptr<PassRenderer> make_pass_renderer(const EstimatorType& type,
                                                 const EstimatorInput& input);

} // namespace vdbeam
