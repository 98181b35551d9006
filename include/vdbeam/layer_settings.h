#pragma once

#include <string>

namespace vdbeam {

/// How the numbers of a layer are stored: as docs/output.md says, as halves where they can hold the
/// values, or as floats.
enum class LayerPrecision { automatic, half, single };

/// How an EXR is compressed.
enum class Compression { zip, zips, piz, rle, none, dwaa, dwab };

/// A layer of the picture beside its colours (docs/output.md).
struct LayerSettings {
  std::string name;
  LayerPrecision precision = LayerPrecision::automatic;
};

} // namespace vdbeam
