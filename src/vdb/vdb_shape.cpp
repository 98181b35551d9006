#include "vdb/vdb_shape.h"

#include "machine/mapped_file.h"
#include "vdb/grid_shape.h"
#include "vdb/vdb_parse.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <cstring>
#include <fstream>
#include <map>

namespace vdbeam {
namespace {

/// Reads the tree of a grid without its voxels' values, which lie behind it in the file. OpenVDB's
/// own File does that for delayed loading only.
class TopologyReader : public openvdb::io::Archive {
public:
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
  static openvdb::GridBase::Ptr read_topology(std::istream& stream,
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
    if (!stream)
      throw openvdb::IoError("cut short");
    return grid;
  }
};

ActiveBox box_of(const openvdb::CoordBBox& box) {
  return {{box.min().x(), box.min().y(), box.min().z()},
          {box.max().x(), box.max().y(), box.max().z()}};
}

template <class Tree>
void write_tree(const Tree& tree, ShapeHeader header, int descriptor) {
  header.value_bytes = sizeof(typename Tree::ValueType);
  std::vector<ActiveBox> boxes;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    openvdb::CoordBBox box;
    leaf->evalActiveBoundingBox(box);
    ++header.leaf_count;
    header.active_voxels += leaf->onVoxelCount();
    // A leaf without active voxels may hold values all the same.
    boxes.push_back(box_of(leaf->onVoxelCount() > 0 ? box : leaf->getNodeBoundingBox()));
  }
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
  ShapeHeader header;
  if (grid.isType<openvdb::FloatGrid>())
    write_tree(static_cast<const openvdb::FloatGrid&>(grid).tree(), header, descriptor);
  else
    write_tree(static_cast<const openvdb::DoubleGrid&>(grid).tree(), header, descriptor);
}

} // namespace vdbeam
