#pragma once

#include "math/affine.h"
#include "math/ray.h"
#include "math/stop_token.h"
#include "photonmap/beam_tile.h"
#include "photonmap/photon.h"

#include <functional>
#include <memory>
#include <span>

namespace vdbeam {

/// What a photon's kernel becomes: its radius, the weight of the photon's power, and the share of
/// the kernel that lies where photons can be, by which the power is divided.
struct Kernel {
  float radius, weight = 1, share = 1;
};

/// Changes a kernel, given the photon's position and part of the medium, and the radius so far.
using KernelFit = std::function<Kernel(const Vec3f& position, std::size_t part, float radius)>;

/// How kernel radii are chosen (render units).
struct RadiusSettings {
  KernelRadius mode = KernelRadius::adaptive;
  float fixed_radius = 0;   ///< fixed mode
  float neighbours = 100;   ///< adaptive mode: expected photons in the sphere of radius r_i
  float scale = 1;          ///< progressive shrinking: applied to adaptive and fixed radii alike
  float min_radius = 0;     ///< clamp after scaling; > 0
  float max_radius = 1e30f; ///< clamp after scaling

  bool operator==(const RadiusSettings&) const = default;
};

/// A photon on a surface near a point.
struct DiscPhoton {
  Vec3f position, direction; ///< `direction`: the way it travels
  Rgb irradiance;            ///< its power times the disc kernel K_2D(d, r)
  float radius = 0;
  int group = -1; ///< of the light that sent it; -1: there are none
};

struct MapTimes {
  double order = 0, radii = 0, build = 0; ///< seconds
};

/// The photon map of one pass: photons in kd-median order in full 16-photon blocks (structure of
/// arrays, the last block padded with photons of radius 0 and power 0), an implicit 8-ary tree of
/// boxes over the blocks, boxes around the photons' spheres. Photons of each part of the medium
/// have a tree and kernel radii of their own, and count with that part's sigma_s.
///
/// Building is deterministic and parallel (oneTBB); the result does not depend on the number of
/// threads. Queries are const and may run concurrently. Any input is legal: no photons, coincident,
/// collinear, coplanar photons; photons with a non-finite field, or
/// farther than 1e15 from the origin, are dropped.
class PhotonMap {
public:
  PhotonMap();
  ~PhotonMap();
  PhotonMap(PhotonMap&&) noexcept;
  PhotonMap& operator=(PhotonMap&&) noexcept;

  /// Orders the photons, finds radii, refits boxes. `channels` is 1 where every power is grey (only
  /// x is kept), else 3. Returns an empty map where `stop`, unless it is null, says so.
  static PhotonMap build(PhotonList photons, int channels, const RadiusSettings& radii,
                         KernelShape shape, const StopToken* stop = nullptr);

  /// The same map once more.
  PhotonMap copy() const;
  /// Changes every kernel. Where `stop` says so it ends early, and some stay as they were.
  void fit(const KernelFit& fit, const StopToken* stop = nullptr);
  /// The same map with the radius of every kernel multiplied by `factor`.
  PhotonMap resized(float factor) const;

  std::size_t size() const;
  std::size_t bytes() const;
  /// Memory for building a map, per photon [bytes]: the list, its order, and the map.
  static std::size_t build_bytes_per_photon(int channels, bool directions, bool groups);
  int channels() const;
  bool has_directions() const;
  MapTimes times() const;
  Boxf bounds() const; ///< of all spheres
  float mean_radius() const;
  float mean_radius(std::size_t part) const; ///< 0 where that has no photons

  /// Beam radiance estimate for a tile: adds to tile.radiance (Jarosz et al. 2008, eq. 11, with the
  /// ray's own sigma_s: see BeamTile).
  QueryCounts query(BeamTile& tile) const;

  /// One ray, same formula, for whatever does not come in tiles, and to test the tiles against.
  /// weights: as a Profile with one ray: [group * weight_channels + c][knot].
  struct RayProfile {
    Ray ray;
    float t_begin = 0, step = 1;
    int knots = 0;
    float t_end = infinity; ///< where the ray ends; what lies beyond does not count
    const float* weights = nullptr;
    int weight_channels = 1;
    const std::vector<PhaseFunction>* phases = nullptr;
  };
  /// Adds to `radiance`; `by_part`: for the photons of each part of the medium. `groups`, unless it
  /// is null: set to the part of each group of lights.
  QueryCounts query_ray(std::span<const RayProfile> by_part, Rgb& radiance,
                        std::vector<Rgb>* groups = nullptr) const;
  QueryCounts query_ray(const RayProfile& profile, Rgb& radiance) const {
    return query_ray({&profile, 1}, radiance);
  }

  /// Conventional estimate at a point: sum over photons whose sphere contains `point` of
  /// K_3D(d, r) * p(cos) * power, one value per phase function (Jensen and Christensen 1998), of
  /// the photons of one part of the medium.
  /// `direction` is the camera ray's, away from the camera. Sets in_scattered[0 .. phases.size())
  /// and, unless it is null, first_flight, its part that comes straight from lights.
  /// `groups`, unless it is null: set to the part of each group of lights, [group][phase function].
  QueryCounts query_point(const Vec3f& point, const Vec3f& direction, std::size_t part,
                          const std::vector<PhaseFunction>& phases, Rgb* in_scattered,
                          Rgb* first_flight = nullptr, std::vector<Rgb>* groups = nullptr) const;
  int groups() const;             ///< number of light groups whose photons are marked; 0: none
  bool has_first_flights() const; ///< photons that come straight from a light

  /// Adds the surface photons whose spheres contain `point`, in a fixed order. Requires photons
  /// with directions.
  void find_on_disc(const Vec3f& point, std::vector<DiscPhoton>& found) const;

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Name of the SIMD target that queries run on here, e.g. "AVX3_ZEN4", "AVX2", "SCALAR".
const char* simd_target();

} // namespace vdbeam
