#include "machine/input_file.h"

#include "vdbeam/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace vdbeam {

InputFile open_input_file(const std::string& path) {
  // Asked before it is opened, since opening a named pipe would wait for a writer.
  struct stat status;
  if (::stat(path.c_str(), &status) != 0)
    throw InputError(fmt::format("{}: {}", path, std::strerror(errno)));
  if (!S_ISREG(status.st_mode))
    throw InputError(path + ": is not a regular file");
  if (status.st_size == 0)
    throw FrameError(path + ": is empty (0 bytes): perhaps it is still being copied");
  InputFile file{Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC)),
                 static_cast<std::uint64_t>(status.st_size)};
  if (file.descriptor.get() < 0)
    throw InputError(fmt::format("{}: {}", path, std::strerror(errno)));
  return file;
}

std::string file_identity(const std::string& path) {
  struct stat status {};
  if (path.empty() || ::stat(path.c_str(), &status) != 0)
    return path;
  return fmt::format("{}|{}|{}|{}.{:09}", path, status.st_ino, status.st_size,
                     status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
}

} // namespace vdbeam
