#include "lights/sky/atmosphere.h"

#include "volume/blackbody.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {
namespace {

constexpr double first_nm = 390, step_nm = 20; ///< middles of the bands, and their width
constexpr double earth = 6360e3, top = 6420e3; ///< radii of the ground and of the air's end [m]
constexpr double air_height = 8000, haze_height = 1200; ///< over which densities fall to 1/e [m]
constexpr double haze_albedo = 0.92, haze_g = 0.8, haze_exponent = 1.3; ///< of a rural haze
constexpr double sun_radius_radians = 0.2666 * std::numbers::pi / 180;

/// The sun's irradiance above the air (ASTM G173-03, extraterrestrial) in each band
/// [W / m^2 / nm].
constexpr Atmosphere::Spectrum solar{1.0798, 1.7291, 1.6506, 1.9734, 2.0213, 1.9459,
                                     1.8733, 1.8808, 1.8509, 1.8343, 1.7981, 1.7249,
                                     1.6642, 1.5631, 1.5338, 1.4611, 1.3890};
/// Cross section of ozone at about 240 K in each band [1e-25 m^2] (Serdyuchenko et al., High
/// spectral resolution ozone absorption cross-sections, 2014).
constexpr Atmosphere::Spectrum ozone_section{0.005, 0.021, 0.070, 0.195, 0.430, 0.838,
                                             1.541, 2.447, 3.296, 4.469, 4.550, 4.662,
                                             3.478, 2.450, 1.663, 1.076, 0.701};
constexpr double ozone_peak = 300 * 2.687e20 / 15000; ///< 300 Dobson units [1/m^3]

/// Sizes of the tables.
constexpr int column_radii = 64, column_cosines = 256;
constexpr int scattered_radii = 24, scattered_cosines = 48;
constexpr int table_rows = 192, table_columns = 49;

Vec3d densities(double radius) {
  const double height = std::max(0.0, radius - earth);
  return {std::exp(-height / air_height), std::exp(-height / haze_height),
          std::max(0.0, 1 - std::abs(height - 25e3) / 15e3)};
}

/// From a radius along a line with this cosine to the end of the air.
double to_top(double radius, double mu) {
  return std::max(0.0, -radius * mu + std::sqrt(radius * radius * (mu * mu - 1) + top * top));
}

/// To the ground; below 0 where the line misses it.
double to_ground(double radius, double mu) {
  const double square = radius * radius * (mu * mu - 1) + earth * earth;
  return mu < 0 && square >= 0 ? std::max(0.0, -radius * mu - std::sqrt(square)) : -1;
}

double rayleigh(double cosine) {
  return 3 / (16 * std::numbers::pi) * (1 + cosine * cosine);
}
double haze_phase(double cosine) {
  return (1 - haze_g * haze_g) /
         (4 * std::numbers::pi * std::pow(1 + haze_g * haze_g - 2 * haze_g * cosine, 1.5));
}

/// Bilinear reading of a table of rows; both places in [0, 1].
template <class T, class Mix>
T read_table(const std::vector<T>& table, int rows, int columns, double row, double column,
             const Mix& mix) {
  const auto place = [](double x, int size, double& rest) {
    const double scaled = std::clamp(x, 0.0, 1.0) * (size - 1);
    const int i = std::min(static_cast<int>(scaled), size - 2);
    rest = scaled - i;
    return i;
  };
  double v = 0, u = 0;
  const int i = place(row, rows, v), j = place(column, columns, u);
  const auto at = [&](int a, int b) -> const T& {
    return table[static_cast<std::size_t>(a) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(b)];
  };
  return mix(mix(at(i, j), at(i, j + 1), u), mix(at(i + 1, j), at(i + 1, j + 1), u), v);
}

constexpr auto mix_vectors = [](const Vec3d& a, const Vec3d& b, double t) {
  return a + (b - a) * t;
};
constexpr auto mix_spectra = [](Atmosphere::Spectrum a, const Atmosphere::Spectrum& b, double t) {
  for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w)
    a[w] += (b[w] - a[w]) * t;
  return a;
};

} // namespace

struct Atmosphere::Line {
  double radius, mu; ///< where it begins, and the cosine of its zenith angle
  double sun_mu;     ///< of the sun's, there
  double cosine;     ///< between the line and the way to the sun
  int steps;
};

Atmosphere::Atmosphere(const AirSettings& settings) : settings_(settings) {
  settings_.altitude = std::clamp(settings_.altitude, 1.0, 50e3);
  for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w) {
    const double micrometres = (first_nm + step_nm * static_cast<double>(w)) / 1000;
    const double square = micrometres * micrometres;
    // Optical depth of all the air (Hansen and Travis, Light scattering in planetary atmospheres,
    // 1974).
    air_[w] = 0.008569 / (square * square) * (1 + 0.0113 / square + 0.00013 / (square * square)) /
              air_height;
    haze_[w] = settings_.aerosol / haze_height * std::pow(micrometres / 0.55, -haze_exponent);
    ozone_[w] = ozone_section[w] * 1e-25 * ozone_peak;
  }
  make_columns();
  make_scattered();
  make_table();
  const double mu = std::sin(settings_.sun_elevation), radius = earth + settings_.altitude;
  sun_ = to_xyz(sunlight(radius, mu));
  sky_ = to_xyz(sky_spectrum_);
}

Vec3d Atmosphere::to_xyz(const Spectrum& spectrum) const {
  Vec3d sum;
  double white = 0;
  for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w) {
    const Vec3d seen = color_matching(first_nm + step_nm * static_cast<double>(w)) * solar[w];
    sum += seen * spectrum[w];
    white += seen.y;
  }
  return sum / white;
}

/// Rows by the distance to the horizon, columns by that to the end of the air, so that the horizon,
/// where both change fastest, has the finest steps (Bruneton and Neyret 2008).
void Atmosphere::make_columns() {
  columns_.resize(static_cast<std::size_t>(column_radii) * column_cosines);
  const double widest = std::sqrt(top * top - earth * earth);
  tbb::parallel_for(0, column_radii, [&](int i) {
    const double rho = widest * i / (column_radii - 1);
    const double radius = std::sqrt(rho * rho + earth * earth);
    for (int j = 0; j < column_cosines; ++j) {
      const double least = top - radius, most = rho + widest;
      const double length = least + (most - least) * j / (column_cosines - 1);
      const double mu =
          length == 0
              ? 1
              : std::clamp((widest * widest - rho * rho - length * length) / (2 * radius * length),
                           -1.0, 1.0);
      constexpr int steps = 250;
      Columns sum;
      for (int k = 0; k < steps; ++k) {
        const double t = length * (k + 0.5) / steps;
        sum += densities(std::sqrt(radius * radius + t * t + 2 * radius * mu * t));
      }
      columns_[static_cast<std::size_t>(i) * column_cosines + static_cast<std::size_t>(j)] =
          sum * (length / steps);
    }
  });
}

Atmosphere::Columns Atmosphere::columns_to_top(double radius, double mu) const {
  const double widest = std::sqrt(top * top - earth * earth);
  const double rho = std::sqrt(std::max(0.0, radius * radius - earth * earth));
  const double least = top - radius, most = rho + widest;
  const double along = (to_top(radius, mu) - least) / (most - least);
  return read_table(columns_, column_radii, column_cosines, rho / widest, along, mix_vectors);
}

Atmosphere::Spectrum Atmosphere::transmittance(const Columns& columns) const {
  Spectrum result;
  for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w)
    result[w] = std::exp(-(air_[w] * columns.x + haze_[w] * columns.y + ozone_[w] * columns.z));
  return result;
}

Atmosphere::Spectrum Atmosphere::sunlight(double radius, double mu) const {
  const double sine = earth / radius, horizon = -std::sqrt(std::max(0.0, 1 - sine * sine));
  // The part of the disc that stands above the horizon.
  const double x = std::clamp((mu - horizon) / (2 * sine * sun_radius_radians) + 0.5, 0.0, 1.0);
  if (x == 0)
    return {};
  Spectrum result = transmittance(columns_to_top(radius, std::max(mu, horizon)));
  for (double& value : result)
    value *= x * x * (3 - 2 * x);
  return result;
}

Atmosphere::Spectrum Atmosphere::scattered(double radius, double mu) const {
  return read_table(scattered_, scattered_radii, scattered_cosines,
                    std::sqrt(std::max(0.0, radius - earth) / (top - earth)),
                    0.5 + 0.5 * std::copysign(std::sqrt(std::abs(mu)), mu), mix_spectra);
}

/// Light that is scattered towards the beginning of a line, summed from there on.
class Atmosphere::Gathering {
public:
  Gathering(const Atmosphere& air, const Line& line, bool repeated)
      : air_(air), line_(line), repeated_(repeated), of_air_(rayleigh(line.cosine)),
        of_haze_(haze_phase(line.cosine)) {
    left.fill(1);
  }

  /// Adds the piece up to `end`. `isotropic`, unless it is null, takes what scatters there of light
  /// that comes from everywhere.
  void advance(double end, Spectrum* isotropic = nullptr) {
    double radius = 0, sun_mu = 0;
    point((begin_ + end) / 2, radius, sun_mu);
    const Vec3d density = densities(radius);
    const Spectrum sun = air_.sunlight(radius, sun_mu),
                   more = repeated_ ? air_.scattered(radius, sun_mu) : Spectrum{};
    for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w) {
      const double air = air_.air_[w] * density.x, all_haze = air_.haze_[w] * density.y;
      const double haze = all_haze * haze_albedo;
      const double extinction = air + all_haze + air_.ozone_[w] * density.z;
      const double after = std::exp(-extinction * (end - begin_));
      const double mean = extinction > 0 ? left[w] * (1 - after) / extinction : 0;
      sum[w] += mean * ((air * of_air_ + haze * of_haze_) * sun[w] + (air + haze) * more[w]);
      if (isotropic)
        (*isotropic)[w] += mean * (air + haze);
      left[w] *= after;
    }
    begin_ = end;
  }

  /// A point of the line; below the ground it counts as on it.
  void point(double t, double& radius, double& sun_mu) const {
    radius = std::sqrt(line_.radius * line_.radius + t * t + 2 * line_.radius * line_.mu * t);
    radius = std::max(radius, earth);
    sun_mu = std::clamp((line_.radius * line_.sun_mu + t * line_.cosine) / radius, -1.0, 1.0);
  }

  Spectrum sum{}, left; ///< light so far; transmittance of the air up to there

private:
  const Atmosphere& air_;
  const Line& line_;
  bool repeated_;
  double of_air_, of_haze_, begin_ = 0;
};

Atmosphere::Spectrum Atmosphere::along(const Line& line, bool repeated, Spectrum* isotropic) const {
  const double ground = to_ground(line.radius, line.mu);
  const double length = ground >= 0 ? ground : to_top(line.radius, line.mu);
  Gathering gathering(*this, line, repeated);
  for (int k = 0; k < line.steps; ++k) {
    const double share = static_cast<double>(k + 1) / line.steps;
    gathering.advance(length * share * share, isotropic); // shorter steps where the air is dense
  }
  Spectrum& sum = gathering.sum;
  if (ground >= 0) {
    double radius = 0, sun_mu = 0;
    gathering.point(length, radius, sun_mu);
    const Spectrum sun = sunlight(earth, sun_mu);
    for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w) {
      const double lit = std::max(0.0, sun_mu) * sun[w] + (repeated ? sky_spectrum_[w] : 0);
      sum[w] += gathering.left[w] * settings_.ground_albedo / std::numbers::pi * lit;
      if (isotropic)
        (*isotropic)[w] += gathering.left[w] * settings_.ground_albedo;
    }
  }
  return sum;
}

Vec3d Atmosphere::unfiltered() const {
  Spectrum whole;
  whole.fill(1);
  return to_xyz(whole);
}

double Atmosphere::length_in_air(double elevation) const {
  const double radius = earth + settings_.altitude, mu = std::sin(elevation);
  if (to_ground(radius, mu) < 0)
    return to_top(radius, mu);
  return std::sqrt(radius * radius - earth * earth) + std::sqrt(top * top - earth * earth);
}

void Atmosphere::between(double elevation, double azimuth, std::span<const double> distances,
                         std::span<Between> result) const {
  const double sun_mu = std::sin(settings_.sun_elevation), mu = std::sin(elevation);
  const double sides = std::cos(settings_.sun_elevation) * std::cos(elevation);
  const double cosine = std::clamp(mu * sun_mu + sides * std::cos(azimuth), -1.0, 1.0);
  const Line line{earth + settings_.altitude, mu, sun_mu, cosine, 0};
  Gathering gathering(*this, line, true);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    gathering.advance(distances[i]);
    result[i] = {to_xyz(gathering.left), to_xyz(gathering.sum)};
  }
}

void Atmosphere::make_scattered() {
  scattered_.resize(static_cast<std::size_t>(scattered_radii) * scattered_cosines);
  tbb::parallel_for(0, scattered_radii * scattered_cosines, [&](int entry) {
    const double share = static_cast<double>(entry / scattered_cosines) / (scattered_radii - 1);
    const double radius = std::min(earth + (top - earth) * share * share + 1, top - 1);
    const double x =
        2.0 * (entry % scattered_cosines) / (scattered_cosines - 1) - 1; // of the cosine's root
    const double sun_mu = std::copysign(x * x, x), sun_side = std::sqrt(1 - sun_mu * sun_mu);
    Spectrum once{}, isotropic{};
    constexpr int polar = 12, around = 6;
    for (int i = 0; i < polar; ++i)
      for (int j = 0; j < around; ++j) {
        const double mu = 2 * (i + 0.5) / polar - 1, side = std::sqrt(1 - mu * mu);
        const double cosine =
            mu * sun_mu + side * sun_side * std::cos(std::numbers::pi * (j + 0.5) / around);
        const Spectrum found = along({radius, mu, sun_mu, cosine, 16}, false, &isotropic);
        for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w)
          once[w] += found[w];
      }
    Spectrum& result = scattered_[static_cast<std::size_t>(entry)];
    for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w)
      result[w] = once[w] / (polar * around) / (1 - isotropic[w] / (polar * around));
  });
}

/// Rows lie densest at the horizon; above it first, since the sky lights the ground.
void Atmosphere::make_table() {
  std::vector<Spectrum> spectra(static_cast<std::size_t>(table_rows) * table_columns);
  const double sun_mu = std::sin(settings_.sun_elevation),
               sun_side = std::cos(settings_.sun_elevation);
  const double radius = earth + settings_.altitude;
  const auto elevation = [](int row) {
    const double v = 2 * (row + 0.5) / table_rows - 1;
    return std::copysign(v * v, v) * std::numbers::pi / 2;
  };
  const auto fill = [&](int row) {
    const double mu = std::sin(elevation(row)), side = std::cos(elevation(row));
    for (int j = 0; j < table_columns; ++j) {
      const double azimuth = std::numbers::pi * j / (table_columns - 1);
      const double cosine =
          std::clamp(mu * sun_mu + side * sun_side * std::cos(azimuth), -1.0, 1.0);
      spectra[static_cast<std::size_t>(row) * table_columns + static_cast<std::size_t>(j)] =
          along({radius, mu, sun_mu, cosine, 48}, true, nullptr);
    }
  };
  tbb::parallel_for(table_rows / 2, table_rows, fill);
  for (int row = table_rows / 2; row < table_rows; ++row) {
    const double v = 2 * (row + 0.5) / table_rows - 1,
                 band = std::numbers::pi * v * 2 / table_rows; // de
    const double e = elevation(row),
                 weight = std::sin(e) * std::cos(e) * band * 2 * std::numbers::pi;
    for (int j = 0; j < table_columns; ++j) {
      const double share = (j == 0 || j + 1 == table_columns ? 0.5 : 1.0) / (table_columns - 1);
      const Spectrum& seen =
          spectra[static_cast<std::size_t>(row) * table_columns + static_cast<std::size_t>(j)];
      for (std::size_t w = 0; w < Atmosphere::wavelengths; ++w)
        sky_spectrum_[w] += seen[w] * weight * share;
    }
  }
  tbb::parallel_for(0, table_rows / 2, fill);
  for (const Spectrum& spectrum : spectra)
    table_.push_back(to_xyz(spectrum));
}

Vec3d Atmosphere::radiance(double elevation, double azimuth) const {
  const double v = std::copysign(
      std::sqrt(std::min(1.0, std::abs(elevation) / (std::numbers::pi / 2))), elevation);
  double row = (v + 1) / 2 * table_rows - 0.5;
  // Nothing is blended across the horizon.
  const double half = table_rows / 2.0;
  row = elevation >= 0 ? std::max(row, half) : std::min(row, half - 1);
  const double turn = std::abs(std::remainder(azimuth, 2 * std::numbers::pi)) / std::numbers::pi;
  return read_table(table_, table_rows, table_columns, row / (table_rows - 1), turn, mix_vectors);
}

} // namespace vdbeam
