#include "machine/mapped_file.h"

#include "vdbeam/error.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vdbeam {

namespace {

[[noreturn]] void fail(const char* what) {
  throw FrameError(fmt::format("{}: {}", what, std::strerror(errno)));
}

} // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0)
    ::close(number_);
}

Descriptor create_memory_file() {
  return Descriptor(::memfd_create("vdbeam-grid", MFD_CLOEXEC));
}

void write_all(int descriptor, const void* bytes, std::size_t count) {
  const auto* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(descriptor, next, count);
    if (written < 0 && errno == EINTR)
      continue;
    if (written < 0 && errno == EFBIG)
      throw MemoryFileFull("a file in memory may not grow as far as needed");
    if (written <= 0)
      fail("cannot keep the grid in memory");
    next += written;
    count -= static_cast<std::size_t>(written);
  }
}

MappedFile::MappedFile(int descriptor) {
  struct stat status;
  if (::fstat(descriptor, &status) != 0)
    fail("cannot read a file in memory");
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0)
    return;
  void* address = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (address == MAP_FAILED)
    fail("cannot map a file in memory");
  data_ = static_cast<std::byte*>(address);
}

MappedFile::~MappedFile() {
  if (data_ != nullptr)
    ::munmap(data_, size_);
}

void MappedFile::release_front(std::size_t bytes) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t end = bytes / page * page;
  // Small pieces are not worth a system call; the rest goes with the mapping.
  constexpr std::size_t worthwhile = std::size_t(4) << 20;
  if (end < released_ + worthwhile)
    return;
  ::madvise(data_ + released_, end - released_, MADV_REMOVE);
  released_ = end;
}

} // namespace vdbeam
