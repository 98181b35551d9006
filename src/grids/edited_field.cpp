#include "grids/edited_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

constexpr int brick_size = DensityField::brick_size;

class Editor {
public:
  Editor(const DensityField& field, const GridEdits& edits) : field_(field), edits_(edits) {
    Affine shift;
    shift.translation = Vec3d(field.origin());
    to_world_ = edits.to_world.after(shift);
    if (edits.box)
      box_ = with_its_faces(*edits.box);
    if (!edits.remap.curve.empty())
      curve_.emplace(edits.remap.curve, 1);
    if (!edits.mask)
      return;
    Affine back;
    back.translation = -Vec3d(edits.mask->field.origin());
    to_mask_ = back.after(edits.mask_to_world.inverse()).after(to_world_);
  }

  DensityField edit(const StopToken* stop) {
    number_cells();
    std::vector<float> bricks(brick_count_ * brick_size);
    const Vec3<int>& n = field_.cell_counts();
    tbb::parallel_for(0, n.x * n.y, [&](int column) {
      for (int k = 0; k < n.z; ++k) {
        std::int32_t& entry = table_[field_.cell_offset(column / n.y, column % n.y, k)];
        if (entry < 0)
          continue;
        if (stop)
          stop->check();
        float* brick = bricks.data() + static_cast<std::size_t>(entry) * brick_size;
        if (!fill_brick(column / n.y, column % n.y, k, brick))
          entry = DensityField::empty_cell;
      }
    });
    return DensityField(field_.origin(), n, std::move(table_), std::move(bricks),
                        std::move(uniform_));
  }

private:
  /// Which cells become bricks, and which stay uniform.
  void number_cells() {
    const Vec3<int>& n = field_.cell_counts();
    table_.assign(static_cast<std::size_t>(n.x) * n.y * n.z, DensityField::empty_cell);
    for (int i = 0; i < n.x; ++i)
      for (int j = 0; j < n.y; ++j)
        for (int k = 0; k < n.z; ++k) {
          const std::int32_t entry = field_.cell(i, j, k);
          std::int32_t& target = table_[field_.cell_offset(i, j, k)];
          if (entry >= 0 || (entry != DensityField::empty_cell && !stays_uniform(i, j, k)))
            target = static_cast<std::int32_t>(brick_count_++);
          else if (entry != DensityField::empty_cell) {
            const float value = remapped(edits_.remap, curve(), field_.uniform_value(entry));
            if (value == 0)
              continue;
            target = DensityField::uniform_base - static_cast<std::int32_t>(uniform_.size());
            uniform_.push_back(value);
          }
        }
  }
  bool stays_uniform(int i, int j, int k) const {
    if (edits_.mask)
      return false;
    const Vec3d corner = Vec3d(Vec3<int>{i, j, k}) * double{cell_width};
    const Boxd cell{corner, corner + Vec3d(double{cell_width})};
    bool inside = true;
    for (int c = 0; c < 8; ++c)
      inside = inside && in_box(cell.corner(c));
    return inside;
  }
  bool in_box(const Vec3d& local) const {
    if (!box_)
      return true;
    const Vec3d p = to_world_.point(local);
    return p.x >= box_->lower.x && p.y >= box_->lower.y && p.z >= box_->lower.z &&
           p.x <= box_->upper.x && p.y <= box_->upper.y && p.z <= box_->upper.z;
  }
  /// The box, larger by so little that lattice points on its faces lie in it however the transform
  /// is rounded.
  Boxd with_its_faces(Boxd box) const {
    constexpr double share_of_voxel = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3d& row = to_world_.rows[static_cast<std::size_t>(axis)];
      const double by = share_of_voxel * (std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
      box.lower[axis] -= by;
      box.upper[axis] += by;
    }
    return box;
  }
  float value_at(float value, const Vec3d& local) const {
    if (value == 0 || !in_box(local))
      return 0;
    if (edits_.mask)
      value *= edits_.mask->field.sample(Vec3f(to_mask_.point(local)));
    return remapped(edits_.remap, curve(), value);
  }
  /// Returns false where all values are 0.
  bool fill_brick(int i, int j, int k, float* brick) const {
    const std::int32_t entry = field_.cell(i, j, k);
    const float* source = entry >= 0 ? field_.brick(entry) : nullptr;
    const float same = source ? 0 : field_.uniform_value(entry);
    const Vec3d corner = Vec3d(Vec3<int>{i, j, k}) * double{cell_width};
    bool any = false;
    for (int x = 0, at = 0; x < brick_width; ++x)
      for (int y = 0; y < brick_width; ++y)
        for (int z = 0; z < brick_width; ++z, ++at) {
          const Vec3d local = corner + Vec3d(Vec3<int>{x, y, z});
          brick[at] = value_at(source ? source[at] : same, local);
          any = any || brick[at] != 0;
        }
    return any;
  }

  const Curve* curve() const { return curve_ ? &*curve_ : nullptr; }

  const DensityField& field_;
  const GridEdits& edits_;
  std::optional<Curve> curve_;
  std::optional<Boxd> box_;
  Affine to_world_, to_mask_;
  std::vector<std::int32_t> table_;
  std::vector<float> uniform_;
  std::size_t brick_count_ = 0;
};

} // namespace

/// What edits make of a density is kept below this, so that sums of a few of them stay finite in
/// single precision; no medium that is denser looks different.
constexpr double greatest_density = 1e37;

float remapped(const DensityRemap& remap, float value) {
  if (remap.curve.empty())
    return remapped(remap, nullptr, value);
  const Curve curve(remap.curve, 1);
  return remapped(remap, &curve, value);
}

float remapped(const DensityRemap& remap, const Curve* curve, float value) {
  if (!(value > 0))
    return 0;
  double x = remap.scale * static_cast<double>(value) + remap.offset;
  if (x < remap.least || x <= 0)
    return 0;
  if (remap.most)
    x = std::min(x, *remap.most);
  if (remap.power != 1)
    x = std::pow(x, remap.power);
  if (curve)
    x = curve->at(x);
  return x > 0 ? static_cast<float>(std::min(x, greatest_density)) : 0;
}

DensityField edited_field(const DensityField& field, const GridEdits& edits,
                          const StopToken* stop) {
  return field.empty() || !edits.changes() ? field : Editor(field, edits).edit(stop);
}

} // namespace vdbeam
