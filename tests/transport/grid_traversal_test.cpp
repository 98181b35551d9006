#include "medium/grid_traversal.h"

#include "math/rng.h"
#include "math/sampling.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>
#include <vector>

namespace vdbeam {
namespace {

struct Visit {
  Vec3<int> cell;
  float t_in, t_out;
};

std::vector<Visit> walk(const Vec3f& o, const Vec3f& d, const Vec3<int>& counts, float t_begin,
                        float t_end) {
  std::vector<Visit> visits;
  for (GridTraversal cells(o, d, counts, t_begin, t_end); !cells.done() && visits.size() < 10000;
       cells.advance())
    visits.push_back({cells.cell(), cells.t(), cells.t_exit()});
  return visits;
}

/// Checks a walk against points along the ray in double precision. A point nearer than `margin` to
/// a cell's border may belong to either side.
void expect_exact(const Vec3f& o, const Vec3f& d, const Vec3<int>& counts, float t_begin,
                  float t_end) {
  SCOPED_TRACE(testing::Message() << "o " << o.x << " " << o.y << " " << o.z << " d " << d.x << " "
                                  << d.y << " " << d.z);
  constexpr double margin = 2e-5;
  const std::vector<Visit> visits = walk(o, d, counts, t_begin, t_end);
  ASSERT_LT(visits.size(), 1000u);
  std::set<std::tuple<int, int, int>> visited;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const Visit& v = visits[i];
    visited.insert({v.cell.x, v.cell.y, v.cell.z});
    ASSERT_LE(v.t_in, v.t_out);
    ASSERT_GE(v.t_in, t_begin);
    ASSERT_LE(v.t_out, t_end);
    if (i > 0) {
      ASSERT_EQ(v.t_in, visits[i - 1].t_out) << "a gap or an overlap";
    }
    const Vec3d middle =
        Vec3d(o) + Vec3d(d) * (0.5 * (static_cast<double>(v.t_in) + static_cast<double>(v.t_out)));
    for (int a = 0; a < 3; ++a) {
      ASSERT_GE(v.cell[a], 0);
      ASSERT_LT(v.cell[a], counts[a]);
      ASSERT_GT(middle[a], v.cell[a] - margin);
      ASSERT_LT(middle[a], v.cell[a] + 1 + margin);
    }
  }
  constexpr int points = 3000;
  for (int i = 0; i < points; ++i) {
    const double t =
        static_cast<double>(t_begin) + (i + 0.5) / points * static_cast<double>(t_end - t_begin);
    const Vec3d p = Vec3d(o) + Vec3d(d) * t;
    bool clear = true;
    for (int a = 0; a < 3; ++a)
      clear = clear && std::abs(p[a] - std::round(p[a])) > margin && p[a] > 0 && p[a] < counts[a];
    if (clear) {
      ASSERT_TRUE(
          visited.count({static_cast<int>(p.x), static_cast<int>(p.y), static_cast<int>(p.z)}))
          << "missed the cell at t = " << t;
    }
  }
}

TEST(GridTraversal, RandomRaysVisitExactlyWhatLiesOnThem) {
  const Vec3<int> counts{7, 3, 11};
  Rng rng({1, 0, 0}, RngStage::test, 1);
  for (int i = 0; i < 400; ++i) {
    const Vec3f target{7 * rng.uniform(), 3 * rng.uniform(), 11 * rng.uniform()};
    const Vec3f d = sample_sphere(rng.uniform(), rng.uniform()) * (0.2f + 3 * rng.uniform());
    const Vec3f o = target - d * (12 * rng.uniform());
    expect_exact(o, d, counts, 0, 30);
  }
}

TEST(GridTraversal, PartOfARayStartsAndEndsWhereAsked) {
  Rng rng({1, 0, 0}, RngStage::test, 2);
  for (int i = 0; i < 200; ++i) {
    const Vec3f o{5 * rng.uniform(), 5 * rng.uniform(), 5 * rng.uniform()};
    const float begin = 2 * rng.uniform();
    expect_exact(o, sample_sphere(rng.uniform(), rng.uniform()), {5, 5, 5}, begin, begin + 1.5f);
  }
}

TEST(GridTraversal, AxisParallelRays) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {1.0f, -1.0f})
      for (const float beside : {0.0f, 0.5f, 1.0f, 2.999f}) {
        Vec3f o(beside), d(0);
        d[axis] = sign;
        o[axis] = sign > 0 ? -2.0f : 5.0f;
        expect_exact(o, d, {3, 3, 3}, 0, 20);
        EXPECT_EQ(walk(o, d, {3, 3, 3}, 0, 20).size(), 3u);
      }
}

TEST(GridTraversal, ParallelRayOutsideOrOnTheUpperSideMisses) {
  EXPECT_TRUE(walk({-1, 3.0f, 1.5f}, {1, 0, 0}, {3, 3, 3}, 0, 20).empty());
  EXPECT_TRUE(walk({-1, -0.001f, 1.5f}, {1, 0, 0}, {3, 3, 3}, 0, 20).empty());
  EXPECT_TRUE(walk({-1, 1, 1}, {-1, 0, 0}, {3, 3, 3}, 0, 20).empty());
  EXPECT_TRUE(walk({1, 1, 1}, {1, 0, 0}, {3, 3, 3}, 5, 20).empty());
}

// Through edges and corners a walk may take any of the touching cells, for no length of the ray,
// but must come through.
TEST(GridTraversal, DiagonalsThroughCorners) {
  for (const float sx : {1.0f, -1.0f})
    for (const float sy : {1.0f, -1.0f})
      for (const float sz : {1.0f, -1.0f, 0.0f}) {
        const Vec3f d{sx, sy, sz};
        const Vec3f o = Vec3f(2) - d * 5.0f;
        expect_exact(o, d, {4, 4, 4}, 0, 20);
        const std::vector<Visit> visits = walk(o, d, {4, 4, 4}, 0, 20);
        ASSERT_FALSE(visits.empty());
        EXPECT_NEAR(visits.front().t_in, 3, 1e-5);
        EXPECT_NEAR(visits.back().t_out, 7, 1e-5);
      }
}

TEST(GridTraversal, GrazingRays) {
  Rng rng({1, 0, 0}, RngStage::test, 3);
  for (int i = 0; i < 300; ++i) {
    // Nearly along an axis, within rounding of a lattice plane.
    const int axis = i % 3;
    Vec3f o{3 * rng.uniform(), 3 * rng.uniform(), 3 * rng.uniform()}, d(0);
    o[(axis + 1) % 3] = std::round(o[(axis + 1) % 3]) + (rng.uniform() - 0.5f) * 1e-6f;
    d[axis] = i % 2 ? 1.0f : -1.0f;
    d[(axis + 1) % 3] = (rng.uniform() - 0.5f) * 1e-6f;
    o[axis] = -d[axis] * 4 + 1.5f;
    expect_exact(o, normalize(d), {3, 3, 3}, 0, 20);
  }
}

} // namespace
} // namespace vdbeam
