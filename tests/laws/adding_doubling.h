#pragma once

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/special_functions/legendre.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

/// An independent solution of the plane-parallel slab, for the laws that renders are held to: the
/// adding-doubling method (van de Hulst 1980, ch. 4; Prahl et al. 1993) in double precision, on a
/// half-range Gauss-Legendre quadrature, index-matched boundaries, started by the diamond scheme
/// (Wiscombe 1976). It shares no code with the renderer; Legendre polynomials and their zeros
/// come from Boost.Math.
namespace vdbeam::slab {

/// Legendre moments chi_l of a phase function p = sum_l (2 l + 1) chi_l P_l(cos) / (4 pi); chi_0
/// = 1.
using Moments = std::vector<double>;

inline Moments isotropic() {
  return {1};
}
/// P = 3/4 (1 + cos^2).
inline Moments rayleigh() {
  return {1, 0, 0.1};
}
inline Moments henyey_greenstein(double g) {
  Moments moments{1};
  while (std::abs(moments.back()) > 1e-14 && moments.size() < 1000)
    moments.push_back(moments.back() * g);
  return moments;
}

/// A square matrix, no more than this method needs.
class Matrix {
public:
  explicit Matrix(std::size_t n, double diagonal = 0) : n_(n), values_(n * n) {
    for (std::size_t i = 0; i < n; ++i)
      (*this)(i, i) = diagonal;
  }
  std::size_t size() const { return n_; }
  double& operator()(std::size_t i, std::size_t j) { return values_[i * n_ + j]; }
  double operator()(std::size_t i, std::size_t j) const { return values_[i * n_ + j]; }

  friend Matrix combine(double a, const Matrix& x, double b, const Matrix& y) {
    Matrix result(x.n_);
    for (std::size_t i = 0; i < x.values_.size(); ++i)
      result.values_[i] = a * x.values_[i] + b * y.values_[i];
    return result;
  }
  friend Matrix operator*(const Matrix& x, const Matrix& y) {
    const std::size_t n = x.n_;
    Matrix result(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t j = 0; j < n; ++j)
          result(i, j) += x(i, k) * y(k, j);
    return result;
  }
  /// x^-1 y by Gaussian elimination with partial pivoting.
  friend Matrix solve(Matrix x, Matrix y) {
    const std::size_t n = x.n_;
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n; ++i)
        if (std::abs(x(i, k)) > std::abs(x(pivot, k)))
          pivot = i;
      for (std::size_t j = 0; j < n; ++j) {
        std::swap(x(k, j), x(pivot, j));
        std::swap(y(k, j), y(pivot, j));
      }
      for (std::size_t i = 0; i < n; ++i) {
        const double factor = i == k ? 0 : x(i, k) / x(k, k);
        if (factor == 0)
          continue;
        for (std::size_t j = k; j < n; ++j)
          x(i, j) -= factor * x(k, j);
        for (std::size_t j = 0; j < n; ++j)
          y(i, j) -= factor * y(k, j);
      }
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        y(i, j) /= x(i, i);
    return y;
  }

private:
  std::size_t n_;
  std::vector<double> values_;
};

/// P_0 ... P_(count - 1) at x.
inline std::vector<double> legendre(double x, std::size_t count) {
  std::vector<double> p{1, x};
  for (unsigned l = 1; l + 1 < count; ++l)
    p.push_back(boost::math::legendre_next(l, x, p[l], p[l - 1]));
  p.resize(count);
  return p;
}

/// Nodes and weights on [0, 1].
struct Quadrature {
  std::vector<double> nodes, weights;
};

inline Quadrature gauss_legendre(std::size_t count) {
  Quadrature q;
  const int order = static_cast<int>(count);
  const auto add = [&](double x) {
    const double derivative = boost::math::legendre_p_prime(order, x);
    q.nodes.push_back((1 + x) / 2);
    q.weights.push_back(1 / ((1 - x * x) * derivative * derivative));
  };
  for (const double x : boost::math::legendre_p_zeros<double>(order)) { // those from 0 on
    add(x);
    if (x > 0)
      add(-x);
  }
  return q;
}

/// A homogeneous slab and what it does to light, averaged over azimuth. Every direction is the
/// cosine of the angle to the normal, in (0, 1]. Exact as the quadrature grows; with `points` = 32
/// about six digits for |g| <= 0.8 (the phase function is cut after 2 points - 1 moments, so peaked
/// ones need more points).
class Slab {
public:
  /// `incident` and `emergent` are the directions that the member functions below number.
  Slab(const Moments& phase, double albedo, double thickness, std::vector<double> incident = {1},
       std::vector<double> emergent = {}, std::size_t points = 32)
      : thickness_(thickness), incident_(std::move(incident)), emergent_(std::move(emergent)),
        points_(points), quadrature_(gauss_legendre(points)), reflection_(1), transmission_(1) {
    // Wanted directions join the quadrature with a weight that changes nothing but scales their
    // columns; incident and emergent ones are separate nodes, so a diffuse entry never mixes with
    // direct light.
    for (const std::vector<double>* extra : {&incident_, &emergent_})
      for (const double mu : *extra) {
        quadrature_.nodes.push_back(mu);
        quadrature_.weights.push_back(tiny_weight);
      }
    double layer = thickness;
    int doublings = 0;
    while (layer > 2e-5) {
      layer /= 2;
      ++doublings;
    }
    start(phase, albedo, layer);
    for (int i = 0; i < doublings; ++i)
      double_thickness();
  }

  /// Share of a beam's flux that leaves on its own side, on the far side (direct light included),
  /// and on the far side undeflected.
  double reflectance(std::size_t incident = 0) const {
    return row_sum(reflection_, points_ + incident);
  }
  double transmittance(std::size_t incident = 0) const {
    return row_sum(transmission_, points_ + incident);
  }
  double direct(std::size_t incident = 0) const {
    return std::exp(-thickness_ / incident_[incident]);
  }
  /// The same for isotropic radiance over the hemisphere (van de Hulst's URU and UTU).
  double diffuse_reflectance() const { return flux_mean(reflection_); }
  double diffuse_transmittance() const { return flux_mean(transmission_); }

  /// Radiance over the beam's irradiance on a plane that faces it [1/sr], averaged over azimuth.
  double reflected_radiance(std::size_t emergent, std::size_t incident = 0) const {
    return radiance(reflection_, emergent, incident);
  }
  double transmitted_radiance(std::size_t emergent, std::size_t incident = 0) const {
    return radiance(transmission_, emergent, incident);
  }
  /// Emergent radiance where radiance 1 comes in from every direction of one side.
  double reflected_of_diffuse(std::size_t emergent) const {
    return row_sum(reflection_, points_ + incident_.size() + emergent);
  }
  double transmitted_of_diffuse(std::size_t emergent) const {
    return row_sum(transmission_, points_ + incident_.size() + emergent);
  }

private:
  static constexpr double tiny_weight = 1e-12;

  /// A layer so thin that the midpoint rule carries it: with a = A dtau / 2, b = B dtau / 2 of
  /// d(I+, I-)/dtau = (-A I+ + B I-, -B I+ + A I-), T = 2 G - 1 and R = 2 (1 + a)^-1 b G, where
  /// G = (1 + a - b (1 + a)^-1 b)^-1.
  void start(const Moments& phase, double albedo, double layer) {
    const std::size_t n = quadrature_.nodes.size();
    const std::size_t count = std::min(phase.size(), 2 * points_);
    std::vector<std::vector<double>> p;
    for (const double mu : quadrature_.nodes)
      p.push_back(legendre(mu, count));
    Matrix one_plus_a(n), b(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        double forward = 0, backward = 0;
        for (std::size_t l = 0; l < count; ++l) {
          const double term = (2 * static_cast<double>(l) + 1) * phase[l] * p[i][l] * p[j][l];
          forward += term;
          backward += l % 2 == 0 ? term : -term;
        }
        const double scale = layer / (2 * quadrature_.nodes[i]), same = i == j ? 1 : 0;
        const double scattered = albedo / 2 * quadrature_.weights[j];
        one_plus_a(i, j) = same + scale * (same - scattered * forward);
        b(i, j) = scale * scattered * backward;
      }
    const Matrix once = solve(one_plus_a, b);
    const Matrix g = solve(combine(1, one_plus_a, -1, b * once), Matrix(n, 1));
    transmission_ = combine(2, g, -1, Matrix(n, 1));
    reflection_ = combine(2, once * g, 0, g);
  }

  /// T' = T (1 - R R)^-1 T, R' = R + T R (1 - R R)^-1 T.
  void double_thickness() {
    const Matrix between = solve(
        combine(1, Matrix(reflection_.size(), 1), -1, reflection_ * reflection_), transmission_);
    reflection_ = combine(1, reflection_, 1, transmission_ * (reflection_ * between));
    transmission_ = transmission_ * between;
  }

  /// By reciprocity the flux that leaves for a beam is the radiance at the beam's direction for
  /// isotropic illumination.
  double row_sum(const Matrix& matrix, std::size_t row) const {
    double sum = 0;
    for (std::size_t j = 0; j < matrix.size(); ++j)
      sum += matrix(row, j);
    return sum;
  }
  double flux_mean(const Matrix& matrix) const {
    double sum = 0;
    for (std::size_t i = 0; i < points_; ++i)
      sum += 2 * quadrature_.weights[i] * quadrature_.nodes[i] * row_sum(matrix, i);
    return sum;
  }
  double radiance(const Matrix& matrix, std::size_t emergent, std::size_t incident) const {
    return matrix(points_ + incident_.size() + emergent, points_ + incident) /
           (2 * std::numbers::pi * tiny_weight);
  }

  double thickness_;
  std::vector<double> incident_, emergent_;
  std::size_t points_;
  Quadrature quadrature_;
  Matrix reflection_, transmission_;
};

/// Chandrasekhar's H-function for isotropic scattering by its integral (Stibbs and Weir 1959):
/// ln H(mu) = -mu / pi  integral_0^(pi/2) ln(1 - albedo t cot t) / (cos^2 t + mu^2 sin^2 t) dt.
inline double h_function(double albedo, double mu) {
  const auto integrand = [=](double t) {
    const double cosine = std::cos(t), sine = std::sin(t);
    const double one_minus_t_cot_t =
        t < 1e-2 ? t * t / 3 * (1 + t * t / 15 * (1 + t * t * 2 / 21)) : 1 - t * cosine / sine;
    return std::log(1 - albedo + albedo * one_minus_t_cot_t) /
           (cosine * cosine + mu * mu * sine * sine);
  };
  // The logarithm is infinite at 0 where albedo = 1; what is left out is less than 1e-13.
  const double integral = boost::math::quadrature::tanh_sinh<double>().integrate(
      integrand, 1e-15, std::numbers::pi / 2);
  return std::exp(-mu / std::numbers::pi * integral);
}

} // namespace vdbeam::slab
