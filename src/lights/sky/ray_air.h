#pragma once

#include "math/opacity.h"
#include "vdbeam/vec.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

/// The air along one line of sight (AerialPerspective, whose tables it reads). Without tables there
/// is none: all light passes, and none is added.
class RayAir {
public:
  /// Table entries at one line of sight of the table, by distance.
  struct Column {
    const Rgb* depth = nullptr;  ///< optical depth over distance, per metre
    const Rgb* source = nullptr; ///< radiance over what is taken from light, 1 - exp(-depth)
    float weight = 0;
  };
  static constexpr int columns = 4;

  /// Entries lie at `length` (i / (knots - 1))³ metres.
  struct Table {
    Column column[columns];
    int knots = 0;
    double length = 0;
    double metres = 1; ///< per unit of the distances that are asked for
    double shift = 0;  ///< is added to these
  };

  RayAir() = default;
  explicit RayAir(const Table& table) : table_(table) {}
  explicit operator bool() const { return table_.knots > 0; }

  struct Seen {
    Rgb left{1, 1, 1}; ///< what the air lets through of light from there
    Rgb light;         ///< what it adds in between
  };
  /// At the distance t along the ray, which may be infinite.
  Seen at(float t) const {
    if (table_.knots == 0)
      return {};
    const Place place = place_of(t);
    Rgb depth, source;
    for (const Column& column : table_.column) {
      depth += read(column.depth, place) * column.weight;
      source += read(column.source, place) * column.weight;
    }
    Seen seen;
    for (int c = 0; c < 3; ++c) {
      const float tau = depth[c] * place.metres;
      seen.left[c] = std::exp(-tau);
      seen.light[c] = source[c] * opacity_of(tau);
    }
    return seen;
  }
  /// What the air lets through of light from there.
  Rgb left(float t) const {
    if (table_.knots == 0)
      return Rgb(1);
    const Place place = place_of(t);
    Rgb depth;
    for (const Column& column : table_.column)
      depth += read(column.depth, place) * column.weight;
    return transmittance_of(depth * place.metres);
  }

private:
  struct Place {
    int knot;
    float rest, metres;
  };
  Place place_of(float t) const {
    const double metres =
        std::clamp((static_cast<double>(t) + table_.shift) * table_.metres, 0.0, table_.length);
    const double scaled = std::cbrt(metres / table_.length) * (table_.knots - 1);
    const int knot = std::min(static_cast<int>(scaled), table_.knots - 2);
    return {knot, static_cast<float>(scaled - knot), static_cast<float>(metres)};
  }
  static Rgb read(const Rgb* values, const Place& place) {
    const Rgb& a = values[place.knot];
    return a + (values[place.knot + 1] - a) * place.rest;
  }

  Table table_;
};

} // namespace vdbeam
