#pragma once

#include "vdbeam/vec.h"

#include <string>
#include <vector>

namespace vdbeam {

/// How the intensity of a lamp depends on direction, as measured: a photometric file by the
/// standard ANSI/IES LM-63 (its editions of 1986 to 2019), type C. Intensity is interpolated
/// linearly in both angles, and 0 beyond the vertical angles of the file.
class IesProfile {
public:
  /// `text` is the file's, `name` its path, for messages. Throws InputError, opening with path and
  /// line, for what is no such file, other types, and values that no lamp has.
  IesProfile(const std::string& text, const std::string& name);

  /// Relative to the strongest direction, in [0, 1]. `vertical`: degrees from the lamp's axis, the
  /// file's nadir, in [0, 180]; `horizontal`: degrees about it, in [0, 360).
  double at(double vertical, double horizontal) const;
  /// Integral of `at` over all directions [sr].
  double integral() const { return integral_; }
  /// It is the same all around the axis.
  bool is_round() const { return horizontal_.size() == 1; }
  /// Intensity in the strongest direction, as the file has it [cd].
  double candela() const { return candela_; }

private:
  double value(std::size_t horizontal, std::size_t vertical) const {
    return values_[horizontal * vertical_.size() + vertical];
  }
  /// The file's plane, or the mirror image of one, that holds a horizontal angle.
  double folded(double horizontal) const;
  double plane_integral(std::size_t horizontal) const;
  double integrate() const;
  /// Checks the planes' angles, and adds one of 360 degrees where the file ends before it.
  void close_planes(const std::string& where);

  std::vector<double> vertical_, horizontal_; ///< degrees, ascending
  std::vector<double> values_;                ///< all vertical angles of a plane, plane by plane
  double candela_ = 0, integral_ = 0;
};

/// Reads the file, which may have 16 MiB. Throws InputError as the constructor, and as
/// open_input_file does.
IesProfile read_ies_profile(const std::string& path);

} // namespace vdbeam
