#include "grids/edited_field.h"

#include "support/make_field.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

/// 24^3 voxels; the last third along x is uniform.
DensityGrid grid() {
  DensityGrid grid;
  grid.field = test::make_field(24, 24, 24, [](int i, int j, int k) {
    return i >= 15 ? 2.0 : i == 0 ? 0.0 : 0.1 * i + 0.01 * j + 0.02 * k;
  });
  for (int a = 0; a < 3; ++a)
    grid.index_to_world.rows[static_cast<std::size_t>(a)] *= 0.5;
  grid.index_to_world.translation = {-3, 1, 0};
  return grid;
}

/// Every lattice point of the edited field is what `expected` makes of the value and the place.
template <class Expected>
void expect_points(const DensityGrid& source, const DensityField& edited, Expected expected) {
  float largest = 0;
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 24; ++j)
      for (int k = 0; k < 24; ++k) {
        const Vec3d p(Vec3<int>{i, j, k});
        const float value = source.field.sample(Vec3f(p));
        const auto wanted = static_cast<float>(
            expected(static_cast<double>(value), source.index_to_world.point(p)));
        ASSERT_FLOAT_EQ(edited.sample(Vec3f(p)), wanted) << i << " " << j << " " << k;
        largest = std::max(largest, wanted);
      }
  EXPECT_FLOAT_EQ(edited.maximum(), largest);
  // What bounds the cells must bound the samples: tracking relies on it.
  const Vec3<int>& n = edited.cell_counts();
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k)
        for (int s = 0; s < 64; ++s) {
          const Vec3d p = (Vec3d(Vec3<int>{i, j, k}) +
                           Vec3d((s % 4 + 0.5) / 4, (s / 4 % 4 + 0.5) / 4, (s / 16 + 0.5) / 4)) *
                          8.0;
          EXPECT_LE(edited.sample(Vec3f(p)), edited.cell_maximum(edited.cell_offset(i, j, k)));
        }
}

TEST(EditedField, RemapsValues) {
  const DensityGrid source = grid();
  GridEdits edits;
  edits.remap = {.scale = 2, .offset = -0.8, .least = 0.3, .most = 2.5, .power = 1.5, .curve = ""};
  expect_points(source, edited_field(source.field, edits), [](double v, const Vec3d&) {
    const double x = 2 * v - 0.8;
    return v <= 0 || x < 0.3 ? 0 : std::pow(std::min(x, 2.5), 1.5);
  });
}

TEST(EditedField, FollowsACurve) {
  const DensityGrid source = grid();
  GridEdits edits;
  edits.remap.scale = 2;
  edits.remap.curve = "0.5:0 1:4 3:1";
  expect_points(source, edited_field(source.field, edits), [](double v, const Vec3d&) {
    const double x = 2 * v;
    return v <= 0 || x <= 0.5 ? 0 : x < 1 ? 8 * (x - 0.5) : std::max(1.0, 4 - 1.5 * (x - 1));
  });
}

TEST(EditedField, ClipsToABox) {
  const DensityGrid source = grid();
  GridEdits edits;
  edits.to_world = source.index_to_world;
  const Boxd box{{-1.8, 2, 1.1}, {6.3, 8, 9}};
  edits.box = box;
  expect_points(source, edited_field(source.field, edits), [&](double v, const Vec3d& p) {
    bool inside = true;
    for (int a = 0; a < 3; ++a)
      inside = inside && p[a] >= box.lower[a] && p[a] <= box.upper[a];
    return inside ? v : 0;
  });
}

/// However decimal places and the transform are rounded, points on a face lie inside, the next ones
/// outside; where faces are on the lattice, all samples inside are those of the whole field.
TEST(EditedField, PointsOnTheFacesOfABoxBelongToIt) {
  for (const double voxel : {0.1, 1.0 / 3, 0.7, 1e-3})
    for (const double place : {0.0, -0.3, 1000.1}) {
      DensityGrid source = grid();
      for (int a = 0; a < 3; ++a)
        source.index_to_world.rows[static_cast<std::size_t>(a)] = Vec3d(0);
      for (std::size_t a = 0; a < 3; ++a) // the axes turned
        source.index_to_world.rows[a][static_cast<int>((a + 1) % 3)] = a == 1 ? -voxel : voxel;
      source.index_to_world.translation = Vec3d(place);
      GridEdits edits;
      edits.to_world = source.index_to_world;
      // Index coordinates 3 to 11, 5 to 19 and 2 to 16, rounded to the inside.
      const Vec3d lower(place + 5 * voxel, place - 16 * voxel, place + 3 * voxel),
          upper(place + 19 * voxel, place - 2 * voxel, place + 11 * voxel);
      const Vec3d rounding(1e-14 * (1 + std::abs(place)));
      edits.box = Boxd{lower + rounding, upper - rounding};
      const DensityField cut = edited_field(source.field, edits);
      expect_points(source, cut, [&](double v, const Vec3d& p) {
        const Vec3d at = source.index_to_world.inverse().point(p);
        const auto i = std::lround(at.x), j = std::lround(at.y), k = std::lround(at.z);
        return i >= 3 && i <= 11 && j >= 5 && j <= 19 && k >= 2 && k <= 16 ? v : 0;
      });
      for (int s = 0; s < 200; ++s) {
        const auto part = [s](double prime) { return std::fmod(s * std::sqrt(prime), 1.0); };
        const Vec3f p(Vec3d(3 + 8 * part(2), 5 + 14 * part(3), 2 + 14 * part(5)));
        ASSERT_EQ(cut.sample(p), source.field.sample(p));
      }
    }
}

TEST(EditedField, MultipliesByAMask) {
  const DensityGrid source = grid();
  DensityGrid mask; // twice as coarse, on the same place
  mask.field = test::make_field(12, 12, 12, [](int i, int, int k) { return 0.1 * i + 0.05 * k; });
  mask.index_to_world = source.index_to_world;
  for (int a = 0; a < 3; ++a)
    mask.index_to_world.rows[static_cast<std::size_t>(a)] *= 2;
  GridEdits edits;
  edits.to_world = source.index_to_world;
  edits.mask = &mask;
  edits.mask_to_world = mask.index_to_world;
  expect_points(source, edited_field(source.field, edits), [&](double v, const Vec3d& p) {
    const Vec3d at = mask.index_to_world.inverse().point(p);
    return v * static_cast<double>(mask.field.sample(Vec3f(at)));
  });
}

TEST(EditedField, NothingToDoKeepsTheField) {
  const DensityGrid source = grid();
  EXPECT_EQ(edited_field(source.field, {}).brick(0), source.field.brick(0)); // shared
  const std::atomic<bool> yes = true;
  const StopToken stop(&yes);
  GridEdits darker;
  darker.remap.scale = 0.5;
  EXPECT_THROW(edited_field(source.field, darker, &stop), Stopped);
  GridEdits nothing_left;
  nothing_left.to_world = source.index_to_world;
  nothing_left.box = Boxd{{100, 100, 100}, {101, 101, 101}};
  EXPECT_EQ(edited_field(source.field, nothing_left).maximum(), 0);
}

} // namespace
} // namespace vdbeam
