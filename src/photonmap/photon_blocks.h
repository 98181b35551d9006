#pragma once

#include "math/affine.h"
#include "math/unfilled_array.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbeam {

/// Photons in full blocks of 16, each block a structure of arrays: one row of 16 floats per field.
/// The last block is padded with photons of radius 0 and power 0. The power of photons that come
/// straight from a light is stored with a minus sign: queries separate direct from
/// indirect light by it, and a sign costs no memory.
class PhotonBlocks {
public:
  static constexpr std::size_t width = 16;
  enum Field : int { x = 0, y = 1, z = 2, radius = 3, power = 4 };

  PhotonBlocks() = default;
  /// Room for `count` photons, which have no value until they are written; the padding has.
  /// `groups`: number of light groups whose photons are marked; 0: none.
  PhotonBlocks(std::size_t count, int channels, bool directions, bool first_flights = false,
               int groups = 0)
      : count_(count), channels_(channels), directions_(directions), first_flights_(first_flights),
        groups_(groups), stride_(width * (4 + channels + (directions ? 3 : 0) + (groups ? 1 : 0))),
        rows_(block_count() * stride_) {
    if (count % width != 0)
      std::fill(rows_.end() - static_cast<std::ptrdiff_t>(stride_), rows_.end(), 0.0f);
  }

  std::size_t count() const { return count_; }
  std::size_t block_count() const { return (count_ + width - 1) / width; }
  int channels() const { return channels_; }
  bool has_directions() const { return directions_; }
  /// Some photons come straight from a light.
  bool has_first_flights() const { return first_flights_; }
  int groups() const { return groups_; }
  /// First field of the direction's three; only where has_directions().
  int direction_field() const { return power + channels_; }
  /// The number of the photon's group; only where there are groups.
  int group_field() const { return power + channels_ + (directions_ ? 3 : 0); }

  const float* row(std::size_t block, int field) const {
    return rows_.data() + block * stride_ + field * width;
  }
  float* row(std::size_t block, int field) {
    return rows_.data() + block * stride_ + field * width;
  }
  float at(std::size_t photon, int field) const {
    return row(photon / width, field)[photon % width];
  }
  float& at(std::size_t photon, int field) { return row(photon / width, field)[photon % width]; }
  Vec3f position(std::size_t photon) const { return {at(photon, x), at(photon, y), at(photon, z)}; }
  std::size_t bytes() const { return rows_.size() * sizeof(float); }
  /// The same photons once more.
  PhotonBlocks copy() const {
    PhotonBlocks other(count_, channels_, directions_, first_flights_, groups_);
    copy_in_parallel(rows_, other.rows_.data());
    return other;
  }
  static constexpr std::size_t bytes_per_photon(int channels, bool directions, bool groups) {
    return static_cast<std::size_t>(4 + channels + (directions ? 3 : 0) + (groups ? 1 : 0)) *
           sizeof(float);
  }

private:
  std::size_t count_ = 0;
  int channels_ = 1;
  bool directions_ = false, first_flights_ = false;
  int groups_ = 0;
  std::size_t stride_ = 0;
  UnfilledArray<float> rows_;
};

/// Bounds of eight sibling nodes: a box around the photons' centres and their greatest radius,
/// which bound spheres more tightly than a box around them. A missing sibling is an empty box.
struct alignas(32) BoxGroup {
  float lower[3][8];
  float upper[3][8];
  float radius[8];
};

/// The implicit 8-ary tree over consecutive blocks: group g of level 0 has the boxes of blocks 8 g
/// to 8 g + 7, group g of level l + 1 those of the groups 8 g to 8 g + 7 of level l. The last level
/// is one group.
struct BlockTree {
  static constexpr int max_levels = 12;
  std::vector<UnfilledArray<BoxGroup>> levels;
  Boxf bounds; ///< of all spheres

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& level : levels)
      sum += level.size() * sizeof(BoxGroup);
    return sum;
  }
};

/// Bounds of all blocks and their groups, rounded outwards.
BlockTree build_block_tree(const PhotonBlocks& blocks);
/// Bounds of cells of `blocks_per_cell` blocks, of the photons' centres alone.
BlockTree build_cell_tree(const PhotonBlocks& blocks, std::size_t blocks_per_cell);

} // namespace vdbeam
