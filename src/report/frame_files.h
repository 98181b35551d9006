#pragma once

#include <span>
#include <string>

namespace vdbeam {

/// Files that the user names for a render; each may hold a frame number's place, and all but the
/// first be empty.
struct FrameFiles {
  std::string output{}, preview{}, report{}, reference{}, second_reference{};
  std::string summary{}; ///< of all frames; a frame number's place is that of the first one
  std::string html{};    ///< folder of the page of all frames

  /// Images that passes are compared with.
  int references() const { return !reference.empty() + !second_reference.empty(); }
};

/// A file that a render writes.
enum class Output { image, deep, checkpoint, snapshot, preview, report, summary, page, thumbnail };

/// Everything that is known about an output. Whoever writes, checks or claims files asks this
/// table, so that a new output is one line in it.
struct OutputKind {
  Output output;
  const char* name;                ///< for messages: an option, or "the checkpoint of -o"
  std::string FrameFiles::*option; ///< what the user gives
  const char* side = "";           ///< "checkpoint": beside that file, as out.checkpoint.exr
  bool is_text = false;            ///< may be "-", the standard output
  bool of_all_frames = false;      ///< one file for all of them
  const char* in_folder = "";      ///< the option names a folder, this the file in it

  bool is_side_file() const { return *side != '\0'; }
  /// With the frame number's place; empty where nobody asks for it.
  std::string pattern(const FrameFiles& files) const;
};

/// Every output, in the order above.
std::span<const OutputKind> output_kinds();

/// The path of an output; empty where nobody asks for it. Of all frames: that of the first of them.
std::string output_path(const FrameFiles& files, Output output, int frame);

} // namespace vdbeam
