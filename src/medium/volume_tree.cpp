#include "medium/volume_tree.h"

#include <algorithm>
#include <numeric>

namespace vdbeam {
namespace {

/// False only where no point of the segment lies in the box.
bool meets(const Segment& segment, const Boxf& box) {
  float begin = segment.t_begin, end = segment.t_end;
  for (int a = 0; a < 3; ++a) {
    const float o = segment.ray.origin[a], d = segment.ray.direction[a];
    if (d == 0) {
      if (o < box.lower[a] || o > box.upper[a])
        return false;
      continue;
    }
    const float near = ((d > 0 ? box.lower[a] : box.upper[a]) - o) / d;
    const float far = ((d > 0 ? box.upper[a] : box.lower[a]) - o) / d;
    begin = std::max(begin, near);
    end = std::min(end, far);
  }
  // Rounding of distances, which the box's margin cannot make up for.
  return begin <= end + 4e-7f * std::abs(end);
}

} // namespace

VolumeTree::VolumeTree(const std::vector<Boxf>& boxes) {
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!order.empty())
    build(boxes, order.data(), order.data() + order.size());
}

/// Halves the volumes by the middles of their boxes along the longest axis.
void VolumeTree::build(const std::vector<Boxf>& boxes, std::uint32_t* first, std::uint32_t* last) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Boxf all, middles;
  for (const std::uint32_t* i = first; i != last; ++i) {
    all.extend(boxes[*i]);
    middles.extend(boxes[*i].center());
  }
  nodes_[self].box = all;
  if (last - first == 1) {
    nodes_[self].index = *first;
    nodes_[self].leaf = true;
    return;
  }
  const Vec3f size = middles.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::uint32_t* middle = first + (last - first) / 2;
  std::nth_element(first, middle, last, [&](std::uint32_t a, std::uint32_t b) {
    const float x = boxes[a].center()[axis], y = boxes[b].center()[axis];
    return x != y ? x < y : a < b;
  });
  build(boxes, first, middle);
  nodes_[self].index = static_cast<std::uint32_t>(nodes_.size());
  build(boxes, middle, last);
}

void VolumeTree::find(const Segment& segment, std::vector<std::uint32_t>& found) const {
  constexpr std::size_t deepest = 64; // halves: more than there are numbers
  std::uint32_t waiting[deepest];
  std::size_t count = 0;
  const std::size_t before = found.size();
  if (!nodes_.empty())
    waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t at = waiting[--count];
    const Node& node = nodes_[at];
    if (!meets(segment, node.box))
      continue;
    if (node.leaf) {
      found.push_back(node.index);
      continue;
    }
    waiting[count++] = node.index;
    waiting[count++] = at + 1;
  }
  std::sort(found.begin() + static_cast<std::ptrdiff_t>(before), found.end());
}

} // namespace vdbeam
