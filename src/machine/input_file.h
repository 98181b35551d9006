#pragma once

#include "machine/mapped_file.h"

#include <cstdint>
#include <istream>
#include <memory>
#include <string>

namespace vdbeam {

/// A file that is open for reading.
struct InputFile {
  Descriptor descriptor;
  std::uint64_t bytes = 0; ///< its size when it was opened
};

/// Whether a file of 0 bytes is an error.
enum class EmptyFile { refused, accepted };

/// Opens a file of the user; every file that is read is opened here, or checked here before its
/// path goes to a library. Never waits: throws InputError, with path and reason, for what is not a
/// regular file (a named pipe, a socket, a device, a folder), where there is none, where links lead
/// in a circle and where it may not be read. Throws FrameError for a refused empty file: another
/// program may still be writing it.
InputFile open_input_file(const std::string& path, EmptyFile empty = EmptyFile::refused);

/// Throws as open_input_file and returns the size [bytes]: for a path that a library will open.
std::uint64_t check_input_file(const std::string& path, EmptyFile empty = EmptyFile::refused);

/// Up to `count` bytes of the file, from the place where it was read last. Throws InputError where
/// the disk fails.
std::size_t read_bytes(const InputFile& file, const std::string& path, void* bytes,
                       std::size_t count);

/// The first bytes of a file, fewer where it is shorter. Throws as open_input_file; may be empty.
std::string read_start(const std::string& path, std::size_t count);

/// All of a file, which may be empty. Throws as open_input_file, and InputError where it is larger
/// than `most` bytes.
std::string read_text(const std::string& path, std::uint64_t most);

/// True where something has this name, whether or not it can be read; a link that leads nowhere
/// does not count.
bool is_there(const std::string& path);

/// Identifies a state of a file: its path, size and time of change; the path alone for a missing
/// file.
std::string file_identity(const std::string& path);

/// A stream over an input file, which can be sought in. Throws as open_input_file.
class InputStream : public std::istream {
public:
  explicit InputStream(const std::string& path, EmptyFile empty = EmptyFile::refused);
  ~InputStream() override;

  std::uint64_t bytes() const { return bytes_; }

private:
  InputStream(const std::string& path, InputFile file);

  class Buffer;
  std::uint64_t bytes_;
  std::unique_ptr<Buffer> buffer_;
};

} // namespace vdbeam
