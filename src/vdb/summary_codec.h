#pragma once

#include "vdb/vdb_reader.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbeam {

/// A summary as CBOR, on its way out of the reader process.
std::vector<std::uint8_t> encode_summary(const GridSummary& summary);

/// The reverse. Throws FrameError, opening with `label`, where the bytes are no summary.
GridSummary decode_summary(const std::string& label, const std::byte* bytes, std::size_t count);

} // namespace vdbeam
