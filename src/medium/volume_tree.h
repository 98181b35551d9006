#pragma once

#include "math/affine.h"
#include "math/ray.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// A binary tree over the boxes of volumes: finds those that a ray may meet, at a cost that grows
/// with their number only, so that scenes may have thousands of volumes. Immutable.
class VolumeTree {
public:
  /// Number of volumes up to which a tree is no gain.
  static constexpr std::size_t few = 8;

  explicit VolumeTree(const std::vector<Boxf>& boxes);

  /// Puts the numbers of the volumes whose boxes the segment meets to `found`, in ascending order.
  void find(const Segment& segment, std::vector<std::uint32_t>& found) const;
  std::size_t bytes() const { return nodes_.size() * sizeof(Node); }

private:
  struct Node {
    Boxf box;
    /// Second child of an inner node, whose first follows it; volume of a leaf.
    std::uint32_t index = 0;
    bool leaf = false;
  };
  void build(const std::vector<Boxf>& boxes, std::uint32_t* first, std::uint32_t* last);

  std::vector<Node> nodes_; ///< depth first
};

} // namespace vdbeam
