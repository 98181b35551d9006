#include "phase/draine.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

// Everything below is for g >= 0; a negative g mirrors the angle. x stands for 1 - cos.
//
// Henyey-Greenstein's distribution w(x) (the probability of a smaller angle) and its inverse, both
// written so that no two nearly equal numbers are subtracted, neither for g -> 0 nor for g -> 1.
// With b = 1 - g, s = sqrt(b^2 + 2 g x) and q = (1 - g^2) / s:
//   w = (1 + g) x / (s (s + b)),  q = b + 2 g (1 - w),  x = b^2 w (1 + g + q) / q^2.
double invert_henyey_greenstein(double g, double w) {
  const double b = 1 - g;
  const double q = b + 2 * g * (1 - w);
  return b * b * w * (1 + g + q) / (q * q);
}

struct DraineCdf {
  double g, alpha;

  struct Value {
    double x;         // 1 - cos
    double cdf;       // times 1 + alpha (1 + 2 g^2) / 3, as the rest
    double slope;     // d cdf / d w
    double curvature; // d slope / d w
  };

  // Draine's distribution as a function of Henyey-Greenstein's, w. Its slope 1 + alpha cos^2 is
  // smooth and bounded away from 0 for every g, which Halley's method likes. The moments are
  //   m1 = integral x dw   = (1 - g^2) x^2 / (s (s + b)^2),
  //   m2 = integral x^2 dw = (1 - g^2) x^3 (s + 3 b) / (3 s (s + b)^3),
  // cos^2 = 1 - 2 x + x^2, and dx/dw = 2 s^3 / (1 - g^2).
  Value at(double w) const {
    const double b = 1 - g, c = 1 - g * g;
    const double q = b + 2 * g * (1 - w), inverse_q = 1 / q;
    const double x = b * b * w * (1 + g + q) * inverse_q * inverse_q;
    const double s = c * inverse_q, ratio = x / (s + b), cosine = 1 - x;
    const double m1 = q * ratio * ratio;
    const double m2 = m1 * ratio * (s + 3 * b) * (1.0 / 3);
    return {x, (1 + alpha) * w - alpha * (2 * m1 - m2), 1 + alpha * cosine * cosine,
            -4 * alpha * cosine * s * s * inverse_q};
  }

  // Halley's method within a shrinking bracket: three to four steps on average.
  double invert(double u) const {
    constexpr double tolerance = 1e-9; // u has 24 bits
    constexpr int limit = 60;          // bisection alone would be done by then
    const double norm = 1 + alpha * (1 + 2 * g * g) / 3, target = u * norm;
    double low = 0, high = 1, w = u, x = 0;
    for (int i = 0; i < limit; ++i) {
      const Value value = at(w);
      x = value.x;
      const double error = value.cdf - target;
      if (std::abs(error) < tolerance * norm)
        break;
      (error > 0 ? high : low) = w;
      const double square = value.slope * value.slope;
      const double bent = std::clamp(2 * square - error * value.curvature, square, 4 * square);
      const double next = w - 2 * error * value.slope / bent;
      w = next > low && next < high ? next : (low + high) / 2;
    }
    return x;
  }
};

} // namespace

float sample_draine_one_minus_cos(float g, float alpha, float u) {
  const double size = std::abs(static_cast<double>(g));
  double x = alpha > 0 ? DraineCdf{size, alpha}.invert(u) : invert_henyey_greenstein(size, u);
  if (g < 0)
    x = 2 - x;
  return static_cast<float>(std::clamp(x, 0.0, 2.0));
}

} // namespace vdbeam
