#pragma once

#include <optional>
#include <toml++/toml.h>
#include <vector>

namespace vdbeam {

/// Which file of a sequence a frame shows: number offset + speed * frame, rounded. The same at all
/// times of a frame.
struct VolumeTime {
  enum class OutOfRange { clip, hold, repeat, ping_pong };

  double offset = 0, speed = 1;
  OutOfRange out_of_range = OutOfRange::hold;

  /// The file's number, where `on_disk` are those there are, sorted; nothing where the frame lies
  /// outside and is to be empty. A number within the range that is not there is given as it is.
  std::optional<int> file_frame(int frame, const std::vector<int>& on_disk) const;
};

/// Reads `time = { offset, speed, out_of_range }`; offset and speed may be animated. `path` is its
/// key. Throws InputError.
VolumeTime read_volume_time(const toml::node& node, const std::string& path, int frame);

} // namespace vdbeam
