#include "machine/atomic_file.h"

#include "machine/temporary_files.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/types.h>
#include <unistd.h>

namespace vdbeam {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void throw_unwritable(const std::string& path, int error) {
  const char* remedy = "";
  if (error == ENOENT)
    remedy = "; create its folder first";
  else if (error == ENOSPC || error == EDQUOT)
    remedy = "; free some space or write elsewhere";
  else if (error == EACCES || error == EPERM || error == EROFS)
    remedy = "; write to a folder that you own";
  else if (error == EIO || error == ESTALE || error == ETIMEDOUT)
    remedy = "; the disk or its network mount fails: check it or write elsewhere";
  throw FrameError(fmt::format("{}: cannot be written: {}{}", path, std::strerror(error), remedy));
}

/// The file behind `path` if it is a symbolic link, so that the link survives the rename.
std::string resolve_target(const std::string& path, Links links) {
  std::error_code error;
  if (links == Links::replace && fs::is_symlink(path, error))
    return path;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    return path;
  if (fs::is_directory(status))
    throw_unwritable(path, EISDIR);
  // Renaming over a device would replace the device.
  if (!fs::is_regular_file(status))
    throw FrameError(path + ": cannot be written: not a regular file; give a file name");
  const fs::path resolved = fs::canonical(path, error);
  return error ? path : resolved.string();
}

/// Opens a new file beside `target`; its mode follows the umask, unlike mkstemp's.
int open_temporary(const std::string& target, std::string& temporary) {
  const fs::path folder = fs::path(target).parent_path();
  const std::string name = fs::path(target).filename().string();
  for (int attempt = 0; attempt < 100; ++attempt) {
    temporary = (folder / temporary_name(name)).string();
    const int descriptor = open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != EEXIST)
      return -1;
    if (descriptor >= 0 && lock_temporary(descriptor)) {
      remove_stale_temporaries(folder.string(), descriptor);
      return descriptor;
    }
    if (descriptor >= 0)
      close(descriptor);
  }
  return -1;
}

void sync_folder(const std::string& target) {
  const fs::path folder = fs::path(target).parent_path() / ".";
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return;
  // Some file systems cannot sync a folder; the file itself is already safe then.
  (void)fsync(descriptor);
  close(descriptor);
}

} // namespace

AtomicFile::AtomicFile(const std::string& path, Links links) : path_(path) {
  if (path.empty())
    throw FrameError("an output file has an empty name; give a file name");
  target_ = resolve_target(path, links);
  const int descriptor = open_temporary(target_, temporary_);
  if (descriptor < 0)
    throw_unwritable(path_, errno);
  file_ = fdopen(descriptor, "w+b");
  if (!file_) {
    const int error = errno;
    close(descriptor);
    unlink(temporary_.c_str());
    throw_unwritable(path_, error);
  }
}

AtomicFile::~AtomicFile() {
  if (!file_)
    return;
  std::fclose(file_);
  unlink(temporary_.c_str());
}

void AtomicFile::fail(int error) {
  if (error_ == 0)
    error_ = error != 0 ? error : EIO;
  throw_unwritable(path_, error_);
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  if (std::fwrite(data, 1, bytes, file_) != bytes)
    fail(errno);
}

std::uint64_t AtomicFile::position() const {
  return static_cast<std::uint64_t>(ftello(file_));
}

void AtomicFile::seek(std::uint64_t position) {
  if (fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0)
    fail(errno);
}

void AtomicFile::commit(Synced synced) {
  if (error_ != 0)
    fail(error_);
  if (std::fflush(file_) != 0 || (synced == Synced::yes && fsync(fileno(file_)) != 0))
    fail(errno);
  std::FILE* file = file_;
  file_ = nullptr;
  // Another descriptor keeps the lock, without which the file would look like a dead process's.
  const int lock = fcntl(fileno(file), F_DUPFD_CLOEXEC, 0);
  const bool done = std::fclose(file) == 0 && std::rename(temporary_.c_str(), target_.c_str()) == 0;
  const int error = errno;
  if (!done)
    unlink(temporary_.c_str());
  close(lock);
  if (!done)
    fail(error);
  if (synced == Synced::yes)
    sync_folder(target_);
}

} // namespace vdbeam
