#include "estimators/march/march.h"

#include "estimators/estimator_table.h"
#include "layers/ray_sink.h"
#include "shading/tile_shading.h"

namespace vdbeam {

namespace {

/// Marches one ray. Within a step the gather point is jittered and weighs what the step scatters,
/// Tr(a) - Tr(b), exactly; with scatter storage Tr times the step's length.
class RayMarcher {
public:
  RayMarcher(const RenderSettings& settings, const PhotonPass& photons)
      : world_(photons.world()), photons_(photons),
        scatter_photons_(settings.store == PhotonStore::scatter) {
    float voxel = infinity;
    for (const Volume& volume : world_.medium.volumes)
      voxel = std::min(voxel, volume.voxel_size);
    step_ = static_cast<float>(settings.step) * voxel;
    reach_ = scatter_photons_ ? 4 * photons.map().mean_radius() : 0;
  }

  /// Light that the photons scatter into the ray, and in `straight` the part that comes straight
  /// from lights.
  GroupedLight march(const CameraRay& camera, const DepthProfile& profile, Rng& rng,
                     RenderStatistics& counts, Rgb& straight, const RaySink& sink = {}) {
    const Medium& medium = world_.medium;
    const float begin = std::max(static_cast<float>(-camera.shift), profile.front() - reach_);
    const float end = std::min(profile.back() + reach_, camera.whole().t_end);
    const int steps = std::max(1, static_cast<int>(std::ceil((end - begin) / step_)));
    const float step = (end - begin) / static_cast<float>(steps);
    ProfileCursor cursor(profile);
    profile_ = &profile;
    std::vector<float> before(profile.volume_count()), after(profile.volume_count());
    gathered_.resize(medium.parts.count * medium.phases.size());
    straight_.resize(gathered_.size());
    straight = {};
    groups_.clear();
    GroupedLight sum;
    for (int i = 0; i < steps; ++i) {
      const float t = begin + step * (static_cast<float>(i) + rng.uniform());
      cursor.move_to(begin + step * static_cast<float>(i + 1));
      for (std::size_t v = 0; v < after.size(); ++v)
        after[v] = cursor.tau(v);
      if (reach_ > 0 || before != after) {
        std::fill(gathered_.begin(), gathered_.end(), Rgb());
        counts.contributions += query(camera.ray().at(t), camera.ray().direction);
        ++counts.lookups;
        find_shares(before, after, camera.ray().at(t));
        air_ = profile.air().left(t);
        const Rgb light = weigh(before, after, step, gathered_.data(), sink);
        std::vector<Rgb> parts;
        for (std::size_t g = 0; g < groups_.size(); g += gathered_.size())
          parts.push_back(weigh(before, after, step, groups_.data() + g));
        sum += {light, parts};
        sink.add_at(t, light);
        if (photons_.map().has_first_flights())
          straight += weigh(before, after, step, straight_.data());
      }
      before = after;
    }
    return sum;
  }

private:
  /// Volume v of the profile at hand.
  const Volume& volume(std::size_t v) const { return world_.medium.volumes[profile_->volume(v)]; }
  std::size_t part(std::size_t v) const { return world_.medium.parts[profile_->volume(v)]; }
  std::size_t group(std::size_t v) const {
    return part(v) * world_.medium.phases.size() + static_cast<std::size_t>(volume(v).phase_index);
  }

  /// Fills what is gathered by [part][phase function], and by [group] before that. Returns the
  /// number of contributions.
  std::uint64_t query(const Vec3f& point, const Vec3f& direction) {
    const std::vector<PhaseFunction>& phases = world_.medium.gathered_phases();
    const PhotonMap& map = photons_.map();
    const auto groups = static_cast<std::size_t>(map.groups());
    groups_.assign(groups * gathered_.size(), {});
    std::vector<Rgb> of_part;
    QueryCounts counts;
    for (std::size_t part = 0; part < world_.medium.parts.count; ++part) {
      const std::size_t first = part * phases.size();
      counts += map.query_point(point, direction, part, phases, gathered_.data() + first,
                                straight_.data() + first, groups > 0 ? &of_part : nullptr);
      for (std::size_t g = 0; g < groups; ++g)
        std::copy_n(of_part.begin() + static_cast<std::ptrdiff_t>(g * phases.size()), phases.size(),
                    groups_.begin() + static_cast<std::ptrdiff_t>(g * gathered_.size() + first));
    }
    return counts.contributions;
  }

  /// Fills the volumes' shares of the light that photons scatter within a step: of sigma_t, times
  /// the albedo where photons do not contain it. Scatter storage: of the sigma_s of all volumes of
  /// the same part of the medium, since its photons bring what has been scattered by any of them.
  void find_shares(const std::vector<float>& before, const std::vector<float>& after,
                   const Vec3f& point) {
    const std::size_t volumes = profile_->volume_count();
    const bool albedo_counts = scatter_photons_ || !photons_.plan().albedo_in_power;
    Rgb piece;
    part_sums_.assign(world_.medium.parts.count, {});
    shares_.clear();
    for (std::size_t v = 0; v < volumes; ++v) {
      const Rgb depth = volume(v).channel_scale * (after[v] - before[v]);
      shares_.push_back(albedo_counts ? depth * volume(v).albedo_at(point) : depth);
      piece += depth;
      part_sums_[part(v)].scattered += shares_[v];
      part_sums_[part(v)].volumes += 1;
    }
    for (std::size_t v = 0; v < volumes; ++v)
      for (int c = 0; c < 3; ++c) {
        const PartSum& sum = part_sums_[part(v)];
        const float whole = scatter_photons_ ? sum.scattered[c] : piece[c];
        // Beside the medium, where kernels reach beyond it, all volumes count the same.
        shares_[v][c] = whole > 0 ? shares_[v][c] / whole : 1 / sum.volumes;
      }
  }

  Rgb weigh(const std::vector<float>& before, const std::vector<float>& after, float step,
            const Rgb* gathered, const RaySink& sink = {}) const {
    const std::size_t volumes = profile_->volume_count();
    Rgb tau, piece;
    for (std::size_t v = 0; v < volumes; ++v) {
      tau += volume(v).channel_scale * before[v];
      piece += volume(v).channel_scale * (after[v] - before[v]);
    }
    Rgb sum;
    for (int c = 0; c < 3; ++c) {
      const float tr = air_[c] * std::exp(-tau[c]);
      const float whole =
          scatter_photons_ ? std::exp(-0.5f * piece[c]) * tr * step : tr * opacity_of(piece[c]);
      for (std::size_t v = 0; v < volumes; ++v) {
        const float light = whole * shares_[v][c] * gathered[group(v)][c];
        sum[c] += light;
        if (sink.sorts_by_volume()) {
          Rgb of_channel;
          of_channel[c] = light;
          sink.add_of_volume(volume(v).setting, of_channel);
        }
      }
    }
    return sum;
  }

  const World& world_;
  const PhotonPass& photons_;
  const DepthProfile* profile_ = nullptr; ///< of the ray at hand
  bool scatter_photons_;
  float step_ = 0, reach_ = 0;
  Rgb air_{1, 1, 1}; ///< what the air lets through of light from the step
  /// Over the volumes of a part, within the step.
  struct PartSum {
    Rgb scattered;
    float volumes = 0;
  };
  std::vector<PartSum> part_sums_;
  std::vector<Rgb> shares_;   ///< per volume of the profile, of the step (find_shares)
  std::vector<Rgb> gathered_; ///< per phase function
  std::vector<Rgb> straight_; ///< what of it comes straight from lights
  std::vector<Rgb> groups_;   ///< what of it each group of lights has: [group][phase function]
};

} // namespace

void MarchEstimator::render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) {
  photons_.trace_and_build(spec, KernelDomain::ball, statistics);
  const auto gather = [&](TileScratch& scratch, const RngKey& key) {
    RayMarcher marcher(input_.settings, photons_);
    for (int i = 0; i < TileRays::count && !input_.stopped(); ++i) {
      const TileRays::PixelRay& ray = scratch.rays[i];
      if (!ray.inside || ray.profile.empty())
        continue;
      Rng rng(key, RngStage::march, ray.pixel);
      Rgb straight;
      const RaySink sink(photons_.world(), ray.camera, input_.layers, ray.pixel, image);
      sink.add_sum(&PassImage::indirect,
                   marcher.march(ray.camera, ray.profile, rng, scratch.statistics, straight, sink));
      image.move_to_direct(ray.pixel, straight);
    }
  };
  const auto gather_along = [&](const CameraRay& ray, const DepthProfile& profile, Rng& rng) {
    RenderStatistics counts;
    Rgb straight;
    return RayMarcher(input_.settings, photons_).march(ray, profile, rng, counts, straight);
  };
  shade_tiles(input_, photons_, spec, {false, gather, gather_along}, image, statistics);
  image.truncation = truncation(photons_.world().medium);
  photons_.release();
}

namespace {

constexpr std::string_view march_keys[] = {
    "photons",    "store",      "direct", "kernel",    "kernel_shape", "radius", "neighbours",
    "min_radius", "max_radius", "alpha",  "bias_rays", "forward_peak", "step"};

} // namespace

const EstimatorKind march_estimator{
    .name = "march",
    .help = "conventional photon mapping: photons, gathered step by step along the camera ray",
    .unbiased = false,
    .stages = {Stage::surfaces, Stage::photons, Stage::surface_photons, Stage::map,
               Stage::neighbours, Stage::photon_directions, Stage::photon_color,
               Stage::depth_profiles, Stage::emission, Stage::shadow_rays, Stage::spectral_tracking,
               Stage::march, Stage::bias},
    .keys = march_keys,
    .make = [](const EstimatorInput& input, PhotonPass* photons) -> std::unique_ptr<Estimator> {
      return std::make_unique<MarchEstimator>(input, *photons);
    }};

} // namespace vdbeam
