#pragma once

#include "machine/atomic_file.h"
#include "vdbeam/image_file.h"

#include <span>
#include <string>
#include <string_view>

namespace vdbeam {

/// Options of a writer.
struct WriteOptions {
  double exposure = 0;         ///< stops, for 8-bit formats
  std::string view = "filmic"; ///< view transform of 8-bit formats
  Links links = Links::follow; ///< of an EXR
  ImageLife life = ImageLife::lasting;
};

/// One kind of output file.
struct OutputFormat {
  std::string_view extension;   ///< lower case, with its dot
  std::string_view description; ///< for --help
  /// Every channel and attribute in full: such a file can hold a partial image, and
  /// records scene and frame.
  bool complete = false;
  void (*write)(const Image& image, const std::string& path, const WriteOptions& options);
};

/// Every format, in the order of --help. A new one is a writer and one line of this table.
std::span<const OutputFormat> output_formats();

/// ".exr or .png", for help and messages.
std::string output_extensions();

/// The format of a path, by its extension without regard to case. Throws InputError, naming the
/// known ones.
const OutputFormat& output_format(const std::string& path);

/// Writes `image` in the format that the extension of `path` names. Throws InputError for an
/// unknown extension and FrameError where the file cannot be written.
void write_image(const Image& image, const std::string& path, const WriteOptions& options = {});

} // namespace vdbeam
