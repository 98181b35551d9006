#include "compare/flip.h"

#include "math/affine.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

// Section and equation numbers are of the paper named in the header.

namespace vdbeam {
namespace {

using std::numbers::pi;
using Plane = std::vector<float>;

// ---- Colour spaces ----

/// Linear Rec. 709 RGB to XYZ, and back.
constexpr std::array<Vec3d, 3> rgb_to_xyz = {
    Vec3d{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    Vec3d{2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    Vec3d{1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};

Vec3d multiply(const std::array<Vec3d, 3>& m, const Vec3d& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

const std::array<Vec3d, 3> xyz_to_rgb = Affine{rgb_to_xyz, {}}.inverse().rows;
const Vec3d white = multiply(rgb_to_xyz, Vec3d(1.0));

/// The linearised opponent space of section 4.1.
Vec3d rgb_to_ycxcz(const Vec3d& rgb) {
  const Vec3d t = multiply(rgb_to_xyz, rgb) / white;
  return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}

Vec3d ycxcz_to_rgb(const Vec3d& v) {
  const double y = (v.x + 16) / 116;
  return multiply(xyz_to_rgb, Vec3d{y + v.y / 500, y, y - v.z / 200} * white);
}

/// CIE L*a*b* with the Hunt adjustment of section 4.1: chroma fades with lightness.
Vec3d rgb_to_hunt_lab(const Vec3d& rgb) {
  constexpr double delta = 6.0 / 29;
  const auto f = [](double t) {
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const Vec3d t = multiply(rgb_to_xyz, rgb) / white;
  const double l = 116 * f(t.y) - 16;
  return {l, 0.01 * l * 500 * (f(t.x) - f(t.y)), 0.01 * l * 200 * (f(t.y) - f(t.z))};
}

/// The HyAB distance (section 4.1), for large colour differences, to the power 0.7.
double colour_distance(const Vec3d& a, const Vec3d& b) {
  const Vec3d d = a - b;
  return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), 0.7);
}

// ---- Separable filters ----

/// Weights at -radius .. radius; outside the image the border pixel repeats.
using Kernel = std::vector<float>;

Kernel make_kernel(int radius, double scale, double (*shape)(double x, double scale)) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x)
    kernel.push_back(static_cast<float>(shape(x, scale)));
  return kernel;
}

double kernel_sum(const Kernel& kernel) {
  double sum = 0;
  for (const float weight : kernel)
    sum += weight;
  return sum;
}

struct Size {
  int width, height;
};

/// `plane` convolved with kernel `kx` along x and `ky` along y (correlation: no kernel is
/// mirrored).
Plane filter(const Plane& plane, Size size, const Kernel& kx, const Kernel& ky) {
  const int rx = static_cast<int>(kx.size() / 2), ry = static_cast<int>(ky.size() / 2);
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * size.width + x; };
  Plane rows(plane.size()), result(plane.size());
  tbb::parallel_for(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (int k = 0; k <= 2 * rx; ++k)
        sum += kx[static_cast<std::size_t>(k)] *
               plane[at(std::clamp(x + k - rx, 0, size.width - 1), y)];
      rows[at(x, y)] = static_cast<float>(sum);
    }
  });
  tbb::parallel_for(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (int k = 0; k <= 2 * ry; ++k)
        sum += ky[static_cast<std::size_t>(k)] *
               rows[at(x, std::clamp(y + k - ry, 0, size.height - 1))];
      result[at(x, y)] = static_cast<float>(sum);
    }
  });
  return result;
}

// ---- The colour pipeline (section 4.1) ----

/// One term a sqrt(pi / b) exp(-pi^2 x^2 / b) of a contrast sensitivity function, x in degrees.
struct SensitivityTerm {
  double a, b;
};

/// Filters an opponent channel by the contrast sensitivity of table 1.
Plane filter_sensitivity(const Plane& plane, Size size, double pixels_per_degree,
                         const std::vector<SensitivityTerm>& terms) {
  constexpr double widest_b = 0.04;
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(widest_b / (2 * pi * pi)) * pixels_per_degree));
  Plane result(plane.size(), 0.0f);
  double total = 0;
  for (const SensitivityTerm& term : terms) {
    const double scale = pi * pi / (term.b * pixels_per_degree * pixels_per_degree);
    const Kernel kernel =
        make_kernel(radius, scale, [](double x, double s) { return std::exp(-x * x * s); });
    const double height = term.a * std::sqrt(pi / term.b);
    const double sum = kernel_sum(kernel);
    total += height * sum * sum;
    const Plane filtered = filter(plane, size, kernel, kernel);
    for (std::size_t i = 0; i < plane.size(); ++i)
      result[i] += static_cast<float>(height * filtered[i]);
  }
  for (float& value : result)
    value = static_cast<float>(value / total);
  return result;
}

using Opponent = std::array<Plane, 3>;

Opponent to_opponent(const Image& image) {
  const Plane& r = image.find("R")->data;
  const Plane& g = image.find("G")->data;
  const Plane& b = image.find("B")->data;
  const auto clamp = [](float v) { return v > 0 ? std::min(v, 1.0f) : 0.0f; };
  Opponent planes{Plane(r.size()), Plane(r.size()), Plane(r.size())};
  for (std::size_t i = 0; i < r.size(); ++i) {
    const Vec3d v = rgb_to_ycxcz({clamp(r[i]), clamp(g[i]), clamp(b[i])});
    for (int c = 0; c < 3; ++c)
      planes[static_cast<std::size_t>(c)][i] = static_cast<float>(v[c]);
  }
  return planes;
}

/// The perceived colours of an image, ready for colour_distance.
std::vector<Vec3f> perceived_colours(const Opponent& opponent, Size size, double ppd) {
  const Plane y = filter_sensitivity(opponent[0], size, ppd, {{1, 0.0047}});
  const Plane cx = filter_sensitivity(opponent[1], size, ppd, {{1, 0.0053}});
  const Plane cz = filter_sensitivity(opponent[2], size, ppd, {{34.1, 0.04}, {13.5, 0.025}});
  std::vector<Vec3f> colours(y.size());
  tbb::parallel_for(0, size.height, [&](int row) {
    const std::size_t begin = static_cast<std::size_t>(row) * size.width;
    for (std::size_t i = begin; i < begin + size.width; ++i) {
      const Vec3d rgb = ycxcz_to_rgb({y[i], cx[i], cz[i]});
      colours[i] = Vec3f(rgb_to_hunt_lab(min(max(rgb, Vec3d(0.0)), Vec3d(1.0))));
    }
  });
  return colours;
}

/// Maps colour distances to [0, 1], section 4.1.3.
double redistribute(double distance) {
  constexpr double pc = 0.4, pt = 0.95;
  static const double largest =
      colour_distance(rgb_to_hunt_lab({0, 1, 0}), rgb_to_hunt_lab({0, 0, 1}));
  const double knee = pc * largest;
  return distance < knee ? distance * pt / knee
                         : pt + (distance - knee) / (largest - knee) * (1 - pt);
}

// ---- The feature pipeline (section 4.2) ----

/// Scales positive weights to a sum of 1 and negative ones to -1, when multiplied by a smoothing
/// kernel of sum 1 across.
void balance(Kernel& kernel) {
  double positive = 0, negative = 0;
  for (const float weight : kernel)
    (weight > 0 ? positive : negative) += weight;
  for (float& weight : kernel)
    weight = static_cast<float>(weight > 0 ? weight / positive : -weight / negative);
}

/// Lengths of the gradients (edges) and of the second derivatives (points) of the lightness.
struct Features {
  Plane edges, points;
};

Plane feature_length(const Plane& lightness, Size size, const Kernel& derivative,
                     const Kernel& smooth) {
  Plane x = filter(lightness, size, derivative, smooth);
  const Plane y = filter(lightness, size, smooth, derivative);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
  return x;
}

Features detect_features(const Plane& y, Size size, double ppd) {
  constexpr double feature_width = 0.082; // degrees
  const double sd = 0.5 * feature_width * ppd;
  const int radius = static_cast<int>(std::ceil(3 * sd));
  Kernel smooth =
      make_kernel(radius, sd, [](double x, double s) { return std::exp(-x * x / (2 * s * s)); });
  const double sum = kernel_sum(smooth);
  for (float& weight : smooth)
    weight = static_cast<float>(weight / sum);
  Kernel edge = make_kernel(radius, sd,
                            [](double x, double s) { return -x * std::exp(-x * x / (2 * s * s)); });
  Kernel point = make_kernel(radius, sd, [](double x, double s) {
    return (x * x / (s * s) - 1) * std::exp(-x * x / (2 * s * s));
  });
  balance(edge);
  balance(point);
  Plane lightness(y.size());
  std::transform(y.begin(), y.end(), lightness.begin(),
                 [](float value) { return (value + 16) / 116; });
  return {feature_length(lightness, size, edge, smooth),
          feature_length(lightness, size, point, smooth)};
}

double feature_difference(const Features& a, const Features& b, std::size_t i) {
  const double edge = std::abs(double{a.edges[i]} - b.edges[i]);
  const double point = std::abs(double{a.points[i]} - b.points[i]);
  return std::min(std::sqrt(std::max(edge, point) / std::numbers::sqrt2), 1.0);
}

} // namespace

std::vector<float> flip_map(const Image& image, const Image& reference, double pixels_per_degree) {
  const Size size{image.width, image.height};
  const Opponent a = to_opponent(image), b = to_opponent(reference);
  const Features features_a = detect_features(a[0], size, pixels_per_degree);
  const Features features_b = detect_features(b[0], size, pixels_per_degree);
  const std::vector<Vec3f> colours_a = perceived_colours(a, size, pixels_per_degree);
  const std::vector<Vec3f> colours_b = perceived_colours(b, size, pixels_per_degree);
  std::vector<float> map(colours_a.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double colour = redistribute(colour_distance(Vec3d(colours_a[i]), Vec3d(colours_b[i])));
    map[i] =
        static_cast<float>(std::pow(colour, 1 - feature_difference(features_a, features_b, i)));
  }
  return map;
}

double mean_flip(const Image& image, const Image& reference, double pixels_per_degree) {
  const std::vector<float> map = flip_map(image, reference, pixels_per_degree);
  double sum = 0;
  for (const float value : map)
    sum += value;
  return sum / static_cast<double>(map.size());
}

} // namespace vdbeam
