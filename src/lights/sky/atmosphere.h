#pragma once

#include "vdbeam/vec.h"

#include <array>
#include <span>
#include <vector>

namespace vdbeam {

/// What the air is like, and where the sun stands in it.
struct AirSettings {
  double sun_elevation = 0.8; ///< radians above the horizon, which may be negative
  double aerosol = 0.1;       ///< vertical optical depth of haze at 550 nm
  double ground_albedo = 0.2;
  double altitude = 0; ///< of the eye above the ground [m]

  friend bool operator==(const AirSettings&, const AirSettings&) = default;
};

/// A clear sky over a round earth: air (Rayleigh), haze and ozone, by wavelength from 380 to 720
/// nm. Light that scatters once is integrated along each line of sight; what scatters more often is
/// taken as isotropic from the second time on, and summed as a geometric series (Hillaire, A
/// Scalable and Production Ready Sky and Atmosphere Rendering Technique, EGSR 2020), here with the
/// light that the ground reflects.
///
/// Colours are X, Y and Z of the CIE 1931 standard observer, in units of the sun's illuminance
/// above the air: radiance per steradian, irradiance as it is.
class Atmosphere {
public:
  static constexpr std::size_t wavelengths = 17;
  using Spectrum = std::array<double, wavelengths>;

  explicit Atmosphere(const AirSettings& settings);

  /// Radiance of the sky, or of the ground below the horizon, without the sun's disc. `elevation`
  /// of the line of sight and `azimuth` from the sun's, radians.
  Vec3d radiance(double elevation, double azimuth) const;
  /// The air between the eye and a point.
  struct Between {
    Vec3d left;  ///< what it lets through of light with the spectrum of the sun above the air
    Vec3d light; ///< radiance that it scatters towards the eye
  };
  /// The air along a line of sight up to each of the distances [m], which ascend and are the steps
  /// of the integral. A line that meets the ground goes on in air as dense as there.
  void between(double elevation, double azimuth, std::span<const double> distances,
               std::span<Between> result) const;
  /// The colour of `Between::left` without air.
  Vec3d unfiltered() const;
  /// Length of that line in the air, or, where it meets the ground, of one that just misses it [m].
  double length_in_air(double elevation) const;

  /// Irradiance by the sun's disc on a plane that faces it.
  const Vec3d& sun() const { return sun_; }
  /// Irradiance by the sky on the ground.
  const Vec3d& sky() const { return sky_; }

private:
  /// Integrals along a line of the densities of air, haze and ozone, relative to the largest [m].
  using Columns = Vec3d;
  struct Line;     ///< a line of sight
  class Gathering; ///< the integral along it

  void make_columns();
  void make_scattered();
  void make_table();
  Columns columns_to_top(double radius, double mu) const;
  Spectrum transmittance(const Columns& columns) const;
  /// Share of the sun's light that arrives at a point; `mu`: cosine of its zenith angle.
  Spectrum sunlight(double radius, double mu) const;
  /// What has scattered more than once, per steradian, as if it came from everywhere.
  Spectrum scattered(double radius, double mu) const;
  /// Radiance along a line of sight; `repeated`: with what scattered more than once.
  Spectrum along(const Line& line, bool repeated, Spectrum* isotropic) const;
  Vec3d to_xyz(const Spectrum& spectrum) const;

  AirSettings settings_;
  Spectrum air_, haze_, ozone_;     ///< extinction where the density is 1 [1/m]
  std::vector<Columns> columns_;    ///< by radius and cosine
  std::vector<Spectrum> scattered_; ///< by radius and the sun's cosine
  std::vector<Vec3d> table_;        ///< by elevation and azimuth
  Spectrum sky_spectrum_{};         ///< irradiance by the sky on the ground
  Vec3d sun_, sky_;
};

} // namespace vdbeam
