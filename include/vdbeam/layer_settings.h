#pragma once

#include <string>

namespace vdbeam {

/// How numbers of a layer are stored: halves where they can hold the values, or floats.
enum class LayerPrecision { half, single };

/// A layer of the picture.
struct LayerSettings {
  std::string name;
  LayerPrecision precision = LayerPrecision::half;
};

} // namespace vdbeam
