#pragma once

#include <optional>
#include <string>

namespace vdbeam {

/// How the numbers of a layer are stored: as docs/reference/output.md says, as halves where they
/// can hold the values, or as floats.
enum class LayerPrecision { automatic, half, single };

/// How an EXR is compressed.
enum class Compression { zip, zips, piz, rle, none, dwaa, dwab };

/// Whether the layers of an EXR share one part, or have one each.
enum class ImageParts { one, layers };

/// After whose renderer the layers of an EXR are named (docs/reference/output.md).
enum class LayerNames { vdbeam, arnold, cycles };

/// A layer of the picture beside its colours (docs/reference/output.md).
struct LayerSettings {
  std::string name;
  LayerPrecision precision = LayerPrecision::automatic;
  /// Compression of its part, if layers have parts of their own; absent: that of the image.
  std::optional<Compression> compression = std::nullopt;
};

} // namespace vdbeam
