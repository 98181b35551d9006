#include "machine/input_file.h"

#include "text/text.h"
#include "vdbeam/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vdbeam {
namespace {

[[noreturn]] void fail(const std::string& path, int error) {
  const char* reason = std::strerror(error);
  if (error == ELOOP)
    reason = "its links lead in a circle";
  else if (error == EACCES || error == EPERM)
    reason = "no permission to read it";
  throw InputError(one_line(path) + ": " + reason);
}

const char* kind_of(mode_t mode) {
  switch (mode & S_IFMT) {
  case S_IFDIR:
    return "a folder";
  case S_IFIFO:
    return "a pipe";
  case S_IFSOCK:
    return "a socket";
  default:
    return "a device";
  }
}

void check_status(const std::string& path, const struct stat& status, EmptyFile empty) {
  if (!S_ISREG(status.st_mode))
    throw InputError(
        fmt::format("{}: is {}, not a regular file", one_line(path), kind_of(status.st_mode)));
  if (status.st_size == 0 && empty == EmptyFile::refused)
    throw FrameError(path + ": is empty (0 bytes): perhaps it is still being copied");
}

} // namespace

InputFile open_input_file(const std::string& path, EmptyFile empty) {
  struct stat status {};
  // Opening some devices does something, so one looks before ...
  if (::stat(path.c_str(), &status) != 0)
    fail(path, errno);
  check_status(path, status, empty);
  // ... and what takes the file's place meanwhile makes nobody wait.
  InputFile file{Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)), 0};
  if (file.descriptor.get() < 0 || ::fstat(file.descriptor.get(), &status) != 0)
    fail(path, errno);
  check_status(path, status, empty);
  file.bytes = static_cast<std::uint64_t>(status.st_size);
  return file;
}

std::uint64_t check_input_file(const std::string& path, EmptyFile empty) {
  return open_input_file(path, empty).bytes;
}

std::size_t read_bytes(const InputFile& file, const std::string& path, void* bytes,
                       std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got =
        ::read(file.descriptor.get(), static_cast<char*>(bytes) + done, count - done);
    if (got < 0 && errno == EINTR)
      continue;
    if (got < 0)
      throw InputError(fmt::format("{}: cannot be read: {}", one_line(path), std::strerror(errno)));
    if (got == 0)
      break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::string read_start(const std::string& path, std::size_t count) {
  const InputFile file = open_input_file(path, EmptyFile::accepted);
  std::string start(count, '\0');
  start.resize(read_bytes(file, path, start.data(), count));
  return start;
}

std::string read_text(const std::string& path, std::uint64_t most) {
  const InputFile file = open_input_file(path, EmptyFile::accepted);
  if (file.bytes > most)
    throw InputError(fmt::format("{}: has {}, more than the {} that such a file may have",
                                 one_line(path), format_bytes(static_cast<double>(file.bytes)),
                                 format_bytes(static_cast<double>(most))));
  std::string text(file.bytes, '\0');
  text.resize(read_bytes(file, path, text.data(), text.size()));
  return text;
}

bool is_there(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 || (errno != ENOENT && errno != ENOTDIR);
}

std::string file_identity(const std::string& path) {
  struct stat status {};
  if (path.empty() || ::stat(path.c_str(), &status) != 0)
    return path;
  return fmt::format("{}|{}|{}|{}.{:09}", path, status.st_ino, status.st_size,
                     status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
}

/// Reads by blocks; `next_` is where in the file the block after this one begins.
class InputStream::Buffer : public std::streambuf {
public:
  Buffer(std::string path, InputFile file)
      : path_(std::move(path)), file_(std::move(file)), block_(std::size_t(64) << 10, '\0') {}

protected:
  int_type underflow() override {
    // A stream takes the exception of a failing disk for its `bad` state.
    const std::size_t got = read_bytes(file_, path_, block_.data(), block_.size());
    setg(block_.data(), block_.data(), block_.data() + got);
    next_ += static_cast<off_type>(got);
    return got == 0 ? traits_type::eof() : traits_type::to_int_type(block_[0]);
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                   std::ios_base::openmode /*which*/) override {
    const off_type here = next_ - (egptr() - gptr());
    const off_type base = from == std::ios_base::beg   ? 0
                          : from == std::ios_base::cur ? here
                                                       : static_cast<off_type>(file_.bytes);
    const off_type target = base + offset;
    if (target == here)
      return target;
    if (target < 0 || ::lseek(file_.descriptor.get(), target, SEEK_SET) < 0)
      return pos_type(off_type(-1));
    next_ = target;
    setg(block_.data(), block_.data(), block_.data());
    return target;
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override {
    return seekoff(off_type(position), std::ios_base::beg, which);
  }

private:
  std::string path_;
  InputFile file_;
  std::string block_;
  off_type next_ = 0;
};

InputStream::InputStream(const std::string& path, EmptyFile empty)
    : InputStream(path, open_input_file(path, empty)) {}

InputStream::InputStream(const std::string& path, InputFile file)
    : std::istream(nullptr), bytes_(file.bytes),
      buffer_(std::make_unique<Buffer>(path, std::move(file))) {
  rdbuf(buffer_.get());
}

InputStream::~InputStream() = default;

} // namespace vdbeam
