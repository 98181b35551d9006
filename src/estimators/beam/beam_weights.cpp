#include "estimators/beam/beam_weights.h"

#include "math/sampling.h"

#include <optional>

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
    const auto at = static_cast<std::size_t>(i);
    tile.end[at] = rays[i].camera.hit ? rays[i].camera.hit->t : static_cast<double>(infinity);
    tile.shift[at] = static_cast<double>(rays[i].camera.shift);
  }
  tile.own_origins = camera.has_own_origins();
  for (int i = 0; i < TileRays::count && tile.own_origins; ++i) {
    const Vec3d start = rays[i].eye.origin - middle.origin;
    tile.ou[i] = static_cast<float>(dot(start, u));
    tile.ov[i] = static_cast<float>(dot(start, v));
    tile.ow[i] = static_cast<float>(dot(start, w));
  }
}

/// Lets the rays of a wide lens start where they are as far from the reference as the others, so
/// that the knots, which rays of a sub-tile share, are no farther apart than they need be.
void align_starts(BeamTile& tile, int subtile) {
  const auto in_frame = [](const float* u, const float* v, const float* w, int i) {
    return Vec3d{u[i], v[i], w[i]};
  };
  for (int i = 16 * subtile; i < 16 * (subtile + 1); ++i) {
    const Vec3d d = in_frame(tile.du, tile.dv, tile.dw, i);
    const Vec3d start = in_frame(tile.ou, tile.ov, tile.ow, i);
    const double slide = dot(Vec3d{0, 0, tile.camera_distance} - start, d) - tile.camera_distance;
    const Vec3d moved = start + d * slide;
    tile.ou[i] = static_cast<float>(moved.x);
    tile.ov[i] = static_cast<float>(moved.y);
    tile.ow[i] = static_cast<float>(moved.z);
    tile.end[static_cast<std::size_t>(i)] -= slide;
    tile.shift[static_cast<std::size_t>(i)] -= slide;
  }
}

/// Where the knots of a few rays lie: spacing by the lattice crossings of the rays, finer where one
/// piece takes a visible share of the light.
class KnotRange {
public:
  double begin = infinity, end = -infinity;
  int intervals = 0;

  /// The piece of a ray in which it crosses a part of the medium.
  void add(const Medium& medium, std::size_t part, const DepthProfile& profile, double shift) {
    if (profile.empty())
      return;
    std::size_t first = 0, last = profile.knots() - 1;
    if (!medium.parts.single()) {
      const auto crosses = [&](std::size_t piece) {
        for (std::size_t v = 0; v < profile.volume_count(); ++v)
          if (medium.parts[profile.volume(v)] == part &&
              profile.tau(piece + 1, v) > profile.tau(piece, v))
            return true;
        return false;
      };
      while (first < last && !crosses(first))
        ++first;
      while (last > first && !crosses(last - 1))
        --last;
      if (first == last)
        return;
    }
    begin = std::min(begin, profile.t(first) + shift);
    end = std::max(end, profile.t(last) + shift);
    pieces_ = std::max(pieces_, last - first + 1);
    sharpest_ = std::max(sharpest_, profile.sharpest_piece());
    deepest_ = std::max(deepest_, std::min(profile.total(profile.knots() - 1), 14.0f));
  }

  /// Requires a profile that is not empty.
  void choose(const WeightSettings& settings) {
    constexpr float finest_piece = 0.5f; // visible optical depth per interval
    constexpr int most_intervals = 1024;
    // A lattice plane is crossed about 1.5 times per voxel, so that pieces / 1.5 intervals are as
    // long as voxels. Weights are smoothed over two intervals, which loses what light and density
    // have in common there: much where a grid has few voxels, so that short rays get more.
    constexpr double cheap_intervals = 128;
    const auto pieces = static_cast<double>(pieces_);
    double count = std::max({16.0, pieces / 1.5, std::min(4 * pieces, cheap_intervals),
                             4.0 * static_cast<double>(deepest_)});
    count *= std::max(1.0f, std::min(sharpest_ / finest_piece, 8.0f));
    intervals = static_cast<int>(std::min<double>(count, most_intervals));
    if (settings.store == PhotonStore::fluence)
      return;
    const double width = (end - begin) / intervals;
    begin = std::max(0.0, begin - settings.reach);
    end += settings.reach;
    intervals = static_cast<int>(std::min(2048.0, std::ceil((end - begin) / width)));
  }

  bool empty() const { return pieces_ == 0; }

private:
  std::size_t pieces_ = 0;
  float sharpest_ = 0, deepest_ = 0;
};

/// A table of weights [(group * channels + c)][knot][ray].
struct WeightTable {
  double t_begin = 0;
  float step = 1;
  int knots = 0, rays = 1;
  float* weights = nullptr;
};

int count_channels(const World& world, const WeightSettings& settings) {
  const bool coloured = world.air || world.medium.chromatic || world.medium.colored() ||
                        (!settings.albedo_in_power && settings.colored);
  return coloured ? 3 : 1;
}

class WeightWriter {
public:
  /// `part`: of the medium, whose photons are weighed.
  WeightWriter(const World& world, std::size_t part, const WeightSettings& settings)
      : world_(world), part_(part), settings_(settings), channels_(count_channels(world, settings)),
        colored_(world.medium.colored()) {}

  int channels() const { return channels_; }

  /// A table for `rays` rays, all 0, at the end of `weights`.
  WeightTable make_table(const KnotRange& range, int rays, std::vector<float>& weights) const {
    WeightTable table;
    table.rays = rays;
    table.step = static_cast<float>((range.end - range.begin) / range.intervals);
    if (settings_.store == PhotonStore::fluence) {
      table.knots = range.intervals + 1;
      table.t_begin = range.begin;
    } else {
      // A knot in the middle of each interval, and one of weight 0 before and after.
      table.knots = range.intervals + 2;
      table.t_begin = range.begin - 0.5 * static_cast<double>(table.step);
    }
    const std::size_t offset = weights.size(),
                      tables = world_.medium.phases.size() * static_cast<std::size_t>(channels_);
    weights.resize(offset + tables * static_cast<std::size_t>(table.knots * rays));
    table.weights = weights.data() + offset;
    return table;
  }

  /// `shift`: what the table's distances have more than the profile's.
  void write_ray(const CameraRay& camera, const DepthProfile& profile, double shift,
                 const KnotRange& range, const WeightTable& table, int ray) {
    const float begin = static_cast<float>(range.begin - shift);
    const float end = camera.hit ? camera.segment.t_end : infinity;
    const std::size_t volumes = profile.volume_count();
    ProfileCursor cursor(profile);
    profile_ = &profile;
    air_ = Rgb(1);
    before_.assign(volumes, 0);
    after_.assign(volumes, 0);
    cursor.move_to(begin);
    for (std::size_t v = 0; v < volumes; ++v)
      before_[v] = cursor.tau(v);
    albedos_.clear();
    for (std::size_t v = 0; v < volumes; ++v)
      albedos_.push_back(volume(v).albedo);
    for (int i = 0; i < range.intervals; ++i) {
      const float from = begin + static_cast<float>(i) * table.step;
      cursor.move_to(begin + static_cast<float>(i + 1) * table.step);
      for (std::size_t v = 0; v < volumes; ++v)
        after_[v] = cursor.tau(v);
      // Where the ray ends within, the interval does too.
      last_ = i + 1 == range.intervals || (end > from && end - from < table.step);
      length_ = last_ ? std::min(table.step, std::max(end - from, 1e-3f * table.step)) : table.step;
      if (profile.air())
        air_ = profile.air().left(from + 0.5f * length_);
      if (colored_)
        find_albedos(camera.ray().at(from + 0.5f * length_));
      if (settings_.store == PhotonStore::scatter)
        write_transmittance(table, i + 1, ray);
      else if (world_.medium.volumes.size() == 1 && channels_ == 1)
        write_simple(table, i, ray);
      else
        write_scattering(table, i, ray);
      std::swap(before_, after_);
    }
  }

private:
  /// A weight of the group to which volume v of the profile belongs.
  float* weight(const WeightTable& table, std::size_t v, int channel, int knot, int ray) {
    const int of_group = volume(v).phase_index * channels_ + channel;
    const auto row = static_cast<std::size_t>(of_group);
    const std::size_t at =
        row * static_cast<std::size_t>(table.knots) + static_cast<std::size_t>(knot);
    return table.weights + at * static_cast<std::size_t>(table.rays) + ray;
  }

  /// Albedos of the volumes that contribute to the ray in this interval.
  void find_albedos(const Vec3f& point) {
    for (std::size_t v = 0; v < albedos_.size(); ++v)
      if (after_[v] > before_[v])
        albedos_[v] = volume(v).albedo_at(point);
  }

  /// Volume v of the profile at hand.
  const Volume& volume(std::size_t v) const { return world_.medium.volumes[profile_->volume(v)]; }
  bool counts(std::size_t v) const {
    const std::size_t number = profile_->volume(v);
    return world_.medium.parts[number] == part_ && (!settings_.only || (*settings_.only)[number]);
  }

  /// Gives half of an interval's mean weight to the knot at either end. The knots at the ends of
  /// the table, or of the ray, which weigh over half an interval, get all of theirs: photons lie
  /// right up to the medium's border, so a ramp there would lose light.
  void deposit(const WeightTable& table, std::size_t v, int channel, int interval, int ray,
               float mean) {
    float* knot = weight(table, v, channel, interval, ray);
    knot[0] += interval == 0 ? mean : 0.5f * mean;
    knot[table.rays] += last_ ? mean : 0.5f * mean;
  }

  void write_simple(const WeightTable& table, int interval, int ray) {
    const float piece = after_[0] - before_[0];
    if (piece > 0 && counts(0))
      deposit(table, 0, 0, interval, ray, std::exp(-before_[0]) * opacity_of(piece) / length_);
  }

  void write_scattering(const WeightTable& table, int interval, int ray) {
    const std::size_t volumes = profile_->volume_count();
    for (int c = 0; c < channels_; ++c) {
      float tau_before = 0, tau_after = 0;
      for (std::size_t v = 0; v < volumes; ++v) {
        tau_before += volume(v).channel_scale[c] * before_[v];
        tau_after += volume(v).channel_scale[c] * after_[v];
      }
      const float piece = tau_after - tau_before;
      if (!(piece > 0))
        continue;
      const float scattered = air_[c] * std::exp(-tau_before) * opacity_of(piece) / length_;
      for (std::size_t v = 0; v < volumes; ++v) {
        if (!counts(v))
          continue;
        const float share = volume(v).channel_scale[c] * (after_[v] - before_[v]) / piece;
        const float albedo = settings_.albedo_in_power ? 1 : albedos_[v][c];
        deposit(table, v, c, interval, ray, scattered * share * albedo);
      }
    }
  }

  /// Scatter storage: the photon brings the scattered flux, the ray its transmittance; several
  /// phase functions share by their volumes' part in the interval. Photons beside the medium count
  /// as if they were in its first volume.
  void write_transmittance(const WeightTable& table, int knot, int ray) {
    const std::size_t volumes = profile_->volume_count();
    for (int c = 0; c < channels_; ++c) {
      float tau = 0, piece = 0;
      std::optional<std::size_t> first;
      for (std::size_t v = 0; v < volumes; ++v) {
        tau += volume(v).channel_scale[c] * 0.5f * (before_[v] + after_[v]);
        if (world_.medium.parts[profile_->volume(v)] != part_)
          continue;
        first = first.value_or(v);
        piece += albedos_[v][c] * volume(v).channel_scale[c] * (after_[v] - before_[v]);
      }
      const float tr = air_[c] * std::exp(-tau);
      for (std::size_t v = 0; v < volumes; ++v)
        if (counts(v) && (piece > 0 || v == first))
          *weight(table, v, c, knot, ray) += piece > 0 ? tr * albedos_[v][c] *
                                                             volume(v).channel_scale[c] *
                                                             (after_[v] - before_[v]) / piece
                                                       : tr;
    }
  }

  const World& world_;
  std::size_t part_;
  const WeightSettings& settings_;
  const DepthProfile* profile_ = nullptr; ///< of the ray at hand
  int channels_;
  bool colored_;                      ///< albedos change along the ray
  std::vector<float> before_, after_; ///< optical depths at the ends of the interval at hand
  std::vector<Rgb> albedos_;          ///< of the volumes, in its middle
  Rgb air_{1, 1, 1};                  ///< what the air lets through of light from there
  bool last_ = false;                 ///< it is the ray's last
  float length_ = 1;
};

/// The tables of one part of the medium, for each sub-tile.
void fill_part(const World& world, std::size_t part, const TileRays& rays,
               const WeightSettings& settings, BeamTile& tile) {
  WeightWriter writer(world, part, settings);
  for (int subtile = 0; subtile < BeamTile::subtile_count; ++subtile) {
    const auto shift = [&](int i) { return tile.shift[static_cast<std::size_t>(i)]; };
    BeamTile::Profile& profile = tile.profiles[static_cast<std::size_t>(subtile)];
    profile = {};
    KnotRange range;
    for (int i = 16 * subtile; i < 16 * (subtile + 1); ++i)
      range.add(world.medium, part, rays[i].profile, shift(i));
    if (range.empty())
      continue;
    range.choose(settings);
    profile.offset = tile.weights.size();
    const WeightTable table = writer.make_table(range, 16, tile.weights);
    profile.t_begin = table.t_begin;
    profile.step = table.step;
    profile.knots = table.knots;
    for (int ray = 0; ray < 16; ++ray) {
      const int i = 16 * subtile + ray;
      if (!rays[i].profile.empty())
        writer.write_ray(rays[i].camera, rays[i].profile, shift(i), range, table, ray);
    }
  }
}

} // namespace

void fill_beam_tile(const World& world, const Camera& camera, const TileRays& rays,
                    const WeightSettings& settings, BeamTile& tile) {
  fill_frame(world, camera, rays, tile);
  tile.phases = &world.medium.gathered_phases();
  tile.weight_channels = count_channels(world, settings);
  tile.weights.clear();
  tile.parts.clear();
  for (int subtile = 0; subtile < BeamTile::subtile_count && tile.own_origins; ++subtile)
    if (!lie_in_cone(tile, subtile))
      align_starts(tile, subtile);
  for (std::size_t part = 0; part < world.medium.parts.count; ++part) {
    fill_part(world, part, rays, settings, tile);
    if (!world.medium.parts.single())
      tile.parts.push_back(tile.profiles);
  }
}

std::vector<PhotonMap::RayProfile> ray_weights(const World& world, const CameraRay& camera,
                                               const DepthProfile& profile,
                                               const WeightSettings& settings,
                                               std::vector<float>& weights) {
  weights.clear();
  std::vector<PhotonMap::RayProfile> result(world.medium.parts.count);
  std::vector<std::size_t> first;
  for (std::size_t part = 0; part < result.size(); ++part) {
    PhotonMap::RayProfile& of_part = result[part];
    KnotRange range;
    range.add(world.medium, part, profile, camera.shift);
    first.push_back(weights.size());
    if (range.empty())
      continue;
    range.choose(settings);
    WeightWriter writer(world, part, settings);
    const WeightTable table = writer.make_table(range, 1, weights);
    writer.write_ray(camera, profile, camera.shift, range, table, 0);
    of_part.ray = camera.ray();
    of_part.t_begin = static_cast<float>(table.t_begin - camera.shift);
    of_part.step = table.step;
    of_part.knots = table.knots;
    of_part.t_end = camera.hit ? camera.segment.t_end : infinity;
    of_part.weight_channels = writer.channels();
    of_part.phases = &world.medium.gathered_phases();
  }
  for (std::size_t part = 0; part < result.size(); ++part)
    result[part].weights = weights.data() + first[part];
  return result;
}

} // namespace vdbeam
