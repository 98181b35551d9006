#include "vdbeam/error.h"
#include "vdbeam/volume_file.h"

#include <filesystem>
#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

namespace vdbeam {
namespace {

void check(const DensityArray& density) {
  for (int a = 0; a < 3; ++a)
    if (density.size[a] < 1)
      throw InputError(fmt::format("a density array needs values along all three axes, got {} by "
                                   "{} by {}",
                                   density.size.x, density.size.y, density.size.z));
  if (!(density.voxel_size > 0) || !std::isfinite(density.voxel_size))
    throw InputError(
        fmt::format("the voxel size must be positive and finite, got {}", density.voxel_size));
}

openvdb::FloatGrid::Ptr grid_of(const DensityArray& density) {
  using openvdb::tools::Dense, openvdb::tools::LayoutZYX;
  const openvdb::CoordBBox box({0, 0, 0},
                               {density.size.x - 1, density.size.y - 1, density.size.z - 1});
  const Dense<const float, LayoutZYX> values(box, density.values);
  openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  openvdb::tools::copyFromDense(values, *grid, 0.0f);
  const auto transform = openvdb::math::Transform::createLinearTransform(density.voxel_size);
  transform->postTranslate({density.origin.x, density.origin.y, density.origin.z});
  grid->setTransform(transform);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  return grid;
}

} // namespace

void write_volume_file(const DensityArray& density, const std::string& path,
                       const std::string& grid_name) {
  namespace fs = std::filesystem;
  check(density);
  openvdb::initialize();
  const std::string draft = path + ".part";
  try {
    const openvdb::FloatGrid::Ptr grid = grid_of(density);
    grid->setName(grid_name);
    openvdb::io::File file(draft);
    file.write({grid});
    fs::rename(draft, path);
  } catch (const std::exception& error) { // OpenVDB's and the file system's
    std::error_code ignored;
    fs::remove(draft, ignored);
    throw FrameError(fmt::format("{}: cannot be written: {}", path, error.what()));
  }
}

} // namespace vdbeam
