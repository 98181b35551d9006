#pragma once

#include <optional>
#include <string>

namespace vdbeam {

/// Storage of a layer: automatic (docs/reference/output.md), halves where they can hold the values,
/// or floats.
enum class LayerPrecision { automatic, half, single };

/// Compression of an EXR.
enum class Compression { zip, zips, piz, rle, none, dwaa, dwab };

/// Parts of an EXR: one for all layers, or one for each.
enum class ImageParts { one, layers };

/// Naming convention of the layers of an EXR (docs/reference/output.md).
enum class LayerNames { vdbeam, arnold, cycles };

/// A layer of the image beside its colours (docs/reference/output.md).
struct LayerSettings {
  std::string name;
  LayerPrecision precision = LayerPrecision::automatic;
  /// Compression of its part, if layers have parts of their own; absent: that of the image.
  std::optional<Compression> compression = std::nullopt;
};

} // namespace vdbeam
