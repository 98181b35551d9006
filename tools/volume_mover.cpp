#include "volume_mover.h"

#include "vdbeam/error.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Interpolation.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::Vec3d;
using openvdb::Vec3s;
using openvdb::Vec3SGrid;

constexpr double near_enough = 1e-4; ///< of a voxel, between steps of the fixed point
constexpr int most_steps = 100;
constexpr int most_voxels_moved = 512;

/// Gives the voxels around the active ones the mean of those that they touch, layer by layer.
void extend(Vec3SGrid& grid, int layers) {
  for (int layer = 0; layer < layers; ++layer) {
    const Vec3SGrid::Ptr before = grid.deepCopy();
    const auto known = before->getConstAccessor();
    auto accessor = grid.getAccessor();
    for (auto voxel = before->cbeginValueOn(); voxel; ++voxel)
      for (int side = 0; side < 6; ++side) {
        Coord next = voxel.getCoord();
        next[side / 2] += side % 2 ? 1 : -1;
        if (accessor.isValueOn(next))
          continue;
        Vec3d sum(0);
        int count = 0;
        for (int other = 0; other < 6; ++other) {
          Coord at = next;
          at[other / 2] += other % 2 ? 1 : -1;
          if (known.isValueOn(at)) {
            sum += Vec3d(known.getValue(at));
            ++count;
          }
        }
        accessor.setValue(next, Vec3s(sum / count));
      }
  }
}

/// The way of points in a given time, in voxels of a grid.
class Way {
public:
  Way(const Vec3SGrid& velocity, const openvdb::math::Transform& lattice, double seconds,
      bool in_index)
      : velocity_(velocity), accessor_(velocity.getConstAccessor()), lattice_(lattice),
        seconds_(seconds), in_index_(in_index),
        staggered_(velocity.getGridClass() == openvdb::GRID_STAGGERED) {}

  /// Position of the point `index`.
  Vec3d at(const Vec3d& index) const {
    const Vec3d world = lattice_.indexToWorld(index),
                at = velocity_.transform().worldToIndex(world);
    const Vec3s found = staggered_ ? openvdb::tools::StaggeredBoxSampler::sample(accessor_, at)
                                   : openvdb::tools::BoxSampler::sample(accessor_, at);
    Vec3d way = Vec3d(found) * seconds_;
    if (in_index_)
      way = velocity_.transform().indexToWorld(at + way) - world;
    return lattice_.worldToIndex(world + way) - index;
  }

  /// The point that comes to `index`.
  Vec3d source_of(const Vec3d& index) const {
    Vec3d source = index;
    for (int step = 0; step < most_steps; ++step) {
      const Vec3d next = index - at(source), change = next - source;
      source = next;
      if (change.lengthSqr() < near_enough * near_enough)
        break;
    }
    return source;
  }

private:
  const Vec3SGrid& velocity_;
  Vec3SGrid::ConstAccessor accessor_;
  const openvdb::math::Transform& lattice_;
  double seconds_;
  bool in_index_, staggered_;
};

/// How far anything in a grid goes, in its voxels, rounded up.
int reach(const Vec3SGrid& velocity, const openvdb::math::Transform& lattice, double seconds,
          bool in_index) {
  double longest = 0;
  for (auto value = velocity.cbeginValueOn(); value; ++value)
    longest = std::max(longest, static_cast<double>(value.getValue().length()));
  const Vec3d from = in_index ? velocity.voxelSize() : Vec3d(1), to = lattice.voxelSize();
  const double voxels = longest * std::abs(seconds) * std::max({from.x(), from.y(), from.z()}) /
                        std::min({to.x(), to.y(), to.z()});
  if (!(voxels < most_voxels_moved))
    throw InputError(fmt::format("the velocity carries it {:.3g} voxels far, more than {}", voxels,
                                 most_voxels_moved));
  return static_cast<int>(std::ceil(voxels)) + 1;
}

FloatGrid::Ptr moved(const FloatGrid& grid, const Vec3SGrid& velocity, double seconds,
                     bool in_index) {
  FloatGrid::Ptr result = FloatGrid::create(grid.background());
  result->insertMeta(grid);
  result->setTransform(grid.transform().copy());
  CoordBBox box;
  if (!grid.tree().evalActiveVoxelBoundingBox(box))
    return result;
  box.expand(reach(velocity, grid.transform(), seconds, in_index));
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box);
  tbb::parallel_for(box.min().z(), box.max().z() + 1, [&](int z) {
    const Way way(velocity, grid.transform(), seconds, in_index);
    const auto values = grid.getConstAccessor();
    for (int y = box.min().y(); y <= box.max().y(); ++y)
      for (int x = box.min().x(); x <= box.max().x(); ++x)
        dense.setValue(Coord(x, y, z),
                       openvdb::tools::BoxSampler::sample(values, way.source_of(Vec3d(x, y, z))));
  });
  openvdb::tools::copyFromDense(dense, *result, 0.0f);
  return result;
}

} // namespace

std::vector<double> middle_times(double open, double close, int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i)
    times.push_back(open + (close - open) * (i + 0.5) / count);
  return times;
}

void move_volume(const std::string& from, const std::string& to, double frames,
                 const MoveOptions& options) {
  openvdb::initialize();
  openvdb::io::File file(from);
  file.open(false);
  if (!file.hasGrid(options.velocity))
    throw InputError(fmt::format("{}: has no grid \"{}\"", from, options.velocity));
  const auto velocity = openvdb::gridPtrCast<Vec3SGrid>(file.readGrid(options.velocity));
  if (!velocity)
    throw InputError(fmt::format("{}: grid \"{}\" holds no vectors", from, options.velocity));
  const double seconds = frames / options.fps * options.scale;
  openvdb::tools::changeBackground(velocity->tree(), Vec3s(0));
  extend(*velocity, reach(*velocity, velocity->transform(), seconds, options.index));
  openvdb::GridPtrVec grids;
  for (auto name = file.beginName(); name != file.endName(); ++name)
    if (const auto grid = openvdb::gridPtrCast<FloatGrid>(file.readGrid(name.gridName())))
      grids.push_back(moved(*grid, *velocity, seconds, options.index));
  openvdb::io::File(to).write(grids);
}

} // namespace vdbeam
