#include "math/ray.h"
#include "math/rng.h"
#include "phase/draine.h"
#include "phase/phase_function.h"
#include "phase/truncated_phase.h"
#include "support/chi_squared.h"
#include "vdbeam/error.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <numbers>

namespace vdbeam {
namespace {

PhaseSettings henyey_greenstein(double g) {
  PhaseSettings settings;
  settings.type = PhaseType::henyey_greenstein;
  settings.g = g;
  return settings;
}

PhaseSettings two_lobe(double g, double g2, double blend) {
  PhaseSettings settings;
  settings.type = PhaseType::two_lobe;
  settings.g = g;
  settings.g2 = g2;
  settings.blend = blend;
  return settings;
}

PhaseSettings mie(double diameter) {
  PhaseSettings settings;
  settings.type = PhaseType::mie;
  settings.droplet_diameter = diameter;
  return settings;
}

PhaseSettings rayleigh() {
  PhaseSettings settings;
  settings.type = PhaseType::rayleigh;
  return settings;
}

std::vector<PhaseSettings> all_models() {
  std::vector<PhaseSettings> models{PhaseSettings{}, rayleigh()};
  for (const double g : {-0.999, -0.9, -0.3, -1e-3, -1e-5, 0.0, 1e-8, 1e-4, 0.1, 0.6, 0.95, 0.999})
    models.push_back(henyey_greenstein(g));
  models.push_back(two_lobe(0.9, -0.4, 0.3));
  models.push_back(two_lobe(0.999, 0.0, 0.5));
  for (const double diameter : {5.0, 10.0, 20.0, 50.0})
    models.push_back(mie(diameter));
  return models;
}

std::string name_of(const PhaseSettings& s) {
  return fmt::format("type {} g {} g2 {} blend {} diameter {}", s.type.name, s.g, s.g2, s.blend,
                     s.droplet_diameter);
}

// The blend of Draine lobes (Draine 2003, eq. 4) in double at 1 - cos = x, or at 1 + cos = x.
double formula(const PhaseFunction& phase, double x, bool from_back) {
  double sum = 0;
  for (int i = 0; i < phase.lobe_count(); ++i) {
    const DraineLobe& lobe = phase.lobe(i);
    const double g = from_back ? -lobe.g : lobe.g, alpha = lobe.alpha;
    const double d = (1 - g) * (1 - g) + 2 * g * x;
    sum += lobe.weight / (4 * std::numbers::pi) * (1 - g * g) / std::pow(d, 1.5) *
           (1 + alpha * (1 - x) * (1 - x)) / (1 + alpha * (1 + 2 * g * g) / 3);
  }
  return sum;
}

// Integral over the sphere of p f(cos): the midpoint rule on log(x) from each pole to the equator,
// so that peaks are resolved. `value` is a function of x and the pole.
template <class Value, class F>
double integrate(Value value, F f) {
  constexpr int steps = 20000;
  const double low = std::log(1e-12);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = std::exp(low * (1 - (i + 0.5) / steps));
    const double dx = x * -low / steps;
    sum += (value(x, false) * f(1 - x) + value(x, true) * f(x - 1)) * dx;
  }
  return sum * 2 * std::numbers::pi;
}

/// The others are even functions of the cosine.
double mean_cosine(const PhaseFunction& phase) {
  return phase.lobe_count() > 0 ? legendre_moments(phase, 2)[1] : 0;
}

TEST(PhaseFunction, IntegratesToOne) {
  for (const PhaseSettings& settings : all_models()) {
    const PhaseFunction phase(settings);
    const auto value = [&](double x, bool from_back) { return formula(phase, x, from_back); };
    EXPECT_NEAR(integrate(value, [](double) { return 1.0; }), 1, 1e-6) << name_of(settings);
    EXPECT_NEAR(integrate(value, [](double mu) { return mu; }), mean_cosine(phase), 1e-6)
        << name_of(settings);
  }
}

// With the test above: `evaluate` integrates to 1. It cannot be integrated itself where the peak is
// narrower than the spacing of single-precision cosines.
TEST(PhaseFunction, ValueIsTheFormula) {
  for (const PhaseSettings& settings : all_models()) {
    const PhaseFunction phase(settings);
    for (int i = 0; i <= 4000; ++i) {
      const float mu = std::sin(pi / 2 * static_cast<float>(i - 2000) / 2000);
      const double x = mu > 0 ? 1 - static_cast<double>(mu) : 1 + static_cast<double>(mu);
      const double expected = formula(phase, x, mu <= 0);
      EXPECT_NEAR(phase.evaluate(mu), expected, 2e-6 * expected) << name_of(settings) << mu;
    }
  }
}

TEST(PhaseFunction, ValueIntegratesToOneWhereCosinesResolveIt) {
  std::vector<PhaseSettings> models{PhaseSettings{}, rayleigh(), two_lobe(0.9, -0.4, 0.3), mie(5)};
  for (const double g : {-0.95, -0.5, -1e-4, 1e-6, 0.3, 0.7, 0.95})
    models.push_back(henyey_greenstein(g));
  for (const PhaseSettings& settings : models) {
    const PhaseFunction phase(settings);
    const auto value = [&](double x, bool from_back) -> double {
      return phase.evaluate(static_cast<float>(from_back ? x - 1 : 1 - x));
    };
    EXPECT_NEAR(integrate(value, [](double) { return 1.0; }), 1, 1e-5) << name_of(settings);
  }
}

TEST(PhaseFunction, HenyeyGreensteinIsTheClosedForm) {
  for (const double g : {-0.9, -0.2, 0.0, 0.5, 0.85})
    for (const double mu : {-1.0, -0.5, 0.0, 0.3, 0.99, 1.0}) {
      const double expected =
          (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * mu, 1.5));
      const float value = PhaseFunction(henyey_greenstein(g)).evaluate(static_cast<float>(mu));
      EXPECT_NEAR(value, expected, 2e-6 * expected) << g << " " << mu;
    }
}

TEST(PhaseFunction, RayleighIsTheClosedForm) {
  const PhaseFunction phase(rayleigh());
  for (const float mu : {-1.0f, -0.4f, 0.0f, 0.7f, 1.0f})
    EXPECT_NEAR(phase.evaluate(mu), 3 / (16 * pi) * (1 + mu * mu), 1e-7);
}

// Jendersie and d'Eon 2023, eqs. 4-7, computed separately for 5 and 20 micrometres.
TEST(PhaseFunction, MieParametersAreThePublishedFit) {
  const PhaseFunction small(mie(5)), large(mie(20));
  EXPECT_NEAR(small.lobe(0).g, 0.970678, 2e-6);
  EXPECT_NEAR(small.lobe(1).g, 0.508342, 2e-6);
  EXPECT_NEAR(small.lobe(1).alpha, 17.06810, 2e-5);
  EXPECT_NEAR(small.lobe(1).weight, 0.447829, 2e-6);
  EXPECT_NEAR(large.lobe(0).g, 0.994610, 2e-6);
  EXPECT_NEAR(large.lobe(1).g, 0.593791, 2e-6);
  EXPECT_NEAR(large.lobe(1).alpha, 27.11369, 2e-5);
  EXPECT_NEAR(large.lobe(1).weight, 0.498159, 2e-6);
  for (const PhaseFunction& phase : {small, large})
    EXPECT_FLOAT_EQ(phase.lobe(0).weight + phase.lobe(1).weight, 1);
  EXPECT_GT(mean_cosine(small), 0.8);
  EXPECT_LT(mean_cosine(large), 0.9);
}

TEST(PhaseFunction, StaysFiniteAtTheExtremes) {
  for (const double g : {-0.9999999, -0.999, 0.0, 0.999, 0.9999999}) {
    const PhaseFunction phase(henyey_greenstein(g));
    for (const float mu : {-1.0000002f, -1.0f, 0.0f, 1.0f, 1.0000002f}) {
      EXPECT_TRUE(std::isfinite(phase.evaluate(mu))) << g << " " << mu;
      EXPECT_GE(phase.evaluate(mu), 0) << g << " " << mu;
    }
    for (const float u : {0.0f, 0.5f, 1 - 0x1p-24f}) {
      const Vec3f out = phase.sample({0, 0, -1}, u, u, u);
      EXPECT_NEAR(length(out), 1, 1e-6) << g << " " << u;
    }
  }
}

// Bins of equal probability between cosines found by integrating `evaluate` over the angle.
double sampling_p_value(const PhaseFunction& phase, std::uint64_t stream) {
  constexpr int fine = 4000, bins = 60, samples = 60000;
  // Cumulative mass over theta, stretched towards the poles.
  std::vector<double> edge_mu{-1.0}, mass{0.0};
  for (int i = 0; i < fine; ++i) {
    const double t = (i + 1.0) / fine, t0 = static_cast<double>(i) / fine;
    const auto cosine = [](double s) {
      return -std::cos(std::numbers::pi * s * s * s * (s * (6 * s - 15) + 10));
    };
    const double a = cosine(t0), b = cosine(t);
    double part = 0; // 8-point midpoint
    for (int k = 0; k < 8; ++k)
      part += static_cast<double>(phase.evaluate(static_cast<float>(a + (k + 0.5) / 8 * (b - a))));
    mass.push_back(mass.back() + part / 8 * (b - a) * 2 * std::numbers::pi);
    edge_mu.push_back(b);
  }
  std::vector<double> edges, expected, counts(bins, 0.0);
  double last = 0;
  for (std::size_t i = 1; i < mass.size(); ++i)
    if (mass[i] / mass.back() - last >= 1.0 / bins && static_cast<int>(edges.size()) < bins - 1) {
      edges.push_back(edge_mu[i]);
      expected.push_back((mass[i] / mass.back() - last) * samples);
      last = mass[i] / mass.back();
    }
  expected.push_back((1 - last) * samples);
  counts.resize(expected.size());
  Rng rng({}, RngStage::test, stream);
  const Vec3f direction = normalize(Vec3f{0.3f, -0.8f, 0.5f});
  for (int i = 0; i < samples; ++i) {
    const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    const double mu = dot(direction, phase.sample(direction, u_lobe, u, v));
    counts[std::upper_bound(edges.begin(), edges.end(), mu) - edges.begin()] += 1;
  }
  return test::chi_squared_test(counts, expected);
}

TEST(PhaseFunction, SamplesFollowTheValue) {
  std::vector<PhaseSettings> models{PhaseSettings{}, rayleigh(), two_lobe(0.8, -0.4, 0.3), mie(5),
                                    mie(10)};
  for (const double g : {-0.95, -0.5, -1e-4, 1e-6, 0.3, 0.7, 0.95})
    models.push_back(henyey_greenstein(g));
  std::uint64_t stream = 0;
  for (const PhaseSettings& settings : models)
    EXPECT_GT(sampling_p_value(PhaseFunction(settings), stream++),
              test::family_level(static_cast<int>(models.size())))
        << name_of(settings);
}

TEST(PhaseFunction, AzimuthIsUniform) {
  const PhaseFunction phase(mie(20));
  constexpr int bins = 32, samples = 20000;
  std::vector<double> counts(bins, 0.0), expected(bins, static_cast<double>(samples) / bins);
  Rng rng({}, RngStage::test, 99);
  for (int i = 0; i < samples; ++i) {
    const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    const Vec3f out = phase.sample({0, 0, 1}, u_lobe, u, v);
    const double turn = std::atan2(out.y, out.x) / (2 * std::numbers::pi) + 0.5;
    counts[std::min(bins - 1, static_cast<int>(turn * bins))] += 1;
  }
  EXPECT_GT(test::chi_squared_test(counts, expected), 1e-3);
}

// The distribution function of the sampled angle, integrated in double, must be the number that
// drew it: exact where a float cosine does not resolve the peak.
TEST(PhaseFunction, DraineInversionIsExact) {
  for (const double g : {0.0, 1e-9, 1e-3, 0.5, 0.9, 0.999})
    for (const double alpha : {0.0, 0.5, 1.0, 20.0, 500.0})
      for (const double u : {1e-6, 0.01, 0.3, 0.5, 0.8, 0.999}) {
        const float x = sample_draine_one_minus_cos(
            static_cast<float>(g), static_cast<float>(alpha), static_cast<float>(u));
        const double gd = static_cast<float>(g), b = 1 - gd;
        constexpr int steps = 4000;
        const double top = std::log1p(x / (b * b));
        double sum = 0;
        for (int i = 0; i < steps; ++i) { // y = b^2 (e^t - 1) resolves the peak at any g
          const double e = std::exp((i + 0.5) / steps * top), y = b * b * (e - 1);
          const double d = b * b + 2 * gd * y, mu = 1 - y;
          sum += (1 - gd * gd) / 2 / (d * std::sqrt(d)) * (1 + alpha * mu * mu) * b * b * e * top /
                 steps;
        }
        sum /= 1 + alpha * (1 + 2 * gd * gd) / 3;
        EXPECT_NEAR(sum, static_cast<double>(static_cast<float>(u)), 2e-6)
            << g << " " << alpha << " " << u;
      }
}

TEST(PhaseFunction, KnowsWhenItIsIsotropic) {
  EXPECT_TRUE(PhaseFunction().isotropic());
  EXPECT_TRUE(PhaseFunction(henyey_greenstein(0)).isotropic());
  EXPECT_TRUE(PhaseFunction(two_lobe(0.5, 0, 1)).isotropic());
  EXPECT_FALSE(PhaseFunction(rayleigh()).isotropic());
  EXPECT_FALSE(PhaseFunction(two_lobe(0.5, 0, 0.9)).isotropic());
  EXPECT_EQ(PhaseFunction(two_lobe(0.5, 0.2, 0)).lobe_count(), 1);
  EXPECT_EQ(PhaseFunction(two_lobe(0.5, 0.2, 0)).lobe(0).g, 0.5f);
  EXPECT_EQ(PhaseFunction(two_lobe(0.5, 0.2, 1)).lobe(0).g, 0.2f);
  EXPECT_EQ(PhaseFunction().lobe(0).weight, 1);
}

TEST(PhaseFunction, RefusesParametersOutOfRange) {
  EXPECT_THROW(PhaseFunction(henyey_greenstein(1)), InputError);
  EXPECT_THROW(PhaseFunction(henyey_greenstein(0.99999999999)), InputError);
  EXPECT_THROW(PhaseFunction(two_lobe(0, -1.5, 0.5)), InputError);
  EXPECT_THROW(PhaseFunction(two_lobe(0, 0.5, 1.5)), InputError);
  EXPECT_THROW(PhaseFunction(mie(4)), InputError);
  EXPECT_THROW(PhaseFunction(mie(std::nan(""))), InputError);
}

} // namespace
} // namespace vdbeam
