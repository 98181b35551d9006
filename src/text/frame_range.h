#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// Frames of "1-24", "1-100x2", "1-100:2", "1,5,9-12", "10-1", "-5--1": a comma list of numbers and
/// ranges, each range with an optional positive step after `x` or `:`. Sorted, without doubles.
/// Throws InputError for anything else and for more than a million frames.
std::vector<int> parse_frame_range(const std::string& text);

/// The shortest such text for these frames, e.g. "1-24" or "1,5,9-12".
std::string format_frame_range(const std::vector<int>& frames);

/// True where the path holds a frame number's place: `####` (one digit each; a single `#` is four),
/// `@@@@` (at least two), `%04d` or `%d`, `$F4`, `${F4}` or `<F4>`, and each of these without
/// digits.
bool has_frame_pattern(const std::string& path);

/// The path with every such place filled in, as printf's %0Nd would write the number.
std::string substitute_frame(const std::string& path, int frame);

/// A placeholder in a file's name that does not stand for the frame number: "<UDIM>",
/// "<frame>" (of how many digits?), "%V", "*". Empty where there is no such thing.
std::string foreign_token(const std::string& path);

/// The first placeholder of a name, of a frame number or any other; empty where there is none.
std::string first_token(const std::string& name);

/// The pattern that a file of a sequence follows: "smoke.0020.vdb" gives "smoke.####.vdb", by the
/// last digits of its name. Empty for a name without digits.
std::string frame_pattern_of(const std::string& path);

/// Frames for which a file of this pattern exists, sorted. The pattern must be in the file's name,
/// not in a folder's; without a pattern, or without such files, the list is empty.
std::vector<int> frames_on_disk(const std::string& pattern);

} // namespace vdbeam
