// Planes, boxes and cylinders.
#include "geometry/surface_set.h"

#include "math/rng.h"
#include "math/sampling.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

Affine placed(double scale, const Vec3d& at) {
  Affine map;
  map.rows = {Vec3d{scale, 0, 0}, Vec3d{0, scale, 0}, Vec3d{0, 0, scale}};
  map.translation = at;
  return map;
}

Affine stretched() {
  Affine map;
  map.rows = {Vec3d{2, 0, 0}, Vec3d{0, 1, 0.5}, Vec3d{0, 0, 3}};
  return map;
}

Vec3d direction(Rng& rng) {
  const float u = rng.uniform(), v = rng.uniform();
  return Vec3d(sample_sphere(u, v));
}

class Solids : public ::testing::TestWithParam<SurfaceShape> {};

/// Rays from the inside, many of them straight at edges and corners, meet the shape from the back,
/// at a point of it.
TEST_P(Solids, LetNoRayOut) {
  const auto shape = make_simple_shape(GetParam());
  const SurfaceSet set({{shape, placed(0.7, {0.3, -0.2, 0.1})}}, 2);
  Rng rng({}, RngStage::test, 1);
  for (int i = 0; i < 100000; ++i) {
    const Vec3d origin = Vec3d{0.3, -0.2, 0.1} + direction(rng) * 0.5;
    Vec3d aim = direction(rng);
    if (i % 2 == 0)
      for (int a = 0; a < 3; ++a)
        aim[a] = std::round(aim[a] * 1.2) + (i % 4 == 0 ? 0 : 1e-17);
    if (!(length(aim) > 0))
      continue;
    const Vec3d towards = normalize(aim * 0.7 + Vec3d{0.3, -0.2, 0.1} - origin);
    const auto hit = set.intersect(origin, towards, 0, 100);
    ASSERT_TRUE(hit) << i;
    EXPECT_GT(dot(Vec3d(hit->normal), towards), 0);
    const Vec3d p = (hit->position - Vec3d{0.3, -0.2, 0.1}) / 0.7;
    const double across = GetParam() == SurfaceShape::box ? std::max(std::abs(p.x), std::abs(p.y))
                                                          : std::hypot(p.x, p.y);
    ASSERT_NEAR(std::max(across, std::abs(p.z)), 1, 1e-12);
  }
}

/// From outside, a ray that meets it enters where it would have been left the other way.
TEST_P(Solids, AreMetFromBothSides) {
  const SurfaceSet set({{make_simple_shape(GetParam()), stretched()}}, 20);
  Rng rng({}, RngStage::test, 2);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d from = direction(rng) * 9, to = direction(rng) * 3 - direction(rng);
    const Vec3d towards = normalize(to - from);
    const auto first = set.intersect(from, towards, 0, 100);
    const auto back = set.intersect(from + towards * 40.0, -towards, 0, 100);
    ASSERT_EQ(first.has_value(), back.has_value());
    if (!first)
      continue;
    ++hits;
    EXPECT_LT(dot(Vec3d(first->normal), towards), 0);
    const auto second = set.intersect(first->leave(Vec3f(towards)), towards, 0, 100);
    if (second) {
      EXPECT_NEAR(length(second->position - back->position), 0, 1e-6);
    }
    EXPECT_EQ(set.occluded(from, towards, 0, 100), true);
  }
  EXPECT_GT(hits, 5000);
}

/// Points are drawn evenly by area, the mean normal of a closed surface is 0, and a point that is
/// looked up has the place by which it was drawn.
TEST_P(Solids, AreSampledByArea) {
  const SurfaceSet set({{make_simple_shape(GetParam()), stretched()}}, 5);
  test::Samples area;
  std::array<test::Samples, 3> closed;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Rng rng({}, RngStage::test, i);
    const double share = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    const SurfacePoint point = set.sample(0, share, u, v);
    area.add(1 / static_cast<double>(point.pdf));
    for (int a = 0; a < 3; ++a)
      closed[static_cast<std::size_t>(a)].add(static_cast<double>(point.normal[a] / point.pdf));
    ASSERT_NEAR(set.sample_pdf(0, point.normal) / point.pdf, 1, 1e-4);
    EXPECT_NEAR(set.distance(point.position, 1), 0, 1e-6);
    const std::size_t primitive = i % set.primitives(0);
    const AreaPlace place = set.place_of(0, primitive, set.sample(0, primitive, {u, v}).position);
    EXPECT_NEAR(place.u, u, 1e-6);
    EXPECT_NEAR(place.v, v, 1e-6);
  }
  test::expect_mean(area, set.area(0), 1e-3 * set.area(0));
  for (const test::Samples& axis : closed)
    test::expect_mean(axis, 0);
}

/// A box's faces have closed areas; of an even cylinder all is known.
TEST(SimpleShapes, Areas) {
  const auto box = make_simple_shape(SurfaceShape::box);
  const SurfaceSet boxes({{box, stretched()}, {box, placed(0.5, {1, 2, 3})}}, 5);
  // Edges 4 along x, 2 along y, and (0, 1, 6): parallelograms of 8, 4 sqrt(37) and 12.
  EXPECT_NEAR(boxes.area(0), 2 * (8 + 4 * std::sqrt(37.0) + 12), 1e-9);
  EXPECT_NEAR(boxes.area(1), 6, 1e-9);
  const SurfaceSet tube({{make_simple_shape(SurfaceShape::cylinder), placed(2, {0, 0, 0})}}, 5);
  EXPECT_NEAR(tube.area(0), 4 * 6 * M_PI, 1e-9);
}

TEST_P(Solids, DistancesAreThoseOfTheNearestPoint) {
  const SurfaceSet set({{make_simple_shape(GetParam()), placed(0.5, {0.1, 0.2, -0.1})}}, 2);
  Rng rng({}, RngStage::test, 7);
  std::vector<Vec3d> points;
  for (int i = 0; i < 150000; ++i) {
    const double u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
    points.push_back(set.sample(0, u, v, w).position);
  }
  for (int i = 0; i < 100; ++i) {
    const Vec3d p = direction(rng) * (1.2 * static_cast<double>(rng.uniform()));
    double nearest = 10;
    for (const Vec3d& point : points)
      nearest = std::min(nearest, length(point - p));
    const double distance = set.distance(p, 10);
    EXPECT_LE(distance, nearest + 1e-12);
    EXPECT_GT(distance, nearest - 0.02); // the points lie about 0.005 apart
  }
}

/// Seen from in front of it, each face of a box shows the picture upright: u grows to the right.
TEST(SimpleShapes, FacesOfABoxShowTheWholePicture) {
  const SurfaceSet set({{make_simple_shape(SurfaceShape::box), {}, true, true}}, 5);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3d way{}, up{0, 0, 1};
      way[axis] = -side;
      if (axis == 2)
        up = {0, 1, 0};
      const Vec3d right = cross(way, up);
      const auto hit = set.intersect(way * -5.0 + right * 0.5 + up * 0.25, way, 0, 10);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->uv.u, 0.75, 1e-6) << axis << " " << side;
      EXPECT_NEAR(hit->uv.v, 0.625, 1e-6) << axis << " " << side;
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Solids,
                         ::testing::Values(SurfaceShape::box, SurfaceShape::cylinder),
                         [](const auto& shape) {
                           return shape.param == SurfaceShape::box ? "box" : "cylinder";
                         });

TEST(Planes, AreMetUpToTheHorizon) {
  const SurfaceSet set({{make_simple_shape(SurfaceShape::plane), placed(3, {5, -7, -1.5})}}, 2);
  EXPECT_TRUE(set.bounds().empty());
  EXPECT_TRUE(set.is_infinite(0));
  for (const double height : {1e-3, 1.7, 3000.0, 1e7})
    for (const double slope : {1.0, 1e-3, 1e-6, 1e-8}) {
      const Vec3d towards = normalize(Vec3d{0.6, 0.8, -slope});
      const auto hit = set.intersect({0, 0, height - 1.5}, towards, 0, 1e30);
      ASSERT_TRUE(hit) << height << " " << slope;
      EXPECT_NEAR(hit->t * -towards.z / height, 1, 1e-9);
      EXPECT_EQ(hit->normal.z, 1);
      // A ray that leaves it upward meets nothing, one that goes down is met at once.
      EXPECT_FALSE(set.occluded(hit->leave({0, 0, 1}), {0.6, 0, 0.8}, 0, 1e30));
      EXPECT_FALSE(set.intersect({0, 0, height - 1.5}, {towards.x, towards.y, slope}, 0, 1e30));
    }
  EXPECT_FALSE(set.intersect({0, 0, 5}, {0.6, 0.8, 0}, 0, 1e30));
  EXPECT_FALSE(set.intersect({0, 0, 5}, {0.6, 0.8, -1e-12}, 0, 1e30));
  EXPECT_NEAR(set.distance({100, 3, 2}, 10), 3.5, 1e-12);
  EXPECT_NEAR(set.distance({100, 3, 2}, 1), 1, 1e-12);
}

/// Planes and other shapes are one set: the nearest counts, and an unseen plane does not hide.
TEST(Planes, StandAmongOtherShapes) {
  const auto plane = make_simple_shape(SurfaceShape::plane);
  const auto ball = make_simple_shape(SurfaceShape::sphere);
  const SurfaceSet set({{ball, placed(0.5, {0, 0, 0.5})}, {plane, {}}, {plane, {}, false}}, 2);
  EXPECT_EQ(set.intersect({0, 0, 9}, {0, 0, -1}, 0, 100)->surface, 0);
  EXPECT_EQ(set.intersect({2, 0, 9}, {0, 0, -1}, 0, 100)->surface, 1);
  EXPECT_EQ(set.intersect({2, 0, -9}, {0, 0, 1}, 0, 100, true)->surface, 1);
  const SurfaceSet unseen({{plane, {}, false}, {ball, placed(0.5, {0, 0, -3})}}, 2);
  EXPECT_EQ(unseen.intersect({0, 0, 9}, {0, 0, -1}, 0, 100, true)->surface, 1);
  EXPECT_EQ(unseen.intersect({0, 0, 9}, {0, 0, -1}, 0, 100)->surface, 0);
  EXPECT_TRUE(unseen.occluded({3, 0, 9}, {0, 0, -1}, 0, 100));
  EXPECT_NEAR(unseen.distance({0, 0, -2}, 9), 0.5, 1e-6);
}

TEST(Planes, RepeatThePictureByUnits) {
  const SurfaceSet set({{make_simple_shape(SurfaceShape::plane), placed(2, {0, 0, 0}), true, true}},
                       2);
  const auto uv = [&](double x, double y) {
    return set.intersect({x, y, 1}, {0, 0, -1}, 0, 10)->uv;
  };
  EXPECT_NEAR(uv(0.5, 1).u, 0.25, 1e-6);
  EXPECT_NEAR(uv(0.5, 1).v, 0.5, 1e-6);
  // Far away the same texel, with the parity that mirrored pictures need, and on the same side.
  for (const double far : {4e6, -4e6}) {
    const double u = static_cast<double>(uv(far + 0.5, 0).u);
    EXPECT_NEAR(u - 2 * std::floor(u / 2), 0.25, 1e-6);
    EXPECT_GT(u * far, 0);
    EXPECT_GT(std::abs(u), 1);
  }
}

} // namespace
} // namespace vdbeam
