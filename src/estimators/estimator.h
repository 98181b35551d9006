#pragma once

#include "photons/photon_pass.h"
#include "rays/estimator_input.h"
#include "vdbeam/pass_spec.h"

namespace vdbeam {

/// A method of finding light: renders passes as they are specified. A pass is a pure function of
/// its specification and of what the estimator was made from, whatever the threads.
class Estimator {
public:
  virtual ~Estimator() = default;

  /// Renders a pass into `image`, which is resized; adds to `statistics`. Where the input's `stop`
  /// asked to end meanwhile, only `image.finished_tiles` hold what the pass is to be, or it throws
  /// Stopped.
  virtual void render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) = 0;
};

/// One that gathers photons. `photons` must outlive it.
class PhotonEstimator : public Estimator {
public:
  PhotonEstimator(const EstimatorInput& input, PhotonPass& photons)
      : input_(input), photons_(photons) {}

protected:
  EstimatorInput input_;
  PhotonPass& photons_;
};

} // namespace vdbeam
