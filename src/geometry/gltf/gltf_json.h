#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace vdbeam {

/// The JSON of a .gltf or .glb file; what is no JSON gives a value that is_discarded(). Throws as
/// open_input_file. For guarded processes: a file may ask for endless memory.
nlohmann::json read_gltf_json(const std::string& path);

/// The text of the JSON in a .glb file, at most 64 MiB of it. Throws as open_input_file.
std::string read_glb_text(const std::string& path);

/// How many values an accessor has. Throws nlohmann::json::exception where there is none.
std::uint64_t accessor_count(const nlohmann::json& gltf, const nlohmann::json& index);

} // namespace vdbeam
