#pragma once

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace vdbeam::test {

/// Mean and standard error of samples added one by one (Welford 1962).
class Samples {
public:
  void add(double value) {
    ++count_;
    const double delta = value - mean_;
    mean_ += delta / static_cast<double>(count_);
    squares_ += delta * (value - mean_);
  }
  std::size_t count() const { return count_; }
  double mean() const { return mean_; }
  double variance() const {
    return count_ > 1 ? squares_ / static_cast<double>(count_ - 1) : INFINITY;
  }
  double error() const { return std::sqrt(variance() / static_cast<double>(count_)); }

private:
  std::size_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

/// How many standard errors, estimated from `count` samples, a mean may stray with the chance by
/// which a normal variable strays 4 standard deviations (6.3e-5): a quantile of Student's t.
inline double student_limit(std::size_t count) {
  const double chance = cdf(complement(boost::math::normal(), 4.0));
  return quantile(complement(boost::math::students_t(static_cast<double>(count) - 1), chance));
}

/// The mean is `expected` up to 4 standard errors and a `bias` bound; `least_error` is the rounding
/// that even a noise-free estimate has.
inline void expect_mean(const Samples& samples, double expected, double bias = 0,
                        double least_error = 1e-6) {
  const double allowed =
      student_limit(samples.count()) * samples.error() + bias + least_error * std::abs(expected);
  EXPECT_LE(std::abs(samples.mean() - expected), allowed)
      << "mean " << samples.mean() << ", expected " << expected << ", standard error "
      << samples.error() << ", bias bound " << bias;
}

/// The standard error is small enough for the test to see what it is meant to see: without such a
/// guard a defect that makes noise widens the limits of its own test.
inline void expect_power(const Samples& samples, double largest_error) {
  EXPECT_LT(samples.error(), largest_error) << "mean " << samples.mean() << ": too noisy";
}

/// Two independent means agree.
inline void expect_same_mean(const Samples& a, const Samples& b, double bias = 0) {
  const double error = std::hypot(a.error(), b.error());
  const double limit = student_limit(std::min(a.count(), b.count()));
  EXPECT_LE(std::abs(a.mean() - b.mean()), limit * error + bias + 1e-6 * std::abs(b.mean()))
      << a.mean() << " +- " << a.error() << " and " << b.mean() << " +- " << b.error()
      << ", bias bound " << bias;
}

} // namespace vdbeam::test
