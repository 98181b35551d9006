#pragma once

#include <string>
#include <vector>

namespace vdbeam::cli {

/// The notes of a batch. Frames of a sequence mostly have the same ones, which differ in their
/// numbers only: each is printed for the first frame that has it, and at the end with all its
/// frames.
class NoteBook {
public:
  /// Takes a note of a frame down; true for the first of its kind, which is to be printed. Within
  /// one frame every different text counts.
  bool add(const std::string& note, int frame);
  /// "note, in frames 1-24: ..." for those that several frames had, with the first one's numbers.
  std::vector<std::string> repeated() const;

private:
  struct Entry {
    std::string kind, text;
    std::vector<int> frames;
  };
  std::vector<Entry> entries_;
};

} // namespace vdbeam::cli
