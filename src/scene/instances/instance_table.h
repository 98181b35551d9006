#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace vdbeam {

/// One instance of a volume.
struct InstanceRow {
  std::array<double, 12> transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}; ///< row-major 3x4 matrix
  double density = 1; ///< factor of extinction and emission
};

/// What the numbers of a row mean.
class InstanceColumns {
public:
  /// Names, separated by spaces or commas: x y z (default 0), rx ry rz [degrees], scale, sx sy sz,
  /// density; or m00 to m23 for all of the matrix. Throws InputError that says what is wrong with
  /// them.
  explicit InstanceColumns(std::string_view names);

  std::size_t count() const { return columns_.size(); }
  /// Throws InputError that says what is wrong with the numbers.
  InstanceRow row(const std::vector<double>& numbers) const;

private:
  std::vector<std::size_t> columns_; ///< index of each in the list of all names
};

/// The rows of a text file: numbers in lines, separated by spaces, commas or semicolons; # begins a
/// comment, and the first line may name the columns, which else are `columns`. Throws InputError
/// with file and line.
std::vector<InstanceRow> read_instance_file(const std::string& path, const std::string& columns);

/// The matrix that scales, then rotates about the axes X, Y and Z of the world, then moves.
std::array<double, 12> placement_matrix(const std::array<double, 3>& translate,
                                        const std::array<double, 3>& degrees,
                                        const std::array<double, 3>& scale);

/// Greatest number of instances in a scene.
inline constexpr std::size_t most_instances = 200000;

} // namespace vdbeam
