#include "volume/blackbody.h"

#include <array>
#include <cmath>

namespace vdbeam {

namespace {

// Temperatures of the table, at equal steps of log T.
constexpr double coldest = 500, hottest = 50000;
constexpr int entries = 2048;

/// Colour matching functions of the CIE 1931 standard observer, 380 to 780 nm in steps of 10 (CIE
/// 15, Colorimetry, 2004, table T.4).
constexpr double first_wavelength = 380e-9, wavelength_step = 10e-9;
constexpr std::array<Vec3d, 41> observer{{Vec3d{0.001368, 0.000039, 0.00645},
                                          Vec3d{0.004243, 0.00012, 0.02005},
                                          Vec3d{0.01431, 0.000396, 0.06785},
                                          Vec3d{0.04351, 0.00121, 0.2074},
                                          Vec3d{0.13438, 0.004, 0.6456},
                                          Vec3d{0.2839, 0.0116, 1.3856},
                                          Vec3d{0.34828, 0.023, 1.74706},
                                          Vec3d{0.3362, 0.038, 1.77211},
                                          Vec3d{0.2908, 0.06, 1.6692},
                                          Vec3d{0.19536, 0.09098, 1.28764},
                                          Vec3d{0.09564, 0.13902, 0.81295},
                                          Vec3d{0.03201, 0.20802, 0.46518},
                                          Vec3d{0.0049, 0.323, 0.272},
                                          Vec3d{0.0093, 0.503, 0.1582},
                                          Vec3d{0.06327, 0.71, 0.07825},
                                          Vec3d{0.1655, 0.862, 0.04216},
                                          Vec3d{0.2904, 0.954, 0.0203},
                                          Vec3d{0.43345, 0.99495, 0.00875},
                                          Vec3d{0.5945, 0.995, 0.0039},
                                          Vec3d{0.7621, 0.952, 0.0021},
                                          Vec3d{0.9163, 0.87, 0.00165},
                                          Vec3d{1.0263, 0.757, 0.0011},
                                          Vec3d{1.0622, 0.631, 0.0008},
                                          Vec3d{1.0026, 0.503, 0.00034},
                                          Vec3d{0.85445, 0.381, 0.00019},
                                          Vec3d{0.6424, 0.265, 0.00005},
                                          Vec3d{0.4479, 0.175, 0.00002},
                                          Vec3d{0.2835, 0.107, 0},
                                          Vec3d{0.1649, 0.061, 0},
                                          Vec3d{0.0874, 0.032, 0},
                                          Vec3d{0.04677, 0.017, 0},
                                          Vec3d{0.0227, 0.00821, 0},
                                          Vec3d{0.011359, 0.004102, 0},
                                          Vec3d{0.00579, 0.002091, 0},
                                          Vec3d{0.002899, 0.001047, 0},
                                          Vec3d{0.00144, 0.00052, 0},
                                          Vec3d{0.00069, 0.000249, 0},
                                          Vec3d{0.000332, 0.00012, 0},
                                          Vec3d{0.000166, 0.00006, 0},
                                          Vec3d{0.000083, 0.00003, 0},
                                          Vec3d{0.000042, 0.000015, 0}}};

constexpr double c2 = 1.438776877e-2; // h c / k [m K] (CODATA 2018)
constexpr double longest_wavelength = 780e-9;
constexpr double wien = c2 / longest_wavelength;

/// X, Y, Z of Planck's law times exp(wien / T), which no temperature underflows.
Vec3d scaled_xyz(double kelvin) {
  constexpr double c1 = 1.191042972e-16; // 2 h c^2 [W m^2 / sr]
  Vec3d sum;
  for (std::size_t i = 0; i < observer.size(); ++i) {
    const double wavelength = first_wavelength + wavelength_step * static_cast<double>(i);
    const double x = c2 / (wavelength * kelvin);
    const double radiance =
        c1 / (std::pow(wavelength, 5) * -std::expm1(-x)) * std::exp(wien / kelvin - x);
    sum += observer[i] * (radiance * wavelength_step);
  }
  return sum;
}

struct Table {
  std::array<double, entries> log_luminance{};
  std::array<Vec3d, entries> color{};

  explicit Table(ColorSpace space) {
    const ColorMatrix from_rec709 =
        rgb_matrix(chromaticities_of(ColorSpace::rec709), chromaticities_of(space));
    const ColorMatrix to_rec709 =
        rgb_matrix(chromaticities_of(space), chromaticities_of(ColorSpace::rec709));
    for (std::size_t i = 0; i < entries; ++i) {
      const double kelvin =
          coldest * std::pow(hottest / coldest, static_cast<double>(i) / (entries - 1));
      const Vec3d xyz = scaled_xyz(kelvin);
      log_luminance[i] = std::log(xyz.y) - wien / kelvin;
      const Vec3d rgb = max(from_rec709.apply(xyz_to_rgb(xyz / xyz.y)), Vec3d(0));
      color[i] = rgb / luminance(to_rec709.apply(rgb));
    }
  }
  /// The value between two entries; kelvin within the table's ends.
  template <class T>
  static T read(const std::array<T, entries>& values, double kelvin) {
    const double place = std::log(kelvin / coldest) / std::log(hottest / coldest) * (entries - 1);
    const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, entries - 2.0));
    return values[i] + (values[i + 1] - values[i]) * (place - static_cast<double>(i));
  }
};

const Table& table(ColorSpace space = ColorSpace::rec709) {
  static const Table rec709(ColorSpace::rec709);
  if (space == ColorSpace::rec709)
    return rec709;
  static const Table others[] = {Table(ColorSpace::rec2020), Table(ColorSpace::acescg),
                                 Table(ColorSpace::aces2065_1)};
  return others[space == ColorSpace::rec2020 ? 0 : space == ColorSpace::acescg ? 1 : 2];
}

double log_luminance(double kelvin) {
  const double inside = Table::read(table().log_luminance, std::clamp(kelvin, coldest, hottest));
  if (kelvin > hottest) // Rayleigh and Jeans: as T
    return inside + std::log(kelvin / hottest);
  if (kelvin >= coldest)
    return inside;
  // Wien: the logarithm is linear in 1 / T.
  constexpr double next = coldest * 1.01;
  const double slope =
      (Table::read(table().log_luminance, next) - inside) / (1 / next - 1 / coldest);
  return inside + slope * (1 / kelvin - 1 / coldest);
}

} // namespace

Vec3d color_matching(double nanometres) {
  const double place = (nanometres * 1e-9 - first_wavelength) / wavelength_step;
  const auto last = static_cast<double>(observer.size() - 1);
  if (!(place >= 0 && place <= last))
    return {};
  const auto i = static_cast<std::size_t>(std::min(place, last - 1));
  return observer[i] + (observer[i + 1] - observer[i]) * (place - static_cast<double>(i));
}

Vec3d planck_xyz(double kelvin) {
  return scaled_xyz(kelvin) * std::exp(-wien / kelvin);
}

Vec3d xyz_to_rgb(const Vec3d& xyz) {
  return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
          -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
          0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

double luminance(const Vec3d& rgb) {
  return 0.2126729 * rgb.x + 0.7151522 * rgb.y + 0.0721750 * rgb.z;
}

Vec3d blackbody_color(double kelvin, ColorSpace space) {
  return Table::read(table(space).color, std::clamp(kelvin, coldest, hottest));
}

Rgb light_tint(const std::optional<double>& kelvin, double exposure, ColorSpace space) {
  return Rgb((kelvin ? blackbody_color(*kelvin, space) : Vec3d(1)) * std::exp2(exposure));
}

double blackbody_luminance(double kelvin, double reference) {
  if (!(kelvin > 0))
    return 0;
  constexpr double largest = 700; // exp of it is finite
  return std::exp(std::min(largest, log_luminance(kelvin) - log_luminance(reference)));
}

} // namespace vdbeam
