#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace vdbeam {

/// Treatment of a symbolic link at the path of an output: it stays, and the file that it leads
/// to is replaced, or the file takes its place.
enum class Links { follow, replace };

/// Whether a file survives a power failure. `no`: it will be replaced soon, and nobody waits for
/// the disk.
enum class Synced { yes, no };

/// A file that appears under its name only when it is complete. Writes go to a temporary name in
/// the same folder; commit() syncs it to the disk and renames it; without commit() it is removed.
/// Temporary files of killed processes are removed when a file is created in their folder.
class AtomicFile {
public:
  /// Creates the temporary file. Throws FrameError where the folder is missing or not writable, or
  /// where `path` names something other than a regular file. Links are followed where the user
  /// gave the name; nobody should find another file replaced by a link planted under a name that
  /// the program made up.
  explicit AtomicFile(const std::string& path, Links links = Links::follow);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& path() const { return path_; }
  /// Appends at the position. Throws FrameError with the system's reason (disk full, quota).
  void write(const void* data, std::size_t bytes);
  std::uint64_t position() const;
  void seek(std::uint64_t position);
  /// Makes the file visible. Throws FrameError, also for a write that failed earlier and whose
  /// exception somebody in between swallowed.
  void commit(Synced synced = Synced::yes);

private:
  [[noreturn]] void fail(int error);

  std::string path_;   ///< as the user gave it, for messages
  std::string target_; ///< with symbolic links resolved, if they are followed
  std::string temporary_;
  std::FILE* file_ = nullptr;
  int error_ = 0; ///< errno of the first failure
};

} // namespace vdbeam
