#include "vdb/vdb_shape.h"

#include "machine/mapped_file.h"
#include "vdb/grid_shape.h"
#include "vdb/vdb_parse.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <fstream>
#include <map>

namespace vdbeam {
namespace {

/// Grids of up to this number of voxels are read with their values: that takes a moment, and little
/// memory beside the frame that is being rendered.
constexpr std::uint64_t most_values = std::uint64_t{1} << 22;

/// Reads the tree of a grid without its voxels' values, which lie behind it in the file, unless
/// they are few. OpenVDB's own File does that for delayed loading only.
class TopologyReader : public openvdb::io::Archive {
public:
  /// Whether the values were read: those of fog are; of level sets they would say nothing.
  bool has_values() const { return has_values_; }

  openvdb::GridBase::Ptr read(const std::string& path, const std::string& name) {
    auto& stream = make_immortal<std::ifstream>(path, std::ios::binary);
    auto metadata = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(stream, metadata, false);
    readHeader(stream);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    openvdb::MetaMap file_metadata;
    file_metadata.readMeta(stream);
    std::map<std::string, openvdb::io::GridDescriptor> descriptors;
    for (std::int32_t left = readGridCount(stream); left > 0; --left) {
      openvdb::io::GridDescriptor descriptor;
      descriptor.read(stream);
      descriptor.seekToEnd(stream);
      if (!stream)
        throw openvdb::IoError("cut short");
      descriptors[openvdb::io::GridDescriptor::nameAsString(descriptor.uniqueName())] = descriptor;
    }
    auto found = descriptors.find(name);
    if (found != descriptors.end() && found->second.isInstance())
      found = descriptors.find(openvdb::io::GridDescriptor::nameAsString(
          openvdb::io::GridDescriptor::stringAsUniqueName(found->second.instanceParentName())));
    if (found == descriptors.end())
      throw openvdb::KeyError("no such grid");
    return read_topology(stream, found->second);
  }

private:
  openvdb::GridBase::Ptr read_topology(std::istream& stream,
                                       const openvdb::io::GridDescriptor& descriptor) {
    openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(descriptor.gridType());
    grid->setSaveFloatAsHalf(descriptor.saveFloatAsHalf());
    descriptor.seekToGrid(stream);
    readGridCompression(stream);
    grid->readMeta(stream);
    grid->readTransform(stream);
    openvdb::io::setHalfFloat(stream, descriptor.saveFloatAsHalf());
    openvdb::io::setGridClass(stream, grid->getGridClass());
    grid->readTopology(stream);
    const std::uint64_t values = 512 * std::uint64_t{grid->baseTree().leafCount()};
    has_values_ = values <= most_values && grid->getGridClass() != openvdb::GRID_LEVEL_SET;
    if (has_values_)
      grid->readBuffers(stream);
    if (!stream)
      throw openvdb::IoError("cut short");
    return grid;
  }

  bool has_values_ = false;
};

ActiveBox box_of(const openvdb::CoordBBox& box) {
  return {{box.min().x(), box.min().y(), box.min().z()},
          {box.max().x(), box.max().y(), box.max().z()}};
}

/// Contribution of the active values of a leaf or a tile to the sum.
template <class Value>
double light_of(Value value) {
  return value > 0 && std::isfinite(value) ? static_cast<double>(value) : 0;
}

/// Leaves of the tree, or those of them that hold anything where their values are known.
template <class Tree>
std::vector<ActiveBox> find_leaves(const Tree& tree, bool with_values, ShapeHeader& header) {
  std::vector<ActiveBox> boxes;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    ++header.tree_leaves;
    header.active_voxels += leaf->onVoxelCount();
    double sum = 0;
    std::uint64_t blocks = 0;
    openvdb::CoordBBox box;                                         // of what it holds
    for (openvdb::Index i = 0; i < Tree::LeafNodeType::SIZE; ++i) { // x-major, 8 along an axis
      const double value = with_values ? light_of(leaf->getValue(i)) : 0;
      sum += value;
      if (with_values ? value > 0 : leaf->isValueOn(i)) {
        blocks |= std::uint64_t{1} << (16 * (i >> 7) + 4 * (i >> 4 & 3) + (i >> 1 & 3));
        box.expand(leaf->offsetToGlobalCoord(i));
      }
    }
    if (with_values && sum == 0)
      continue;
    header.value_sum += sum;
    // A leaf without active voxels may hold values all the same.
    boxes.push_back(box_of(blocks != 0 ? box : leaf->getNodeBoundingBox()));
    if (blocks != 0)
      boxes.back().blocks = blocks;
  }
  header.leaf_count = boxes.size();
  return boxes;
}

template <class Tree>
void write_tree(const Tree& tree, bool with_values, int descriptor) {
  ShapeHeader header;
  header.value_bytes = sizeof(typename Tree::ValueType);
  header.value_sum = with_values ? 0 : -1;
  std::vector<ActiveBox> boxes = find_leaves(tree, with_values, header);
  for (auto node = tree.cbeginNode(); node; ++node)
    if (node.getLevel() == 1)
      header.node_bytes += sizeof(typename Tree::RootNodeType::ChildNodeType::ChildNodeType);
    else if (node.getLevel() == 2)
      header.node_bytes += sizeof(typename Tree::RootNodeType::ChildNodeType);
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    openvdb::CoordBBox box;
    tile.getBoundingBox(box);
    ++header.tile_count;
    header.active_voxels += tile.getVoxelCount();
    if (with_values)
      header.value_sum += light_of(*tile) * static_cast<double>(tile.getVoxelCount());
    boxes.push_back(box_of(box));
  }
  write_all(descriptor, &header, sizeof header);
  write_all(descriptor, boxes.data(), boxes.size() * sizeof(ActiveBox));
}

} // namespace

void write_shape(const std::string& path, const std::string& wanted, int descriptor) {
  const std::string name = require_density_grid(path, wanted);
  auto& reader = make_immortal<TopologyReader>();
  const openvdb::GridBase& grid = *make_immortal<openvdb::GridBase::Ptr>(reader.read(path, name));
  if (grid.isType<openvdb::FloatGrid>())
    write_tree(static_cast<const openvdb::FloatGrid&>(grid).tree(), reader.has_values(),
               descriptor);
  else
    write_tree(static_cast<const openvdb::DoubleGrid&>(grid).tree(), reader.has_values(),
               descriptor);
}

} // namespace vdbeam
