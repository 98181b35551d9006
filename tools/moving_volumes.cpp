#include "moving_volumes.h"

#include <iterator>
#include <limits>
#include <string>

namespace vdbeam {
namespace {

openvdb::Vec3SGrid::Ptr velocity_for(const openvdb::FloatGrid& density) {
  const auto velocity = openvdb::Vec3SGrid::create();
  velocity->setTransform(density.transform().copy());
  velocity->setName("velocity");
  return velocity;
}

openvdb::Vec3SGrid::Ptr staggered_velocity(const openvdb::FloatGrid& ball) {
  const auto velocity = velocity_for(ball);
  velocity->setGridClass(openvdb::GRID_STAGGERED);
  auto accessor = velocity->getAccessor();
  for (auto value = ball.cbeginValueOn(); value; ++value)
    accessor.setValue(value.getCoord(), openvdb::Vec3s(1, 2, 3));
  return velocity;
}

} // namespace

Grids staggered(const openvdb::FloatGrid::Ptr& ball) {
  return {ball, staggered_velocity(*ball)};
}

Grids components(const openvdb::FloatGrid::Ptr& ball) {
  Grids grids{ball};
  for (int axis = 0; axis < 3; ++axis) {
    const openvdb::FloatGrid::Ptr component = ball->deepCopy();
    for (auto value = component->beginValueOn(); value; ++value)
      value.setValue(static_cast<float>(axis + 1));
    component->setName(std::string("vel.") + "xyz"[axis]);
    grids.push_back(component);
  }
  return grids;
}

Grids wild(const openvdb::FloatGrid::Ptr& ball) {
  using Limits = std::numeric_limits<float>;
  const float bad[] = {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), 1e6f, -1e6f,
                       Limits::max()};
  const auto velocity = staggered_velocity(*ball);
  std::size_t count = 0;
  for (auto value = velocity->beginValueOn(); value; ++value, ++count)
    if (count % 3 == 0) {
      openvdb::Vec3s v(1, 2, 3);
      v[static_cast<int>(count / 3 % 3)] = bad[count / 9 % std::size(bad)];
      value.setValue(v);
    }
  return {ball, velocity};
}

Grids whirl(const openvdb::FloatGrid::Ptr& cloud, const openvdb::CoordBBox& box) {
  const auto velocity = velocity_for(*cloud);
  auto accessor = velocity->getAccessor();
  for (auto at = box.begin(); at; ++at) {
    const openvdb::Vec3d p = cloud->indexToWorld(*at);
    accessor.setValue(*at, openvdb::Vec3s(openvdb::Vec3d(-p.y(), p.x() + p.z() / 2, p.x() / 2)));
  }
  return {cloud, velocity};
}

} // namespace vdbeam
