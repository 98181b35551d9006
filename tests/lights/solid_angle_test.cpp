#include "lights/solid_angle.h"

#include "math/ray.h"
#include "math/rng.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

/// 2 wide, 3 high, in the plane z = 1, its front down.
const Rectangle rectangle{{-0.5, -1, 1}, {2, 0, 0}, {0, 3, 0}, {0, 0, -1}};

/// Integral over the rectangle's solid angle of a function of the direction, by area.
template <class Function>
double integral(const Rectangle& r, const Vec3d& from, const Function& f) {
  constexpr int steps = 600;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const Vec3d to =
          r.corner + r.edge_x * ((i + 0.5) / steps) + r.edge_y * ((j + 0.5) / steps) - from;
      const double d = length(to);
      sum += f(to / d) * std::abs(dot(to, r.normal)) / (d * d * d);
    }
  return sum * length(r.edge_x) * length(r.edge_y) / (steps * steps);
}

TEST(SolidAngle, of_a_square_from_above_its_middle) {
  // 4 asin(a^2 / (a^2 + h^2)) of half side a at height h.
  const Rectangle square{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  for (const double height : {0.01, 0.5, 1.0, 20.0})
    for (const double side : {1.0, -1.0})
      EXPECT_NEAR(square.solid_angle({0, 0, side * height}) /
                      (4 * std::asin(1 / (1 + height * height))),
                  1, 1e-9)
          << height;
  EXPECT_EQ(square.solid_angle({0.2, 0.1, 0}), 0) << "from its own plane";
  EXPECT_EQ(square.solid_angle({0, 0, 1e5}), 0) << "too far: by area";
}

TEST(SolidAngle, of_a_ball) {
  const Ball ball{{1, 2, 3}, 0.5};
  EXPECT_NEAR(ball.solid_angle({1, 2, 4}), 2 * M_PI * (1 - std::sqrt(0.75)), 1e-12);
  EXPECT_NEAR(ball.solid_angle({1, 2, 1e6}) * 1e12 / (M_PI * 0.25), 1, 1e-4);
  EXPECT_EQ(ball.solid_angle({1, 2.2, 3}), 0) << "from inside";
}

/// Means of functions of the direction, over what is drawn and by quadrature over the area.
TEST(SolidAngle, rectangles_are_drawn_evenly) {
  for (const Vec3d& from :
       {Vec3d{0.2, 0.3, 0}, Vec3d{4, -3, 0.5}, Vec3d{0.5, 0.5, 0.95}, Vec3d{0, 0, 3}}) {
    const double whole = rectangle.solid_angle(from);
    EXPECT_NEAR(whole / integral(rectangle, from, [](const Vec3d&) { return 1.0; }), 1, 1e-3);
    std::array<test::Samples, 5> means;
    const auto functions = [](const Vec3d& w) {
      return std::array<double, 5>{w.x, w.y, w.z, w.x * w.x, w.x * w.y};
    };
    Rng rng({}, RngStage::test, 1);
    for (int i = 0; i < 20000; ++i) {
      const double u = static_cast<double>(rng.uniform()), v = static_cast<double>(rng.uniform());
      const auto point = rectangle.sample(from, u, v);
      ASSERT_TRUE(point);
      EXPECT_NEAR(point->pdf * whole, 1, 1e-12);
      const Vec3d at = from + point->wi * point->distance;
      EXPECT_NEAR(at.z, 1, 1e-9);
      EXPECT_TRUE(at.x > -0.5 - 1e-6 && at.x < 1.5 + 1e-6 && at.y > -1 - 1e-6 && at.y < 2 + 1e-6);
      const auto values = functions(point->wi);
      for (std::size_t k = 0; k < values.size(); ++k)
        means[k].add(values[k]);
    }
    for (std::size_t k = 0; k < means.size(); ++k)
      test::expect_mean(
          means[k],
          integral(rectangle, from, [&](const Vec3d& w) { return functions(w)[k]; }) / whole, 1e-3);
  }
}

TEST(SolidAngle, balls_are_drawn_evenly_on_their_near_side) {
  const Ball ball{{0, 0, 3}, 1};
  for (const double distance : {1.001, 2.0, 1e4}) {
    const Vec3d from{0, 0, 3 - distance};
    test::Samples rise, across;
    const double whole = ball.solid_angle(from);
    Rng rng({}, RngStage::test, 2);
    for (int i = 0; i < 20000; ++i) {
      const double u = static_cast<double>(rng.uniform()), v = static_cast<double>(rng.uniform());
      const auto point = ball.sample(from, u, v);
      ASSERT_TRUE(point);
      const Vec3d at = from + point->wi * point->distance;
      EXPECT_NEAR(length(at - ball.center), 1, 1e-6 * distance);
      EXPECT_LE(dot(point->normal, point->wi), 1e-6) << "the near side";
      // 1 - cos is uniform up to the rim.
      rise.add(2 * M_PI * dot(point->wi - Vec3d{0, 0, 1}, point->wi - Vec3d{0, 0, 1}) / 2 / whole);
      across.add(point->wi.x * point->wi.y);
    }
    test::expect_mean(rise, 0.5);
    test::expect_mean(across, 0);
  }
}

} // namespace
} // namespace vdbeam
