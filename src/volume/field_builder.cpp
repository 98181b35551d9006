#include "volume/field_builder.h"

#include "vdbeam/error.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <utility>

namespace vdbeam {
namespace {

constexpr double most_cells = 1 << 28;

std::int64_t cell_of(double local) {
  return static_cast<std::int64_t>(std::floor(local / cell_width));
}

} // namespace

FieldBuilder::FieldBuilder(const DensityField& like, const Boxd& bounds, std::string label)
    : label_(std::move(label)), origin_(like.origin()) {
  double cells = 1;
  for (int a = 0; a < 3; ++a) {
    // The last point of a cell is the first of the next.
    lower_[a] = cell_of(bounds.lower[a] - 1);
    upper_[a] = cell_of(bounds.upper[a] + 1) + 1;
    cells *= static_cast<double>(upper_[a] - lower_[a]);
  }
  if (!(cells < most_cells))
    throw FrameError(label_ + ": its density, as it is put together, spans more blocks of 8^3 "
                              "voxels than fit in the index table (2^28)");
  table_.assign(static_cast<std::size_t>(cells), DensityField::empty_cell);
}

std::size_t FieldBuilder::offset(const Vec3<std::int64_t>& cell) const {
  const Vec3<std::int64_t> n = upper_ - lower_, c = cell - lower_;
  return static_cast<std::size_t>((c.x * n.y + c.y) * n.z + c.z);
}

void FieldBuilder::mark(const Boxd& box) {
  Vec3<std::int64_t> first, last;
  for (int a = 0; a < 3; ++a) {
    first[a] = std::max(cell_of(box.lower[a] - 1), lower_[a]);
    last[a] = std::min(cell_of(box.upper[a] + 1), upper_[a] - 1);
  }
  for (std::int64_t i = first.x; i <= last.x; ++i)
    for (std::int64_t j = first.y; j <= last.y; ++j)
      for (std::int64_t k = first.z; k <= last.z; ++k)
        table_[offset({i, j, k})] = 0;
}

DensityField FieldBuilder::build(const std::function<float(const Vec3d& local)>& value,
                                 const FieldLimits& limits) {
  std::size_t bricks = 0;
  for (std::int32_t& entry : table_)
    if (entry != DensityField::empty_cell)
      entry = static_cast<std::int32_t>(bricks++);
  if (bricks * DensityField::brick_size * sizeof(float) > limits.bytes)
    throw FrameError(label_ + ": its density, as it is put together, needs more memory than there "
                              "may be");
  std::vector<float> values(bricks * DensityField::brick_size);
  tbb::parallel_for(lower_.x, upper_.x, [&](std::int64_t i) {
    for (std::int64_t j = lower_.y; j < upper_.y; ++j)
      for (std::int64_t k = lower_.z; k < upper_.z; ++k) {
        const std::int32_t brick = table_[offset({i, j, k})];
        if (brick < 0)
          continue;
        limits.check();
        const Vec3d corner = Vec3d(Vec3<std::int64_t>{i, j, k}) * double{cell_width};
        float* out = values.data() + static_cast<std::size_t>(brick) * DensityField::brick_size;
        for (int x = 0; x < brick_width; ++x)
          for (int y = 0; y < brick_width; ++y)
            for (int z = 0; z < brick_width; ++z)
              *out++ = value(corner + Vec3d(Vec3<int>{x, y, z}));
      }
  });
  return DensityField(origin_ + lower_ * std::int64_t{cell_width}, Vec3<int>(upper_ - lower_),
                      std::move(table_), std::move(values), {});
}

void for_each_occupied_cell(const DensityField& field,
                            const std::function<void(const Boxd& box)>& visit) {
  const Vec3<int>& n = field.cell_counts();
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k)
        if (field.cell_maximum(field.cell_offset(i, j, k)) > 0) {
          const Vec3d corner = Vec3d(Vec3<int>{i, j, k}) * double{cell_width};
          visit({corner - Vec3d(1), corner + Vec3d(double{cell_width})});
        }
}

} // namespace vdbeam
