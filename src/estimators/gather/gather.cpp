#include "estimators/gather/gather.h"

#include "estimators/beam/beam_ray.h"
#include "estimators/estimator_table.h"
#include "estimators/gather/gather_pass.h"
#include "photons/blur_probe.h"

namespace vdbeam {

void GatherEstimator::render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) {
  photons_.trace_and_build(spec, KernelDomain::ball, statistics);
  BlurProbe blur(input_, photons_);
  GatherPass walks(input_, photons_, spec);
  const auto gather = [&](TileScratch& scratch, const RngKey& key) {
    walks.gather(scratch, key, blur, image);
  };
  // No fit over pixels evens out what rays see behind a mirror or glass: there photons, gathered
  // along the ray, have far less noise than a few walks.
  const WeightSettings weights = weight_settings(photons_, input_.settings.store);
  const auto gather_along = [&](const CameraRay& ray, const DepthProfile& profile, Rng&) {
    return beam_radiance(photons_, photons_.map(), weights, ray, profile);
  };
  shade_tiles(walks.input(), photons_, spec, {true, gather, gather_along, &blur}, image,
              statistics);
  walks.fit(blur, image);
  image.blur = blur.take();
  image.truncation = truncation(photons_.world().medium);
  photons_.release();
}

namespace {

constexpr std::string_view gather_keys[] = {
    "photons",    "store",      "direct", "kernel",   "kernel_shape", "radius",      "neighbours",
    "min_radius", "max_radius", "alpha",  "thinning", "bias_rays",    "forward_peak"};

} // namespace

const EstimatorKind gather_estimator{
    .name = "gather",
    .help =
        "final gathering: photons, gathered at the end of short random walks from the camera ray",
    .unbiased = false,
    .stages = gather_stages,
    .keys = gather_keys,
    .make = [](const EstimatorInput& input, PhotonPass* photons) -> std::unique_ptr<Estimator> {
      return std::make_unique<GatherEstimator>(input, *photons);
    }};

} // namespace vdbeam
