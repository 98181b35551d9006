#include "estimators/beam_weights.h"

#include "math/sampling.h"

namespace vdbeam {

namespace {

/// Frame and directions. The reference lies on the central ray, beside the medium's centre.
void fill_frame(const World& world, const Camera& camera, const TileRays& rays, BeamTile& tile) {
  const EyeRay middle = camera.ray(rays.x0() + 0.5 * 16, rays.y0() + 0.5 * 16);
  const Vec3d& w = middle.direction;
  Vec3d u, v;
  orthonormal_frame(w, u, v);
  const double distance = std::max(0.0, dot(Vec3d(world.region.center) - middle.origin, w));
  tile.reference = Vec3f(middle.origin + w * distance);
  tile.axis_u = Vec3f(u);
  tile.axis_v = Vec3f(v);
  tile.axis_w = Vec3f(w);
  tile.camera_distance = distance;
  for (int i = 0; i < TileRays::count; ++i) {
    tile.du[i] = static_cast<float>(dot(rays[i].eye.direction, u));
    tile.dv[i] = static_cast<float>(dot(rays[i].eye.direction, v));
    tile.dw[i] = static_cast<float>(dot(rays[i].eye.direction, w));
  }
  tile.own_origins = camera.has_own_origins();
  for (int i = 0; i < TileRays::count && tile.own_origins; ++i) {
    const Vec3d start = rays[i].eye.origin - middle.origin;
    tile.ou[i] = static_cast<float>(dot(start, u));
    tile.ov[i] = static_cast<float>(dot(start, v));
    tile.ow[i] = static_cast<float>(dot(start, w));
  }
}

/// Where a sub-tile's knots lie: spacing by the lattice crossings of its rays, finer where one
/// piece takes a visible share of the light.
struct KnotRange {
  double begin = infinity, end = -infinity;
  int intervals = 0;
};

KnotRange choose_knots(const TileRays& rays, int subtile) {
  constexpr float finest_piece = 0.5f; // visible optical depth per interval
  constexpr int most_intervals = 1024;
  KnotRange range;
  std::size_t pieces = 0;
  float sharpest = 0, deepest = 0;
  for (int i = 16 * subtile; i < 16 * (subtile + 1); ++i) {
    const DepthProfile& profile = rays[i].profile;
    if (profile.empty())
      continue;
    range.begin = std::min(range.begin, profile.front() + rays[i].camera.shift);
    range.end = std::max(range.end, profile.back() + rays[i].camera.shift);
    pieces = std::max(pieces, profile.knots());
    sharpest = std::max(sharpest, profile.sharpest_piece());
    deepest = std::max(deepest, std::min(profile.total(profile.knots() - 1), 14.0f));
  }
  if (pieces == 0)
    return range;
  // A lattice line is crossed about 1.5 times per voxel.
  double intervals = std::max({16.0, 0.67 * static_cast<double>(pieces), 4.0 * deepest});
  intervals *= std::max(1.0f, std::min(sharpest / finest_piece, 8.0f));
  range.intervals = static_cast<int>(std::min<double>(intervals, most_intervals));
  return range;
}

class WeightWriter {
public:
  WeightWriter(const World& world, const WeightSettings& settings, BeamTile& tile)
      : world_(world), settings_(settings), tile_(tile),
        groups_(static_cast<int>(world.medium.phases.size())) {}

  void write(const TileRays& rays, int subtile, const KnotRange& range) {
    BeamTile::Profile& profile = tile_.profiles[subtile];
    profile = {};
    if (range.intervals == 0)
      return;
    profile.step = static_cast<float>((range.end - range.begin) / range.intervals);
    if (settings_.store == PhotonStore::fluence) {
      profile.knots = range.intervals + 1;
      profile.t_begin = range.begin;
    } else {
      // A knot in the middle of each interval, and one of weight 0 before and after.
      profile.knots = range.intervals + 2;
      profile.t_begin = range.begin - 0.5 * static_cast<double>(profile.step);
    }
    profile.offset = tile_.weights.size();
    tile_.weights.resize(profile.offset + static_cast<std::size_t>(profile.knots) * 16 * groups_ *
                                              tile_.weight_channels);
    for (int ray = 0; ray < 16; ++ray) {
      const TileRays::PixelRay& pixel = rays[16 * subtile + ray];
      if (!pixel.profile.empty())
        write_ray(pixel, range, profile, ray);
    }
  }

private:
  void write_ray(const TileRays::PixelRay& pixel, const KnotRange& range,
                 const BeamTile::Profile& profile, int ray) {
    const float begin = static_cast<float>(range.begin - pixel.camera.shift);
    const std::size_t volumes = world_.medium.volumes.size();
    ProfileCursor cursor(pixel.profile);
    before_.assign(volumes, 0);
    after_.assign(volumes, 0);
    for (int i = 0; i < range.intervals; ++i) {
      cursor.move_to(begin + static_cast<float>(i + 1) * profile.step);
      for (std::size_t v = 0; v < volumes; ++v)
        after_[v] = cursor.tau(v);
      if (settings_.store == PhotonStore::scatter)
        write_transmittance(profile, i + 1, ray);
      else if (volumes == 1 && tile_.weight_channels == 1)
        write_simple(profile, i, ray);
      else
        write_scattering(profile, i, ray);
      std::swap(before_, after_);
    }
  }

  float* weight(const BeamTile::Profile& profile, int group, int channel, int knot, int ray) {
    const std::size_t table = static_cast<std::size_t>(group) * tile_.weight_channels + channel;
    return &tile_.weights[profile.offset + (table * profile.knots + knot) * 16 + ray];
  }

  /// Gives half of an interval's mean weight to the knot at either end. The knots at the ends of
  /// the table, which weigh over half an interval, get all of theirs: photons lie right up to the
  /// medium's border, so a ramp there would lose light.
  void deposit(const BeamTile::Profile& profile, int group, int channel, int interval, int ray,
               float mean) {
    float* knot = weight(profile, group, channel, interval, ray);
    knot[0] += interval == 0 ? mean : 0.5f * mean;
    knot[16] += interval + 2 == profile.knots ? mean : 0.5f * mean;
  }

  void write_simple(const BeamTile::Profile& profile, int interval, int ray) {
    const float piece = after_[0] - before_[0];
    if (piece > 0)
      deposit(profile, 0, 0, interval, ray,
              std::exp(-before_[0]) * -std::expm1(-piece) / profile.step);
  }

  void write_scattering(const BeamTile::Profile& profile, int interval, int ray) {
    const std::vector<Volume>& volumes = world_.medium.volumes;
    for (int c = 0; c < tile_.weight_channels; ++c) {
      float tau_before = 0, tau_after = 0;
      for (std::size_t v = 0; v < volumes.size(); ++v) {
        tau_before += volumes[v].channel_scale[c] * before_[v];
        tau_after += volumes[v].channel_scale[c] * after_[v];
      }
      const float piece = tau_after - tau_before;
      if (!(piece > 0))
        continue;
      const float scattered = std::exp(-tau_before) * -std::expm1(-piece) / profile.step;
      for (std::size_t v = 0; v < volumes.size(); ++v) {
        const float share = volumes[v].channel_scale[c] * (after_[v] - before_[v]) / piece;
        const float albedo = settings_.albedo_in_power ? 1 : volumes[v].albedo[c];
        deposit(profile, volumes[v].phase_index, c, interval, ray, scattered * share * albedo);
      }
    }
  }

  /// Scatter storage: the photon brings the scattered flux, the ray its transmittance; several
  /// phase functions share by their volumes' part in the interval.
  void write_transmittance(const BeamTile::Profile& profile, int knot, int ray) {
    const std::vector<Volume>& volumes = world_.medium.volumes;
    for (int c = 0; c < tile_.weight_channels; ++c) {
      float tau = 0, piece = 0;
      for (std::size_t v = 0; v < volumes.size(); ++v) {
        tau += volumes[v].channel_scale[c] * 0.5f * (before_[v] + after_[v]);
        piece += volumes[v].albedo[c] * volumes[v].channel_scale[c] * (after_[v] - before_[v]);
      }
      const float tr = std::exp(-tau);
      if (!(piece > 0)) {
        *weight(profile, volumes[0].phase_index, c, knot, ray) += tr;
        continue;
      }
      for (std::size_t v = 0; v < volumes.size(); ++v)
        *weight(profile, volumes[v].phase_index, c, knot, ray) += tr * volumes[v].albedo[c] *
                                                                  volumes[v].channel_scale[c] *
                                                                  (after_[v] - before_[v]) / piece;
    }
  }

  const World& world_;
  const WeightSettings& settings_;
  BeamTile& tile_;
  int groups_;
  std::vector<float> before_, after_;
};

} // namespace

void fill_beam_tile(const World& world, const Camera& camera, const TileRays& rays,
                    const WeightSettings& settings, BeamTile& tile) {
  fill_frame(world, camera, rays, tile);
  tile.phases = &world.medium.gathered_phases();
  const bool coloured = world.medium.chromatic || (!settings.albedo_in_power && settings.colored);
  tile.weight_channels = coloured ? 3 : 1;
  tile.weights.clear();
  WeightWriter writer(world, settings, tile);
  for (int subtile = 0; subtile < BeamTile::subtile_count; ++subtile) {
    KnotRange range = choose_knots(rays, subtile);
    if (range.intervals > 0 && settings.store == PhotonStore::scatter) {
      const double width = (range.end - range.begin) / range.intervals;
      const double begin = std::max(0.0, range.begin - settings.reach);
      const double end = range.end + settings.reach;
      range.intervals = static_cast<int>(std::min(2048.0, std::ceil((end - begin) / width)));
      range.begin = begin;
      range.end = end;
    }
    writer.write(rays, subtile, range);
  }
}

} // namespace vdbeam
