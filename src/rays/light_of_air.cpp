#include "rays/light_of_air.h"

#include "layers/ray_sink.h"

namespace vdbeam {
namespace {

/// Pieces of a ray over which the light of the air hardly changes, so that it is asked for once.
constexpr float pieces_of_ray = 48;

/// What a stretch of the ray hides of the light behind it, by volumes of the profile.
class Stretch {
public:
  Stretch(const Medium& medium, const DepthProfile& profile)
      : medium_(medium), profile_(profile), hidden_(profile.volume_count()) {}

  /// Adds the piece that ends at a knot.
  void add(std::size_t knot) {
    const Rgb before = profile_.channels(medium_, knot - 1),
              after = profile_.channels(medium_, knot);
    Rgb per_depth; // of the strongest channel
    for (int c = 0; c < 3; ++c)
      if (const float depth = after[c] - before[c]; depth > 0)
        per_depth[c] = std::exp(-before[c]) * opacity_of(depth) / depth;
    float added = 0;
    for (std::size_t v = 0; v < hidden_.size(); ++v) {
      const Rgb share = per_depth * medium_.volumes[profile_.volume(v)].channel_scale *
                        (profile_.tau(knot, v) - profile_.tau(knot - 1, v));
      hidden_[v] += share;
      added += mean_component(share);
    }
    distance_ += added * 0.5f * (profile_.t(knot - 1) + profile_.t(knot));
    total_ += added;
  }

  /// The light of the air before the stretch; the next one begins.
  Rgb finish(const RaySink& sink) {
    Rgb sum;
    if (total_ > 0) {
      const float t = distance_ / total_;
      const Rgb light = profile_.air().at(t).light;
      for (std::size_t v = 0; v < hidden_.size(); ++v) {
        sink.add(t, medium_.volumes[profile_.volume(v)].setting, light * hidden_[v]);
        sum += light * hidden_[v];
      }
    }
    std::fill(hidden_.begin(), hidden_.end(), Rgb());
    distance_ = total_ = 0;
    return sum;
  }

private:
  const Medium& medium_;
  const DepthProfile& profile_;
  std::vector<Rgb> hidden_;
  float distance_ = 0, total_ = 0;
};

} // namespace

void add_light_of_air(const EstimatorInput& input, const CameraRay& camera,
                      const DepthProfile& profile, std::size_t pixel, PassImage& image) {
  if (!profile.air() || profile.empty())
    return;
  const World& world = input.world;
  const RaySink sink(world, camera, input.layers, pixel, image);
  const float longest =
      sink.sorts_by_depth() ? 0 : (profile.back() - profile.front()) / pieces_of_ray;
  Stretch stretch(world.medium, profile);
  Rgb sum;
  float begin = profile.front();
  for (std::size_t knot = 1; knot < profile.knots(); ++knot) {
    stretch.add(knot);
    if (profile.t(knot) - begin < longest && knot + 1 < profile.knots())
      continue;
    sum += stretch.finish(sink);
    begin = profile.t(knot);
  }
  sink.add_sum(&PassImage::direct, {sum, world.lights.group(world.air_light)});
}

} // namespace vdbeam
