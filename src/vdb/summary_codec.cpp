#include "vdb/summary_codec.h"

#include "vdbeam/error.h"

#include <nlohmann/json.hpp>

namespace vdbeam {

namespace {

/// Hands every field to `field(key, reference)`, for writing and for reading alike.
template <class Summary, class Field>
void for_each_field(Summary& s, Field field) {
  field("name", s.name);
  field("value_type", s.value_type);
  field("grid_class", s.grid_class);
  field("map_type", s.map_type);
  field("saved_as_half", s.saved_as_half);
  field("active_voxels", s.active_voxels);
  field("leaf_count", s.leaf_count);
  field("tile_count", s.tile_count);
  const char* const axes[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const auto key = [&](const char* name) { return std::string(name) + axes[axis]; };
    field(key("index_lower_"), s.index_lower[axis]);
    field(key("index_upper_"), s.index_upper[axis]);
    field(key("world_lower_"), s.world_bounds.lower[axis]);
    field(key("world_upper_"), s.world_bounds.upper[axis]);
    field(key("voxel_size_"), s.voxel_size[axis]);
    field(key("translation_"), s.index_to_world.translation[axis]);
    for (int column = 0; column < 3; ++column)
      field(key("row_") + axes[column], s.index_to_world.rows[axis][column]);
  }
  field("minimum", s.minimum);
  field("maximum", s.maximum);
  field("mean", s.mean);
  field("background", s.background);
  field("nan", s.bad_values.nan);
  field("infinite", s.bad_values.infinite);
  field("negative", s.bad_values.negative);
  field("from_mantaflow", s.from_mantaflow);
  field("outline", s.outline);
}

} // namespace

std::vector<std::uint8_t> encode_summary(const GridSummary& summary) {
  nlohmann::json json;
  GridSummary fields = summary;
  for_each_field(fields, [&json](const std::string& key, const auto& value) { json[key] = value; });
  return nlohmann::json::to_cbor(json);
}

GridSummary decode_summary(const std::string& label, const std::byte* bytes, std::size_t count) {
  GridSummary summary;
  try {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes);
    const nlohmann::json json = nlohmann::json::from_cbor(begin, begin + count);
    for_each_field(summary,
                   [&json](const std::string& key, auto& value) { json.at(key).get_to(value); });
  } catch (const nlohmann::json::exception&) {
    throw FrameError(label + ": the file is corrupt");
  }
  return summary;
}

} // namespace vdbeam
