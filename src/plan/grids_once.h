#pragma once

#include "vdb/grid_shape.h"
#include "vdb/vdb_reader.h"

#include <map>
#include <string>
#include <utility>

namespace vdbeam {

/// Headers and shapes of grids, each read once: every reading starts a guarded process, and a scene
/// may name the same file a thousand times. Throws as read_grid_header and read_grid_shape do.
class GridsOnce {
public:
  const GridSummary& header(const std::string& file, const std::string& grid) {
    return find(headers_, file, grid, [&] { return read_grid_header(file, grid); });
  }
  const GridShape& shape(const std::string& file, const std::string& grid) {
    return find(shapes_, file, grid, [&] { return read_grid_shape(file, grid); });
  }

private:
  template <class Map, class Read>
  static const typename Map::mapped_type& find(Map& map, const std::string& file,
                                               const std::string& grid, const Read& read) {
    const std::pair<std::string, std::string> name(file, grid);
    const auto found = map.find(name);
    return found != map.end() ? found->second : map.emplace(name, read()).first->second;
  }

  std::map<std::pair<std::string, std::string>, GridSummary> headers_;
  std::map<std::pair<std::string, std::string>, GridShape> shapes_;
};

} // namespace vdbeam
