#include "geometry/surface_set.h"

#include "math/rng.h"
#include "math/sampling.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace vdbeam {
namespace {

Affine placed(double scale, const Vec3d& at) {
  Affine map;
  map.rows = {Vec3d{scale, 0, 0}, Vec3d{0, scale, 0}, Vec3d{0, 0, scale}};
  map.translation = at;
  return map;
}

/// A sphere's surface of triangles, n x 2 n patches.
Mesh ball(int n) {
  RawMesh raw;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double theta = M_PI * i / n, phi = M_PI * j / n;
      raw.positions.push_back(
          {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(i * 2 * n + j % (2 * n)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      raw.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      raw.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return repair_mesh(raw, "ball");
}

Vec3d direction(Rng& rng) {
  const float u = rng.uniform(), v = rng.uniform();
  return Vec3d(sample_sphere(u, v));
}

TEST(SurfaceSet, meets_what_a_search_of_all_triangles_meets) {
  const auto mesh = make_mesh_shape(ball(12));
  std::vector<PlacedShape> surfaces{{mesh, placed(0.3, {0.4, 0, 0})},
                                    {mesh, placed(0.2, {-0.2, 0.1, 0.3})},
                                    {make_simple_shape(SurfaceShape::quad), placed(1, {0, 0, -1})}};
  const SurfaceSet set(surfaces, 2);
  Rng rng({}, RngStage::test, 0);
  int hits = 0;
  for (int ray = 0; ray < 3000; ++ray) {
    const Vec3d origin = direction(rng) * 1.5, towards = normalize(direction(rng) * 0.4 - origin);
    double nearest = 100;
    int surface = -1;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const Affine back = surfaces[s].to_render.inverse();
      for (std::size_t i = 0; i < surfaces[s].shape->primitives(); ++i)
        if (const auto hit = surfaces[s].shape->intersect(i, back.point(origin),
                                                          back.vector(towards), 0, nearest)) {
          nearest = hit->t;
          surface = static_cast<int>(s);
        }
    }
    const auto hit = set.intersect(origin, towards, 0, 100);
    ASSERT_EQ(hit.has_value(), surface >= 0);
    hits += surface >= 0;
    if (hit) {
      EXPECT_EQ(hit->surface, surface);
      EXPECT_NEAR(hit->t, nearest, 1e-12);
    }
  }
  EXPECT_GT(hits, 500);
}

/// What a scene of this scale and place does to rays that bounce about inside a closed box, and to
/// such that leave a sphere outwards.
struct Place {
  double scale;
  Vec3d at;
};
class SelfIntersection : public ::testing::TestWithParam<Place> {};

TEST_P(SelfIntersection, rays_do_not_meet_the_point_they_leave_nor_slip_through) {
  const auto& [scale, at] = GetParam();
  std::vector<PlacedShape> surfaces;
  const auto quad = make_simple_shape(SurfaceShape::quad);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Affine map;
      Vec3d shift;
      shift[axis] = side;
      Vec3d u, v, w;
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = 1;
      w[axis] = 1;
      for (int row = 0; row < 3; ++row)
        map.rows[row] = Vec3d{u[row], v[row], w[row]} * scale;
      map.translation = at + shift * scale;
      surfaces.push_back({quad, map});
    }
  surfaces.push_back({make_mesh_shape(ball(10)), placed(0.4 * scale, at)});
  const SurfaceSet box(surfaces, scale);
  Rng rng({}, RngStage::test, 1);
  Vec3d origin = at + Vec3d(0.7 * scale);
  for (int bounce = 0; bounce < 200000; ++bounce) {
    const Vec3f towards(direction(rng));
    const auto hit = box.intersect(origin, Vec3d(towards), 0, 100 * scale);
    ASSERT_TRUE(hit) << "slipped out after " << bounce;
    const float side = dot(hit->normal, towards);
    ASSERT_FALSE(hit->surface == 6 && side > 0) << "inside of the ball";
    origin = hit->leave(-towards);
    if (bounce % 100 == 0)
      origin = hit->leave(hit->normal * (side > 0 ? -1.0f : 1.0f));
  }
}

INSTANTIATE_TEST_SUITE_P(Places, SelfIntersection,
                         ::testing::Values(Place{1, {0, 0, 0}}, Place{1e-3, {0, 0, 0}},
                                           Place{1e4, {0, 0, 0}}, Place{1, {100, -50, 20}},
                                           Place{1e-3, {1, 1, 1}}));

TEST(SurfaceSet, huge_triangles_stop_rays_that_start_close_by) {
  RawMesh raw;
  raw.positions = {{-1e6, 0, -1e6}, {1e6, 0, -1e6}, {1e6, 0, 1e6}, {-1e6, 0, 1e6}};
  raw.triangles = {{0, 2, 1}, {0, 3, 2}};
  const SurfaceSet set({{make_mesh_shape(repair_mesh(raw, "ground")), {}}}, 10);
  Rng rng({}, RngStage::test, 2);
  for (int i = 0; i < 20000; ++i) {
    const float height = std::exp(-15 * rng.uniform());
    const Vec3d origin{rng.uniform(), height, rng.uniform()};
    Vec3f towards(direction(rng));
    towards.y = -std::abs(towards.y) - 1e-3f;
    towards = normalize(towards);
    const auto hit = set.intersect(origin, Vec3d(towards), 0, 1e9);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t * static_cast<double>(-towards.y), static_cast<double>(height), 1e-9);
    const Vec3f back{towards.x, -towards.y, towards.z};
    EXPECT_FALSE(set.occluded(hit->leave(back), Vec3d(back), 0, 1e9));
  }
}

TEST(SurfaceSet, a_closed_mesh_lets_no_ray_out) {
  const SurfaceSet set({{make_mesh_shape(ball(40)), {}}}, 2);
  for (std::uint64_t i = 0; i < 300000; ++i) {
    Rng rng({}, RngStage::test, i);
    const Vec3d origin = direction(rng) * 0.5;
    ASSERT_TRUE(set.intersect(origin, direction(rng), 0, 10));
  }
}

/// A wavy sheet of triangles between the planes z = -0.1 and 0.1.
Mesh sheet(int n) {
  RawMesh raw;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      raw.positions.push_back({2.0 * i / n - 1, 2.0 * j / n - 1, 0.1 * std::sin(i) * std::cos(j)});
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      raw.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      raw.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return repair_mesh(raw, "sheet");
}

/// VDBEAM_LEAK_RAYS asks for more rays than a test has time for.
TEST(SurfaceSet, no_ray_leaks_through_a_sheet) {
  const SurfaceSet set({{make_mesh_shape(sheet(50)), placed(0.7, {0.3, 0.2, 0.1})}}, 2);
  const char* wanted = std::getenv("VDBEAM_LEAK_RAYS");
  const std::uint64_t rays = wanted ? std::strtoull(wanted, nullptr, 10) : 500000;
  std::uint64_t leaks = 0;
  for (std::uint64_t i = 0; i < rays; ++i) {
    Rng rng({}, RngStage::test, i);
    const auto point = [&](double z) {
      const double x = static_cast<double>(rng.uniform()), y = static_cast<double>(rng.uniform());
      return Vec3d{0.3 + 0.6 * (2 * x - 1), 0.2 + 0.6 * (2 * y - 1), 0.1 + z};
    };
    const Vec3d above = point(0.3), to = point(-0.3) - above;
    const double distance = length(to);
    leaks += !set.occluded(above, to / distance, 0, distance);
  }
  EXPECT_EQ(leaks, 0u) << "of " << rays;
}

TEST(SurfaceSet, a_far_camera_meets_a_small_surface_where_it_is) {
  const SurfaceSet set({{make_simple_shape(SurfaceShape::sphere), placed(1e-3, {0, 0, 0})}}, 1);
  const Vec3d origin{0, 0, 1e6};
  const auto hit = set.intersect(origin, normalize(Vec3d{0.5e-3, 0, 0} - origin), 0, 1e9);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->position.x, 0.5e-3, 1e-9);
  EXPECT_FALSE(set.intersect(origin, normalize(Vec3d{1.1e-3, 0, 0} - origin), 0, 1e9));
}

/// Embree would end the program.
TEST(SurfaceSet, what_is_no_ray_meets_nothing) {
  const SurfaceSet set({{make_mesh_shape(sheet(4)), placed(0.7, {0.3, 0.2, 0.1})}}, 2);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinite = std::numeric_limits<double>::infinity();
  for (const double far : {1e19, 1e30, 1e300, nan, infinite}) {
    EXPECT_FALSE(set.intersect({0.3, 0.2, far}, {1, 0, 0}, 0, infinite)) << far;
    EXPECT_FALSE(set.intersect({far, 0.2, 0}, {0, 0, 1}, 0, infinite)) << far;
    EXPECT_FALSE(set.occluded({0.3, far, 1}, {0, 0, -1}, 0, 1)) << far;
  }
  EXPECT_FALSE(set.intersect({0.3, 0.2, 1}, {0, 0, 0}, 0, infinite));
  EXPECT_FALSE(set.intersect({0.3, 0.2, 1}, {0, nan, -1}, 0, infinite));
  EXPECT_TRUE(set.intersect({0.3, 0.2, 1}, {0, 0, -1}, 0, infinite));
  EXPECT_TRUE(set.intersect({0.3, 0.2, 1e12}, {0, 0, -1}, 0, infinite));
}

TEST(SurfaceSet, the_camera_passes_what_it_does_not_see) {
  const auto quad = make_simple_shape(SurfaceShape::quad);
  const SurfaceSet set({{quad, placed(1, {0, 0, 1}), false}, {quad, placed(1, {0, 0, 0})}}, 5);
  const Vec3d origin{0, 0, 3}, down{0, 0, -1};
  EXPECT_EQ(set.intersect(origin, down, 0, 10)->surface, 0);
  EXPECT_EQ(set.intersect(origin, down, 0, 10, true)->surface, 1);
  EXPECT_TRUE(set.occluded(origin, down, 0, 2.5));
  EXPECT_FALSE(set.occluded(origin, down, 0, 1.5));
}

/// The distance is the same whether a mesh is large in its file or made so, turned or not, and
/// costs looks at a few triangles only.
TEST(SurfaceSet, distances_do_not_depend_on_the_units_of_a_file) {
  const auto shape = make_mesh_shape(ball(60));
  const SurfaceSet plain({{shape, placed(1, {0, 0, 0})}}, 2);
  for (const double scale : {1e-3, 0.03, 0.3, 3.0, 700.0}) {
    const Vec3d at{0.1, -0.2, 0.3};
    const SurfaceSet set({{shape, placed(scale, at)}}, 2);
    for (std::uint64_t i = 0; i < 300; ++i) {
      Rng rng({}, RngStage::test, i);
      const Vec3d p = direction(rng) * (1.6 * static_cast<double>(rng.uniform()));
      const double expected = plain.distance(p, 10);
      EXPECT_NEAR(set.distance(at + p * scale, 10 * scale) / scale, expected, 1e-5) << scale;
      EXPECT_NEAR(set.distance(at + p * scale, 0.3 * scale) / scale, std::min(expected, 0.3), 1e-5);
    }
  }
}

/// A sphere hangs over flat ground: it is near where the distance says so, and the ground itself is
/// not. Triangles are never known to be flat.
TEST(SurfaceSet, knows_where_flat_surfaces_lie_alone) {
  const auto sphere = make_simple_shape(SurfaceShape::sphere);
  for (const SurfaceShape kind : {SurfaceShape::quad, SurfaceShape::disk, SurfaceShape::plane}) {
    const SurfaceSet set({{make_simple_shape(kind), placed(2, {0, 0, 0})},
                          {sphere, placed(0.3, {0, 0, 0.5})},
                          {make_mesh_shape(ball(4)), placed(0.1, {0.9, 0, 0})}},
                         2);
    EXPECT_TRUE(set.is_flat_and_alone(0, {0, 0, 0}, 0.19)) << static_cast<int>(kind);
    EXPECT_FALSE(set.is_flat_and_alone(0, {0, 0, 0}, 0.21)) << static_cast<int>(kind);
    EXPECT_FALSE(set.is_flat_and_alone(0, {0.95, 0, 0}, 0.2)) << static_cast<int>(kind);
    EXPECT_FALSE(set.is_flat_and_alone(1, {0, 0, 0.8}, 1e-3));
    EXPECT_FALSE(set.is_flat_and_alone(2, {1, 0, 0}, 1e-3));
    EXPECT_TRUE(set.holds(0, {1.3, 1.3, 0}));
    EXPECT_EQ(set.holds(0, {1.9, 1.9, 0}), kind != SurfaceShape::disk);
    EXPECT_EQ(set.holds(0, {2.1, 0, 0}), kind == SurfaceShape::plane);
  }
}

/// Against the nearest of many points on the surfaces; never more than the true distance.
TEST(SurfaceSet, distances_are_those_of_the_nearest_point) {
  Affine stretched = placed(0.3, {0.5, 0.2, -0.4});
  stretched.rows[0] = {0.5, 0.1, 0};
  const std::vector<PlacedShape> surfaces{
      {make_mesh_shape(ball(12)), stretched},
      {make_simple_shape(SurfaceShape::sphere), placed(0.2, {-0.4, 0.1, 0.3})},
      {make_simple_shape(SurfaceShape::quad), placed(0.4, {0, 0, -0.5})},
      {make_simple_shape(SurfaceShape::disk), placed(0.3, {0, -0.6, 0.2})}};
  const SurfaceSet set(surfaces, 2);
  Rng rng({}, RngStage::test, 7);
  std::vector<Vec3d> points;
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    for (int i = 0; i < 60000; ++i) {
      const double u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
      points.push_back(set.sample(s, u, v, w).position);
    }
  for (int i = 0; i < 200; ++i) {
    const Vec3d p = direction(rng) * static_cast<double>(rng.uniform());
    double nearest = 10;
    for (const Vec3d& point : points)
      nearest = std::min(nearest, length(point - p));
    const double distance = set.distance(p, 10);
    EXPECT_LE(distance, nearest);
    EXPECT_GT(distance, nearest - 0.015); // the points lie about 0.005 apart
    EXPECT_NEAR(set.distance(p, 0.1), std::min(distance, 0.1), 1e-9);
  }
}

/// The distance of a stretched sphere may be underestimated by its stretch.
TEST(SurfaceSet, the_distance_from_a_stretched_sphere_is_never_more) {
  Affine map = placed(1, {0, 0, 0});
  map.rows[2] = {0, 0, 0.25};
  const SurfaceSet set({{make_simple_shape(SurfaceShape::sphere), map}}, 2);
  EXPECT_NEAR(set.distance({0, 0, 0.5}, 10), 0.25, 1e-6);
  EXPECT_LE(set.distance({1.5, 0, 0}, 10), 0.5);
  EXPECT_GT(set.distance({1.5, 0, 0}, 10), 0.1);
}

TEST(SurfaceSet, of_coincident_faces_the_first_counts) {
  const auto quad = make_simple_shape(SurfaceShape::quad);
  const SurfaceSet set({{quad, {}}, {quad, {}}, {quad, {}}}, 5);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(set.intersect({0.01 * i, 0, 3}, {0, 0, -1}, 0, 10)->surface, 0);
}

TEST(SurfaceSet, samples_uniformly_by_area) {
  Affine stretched;
  stretched.rows = {Vec3d{2, 0, 0}, Vec3d{0, 1, 0.5}, Vec3d{0, 0, 3}};
  const SurfaceSet set({{make_simple_shape(SurfaceShape::sphere), stretched},
                        {make_mesh_shape(ball(48)), stretched},
                        {make_simple_shape(SurfaceShape::disk), stretched}},
                       5);
  // The mean of 1 / pdf is the area, and the mean of the normals is 0 on closed surfaces.
  for (const std::size_t surface : {0, 1, 2}) {
    test::Samples area, closed;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      Rng rng({}, RngStage::test, i);
      const float u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
      const SurfacePoint point = set.sample(surface, u, v, w);
      area.add(1 / static_cast<double>(point.pdf));
      closed.add(static_cast<double>(point.normal.z / point.pdf));
      ASSERT_NEAR(set.sample_pdf(surface, point.normal) / point.pdf, 1, 1e-4);
    }
    test::expect_mean(area, set.area(surface), 1e-3 * set.area(surface));
    if (surface < 2)
      test::expect_mean(closed, 0);
  }
  EXPECT_NEAR(set.area(2), pi * 2, 1e-4);
  EXPECT_NEAR(set.area(1) / set.area(0), 1, 5e-3);
}

} // namespace
} // namespace vdbeam
