#pragma once

#include "vdbeam/error.h"

#include <cstddef>
#include <utility>

namespace vdbeam {

/// An anonymous file in memory (memfd), mapped whole; the parts of it that are not needed any more
/// can be given back early.
class MappedFile {
public:
  MappedFile() = default;
  /// Maps what is in the file now. Throws FrameError where the system refuses.
  explicit MappedFile(int descriptor);
  MappedFile(MappedFile&& other) noexcept { swap(other); }
  MappedFile& operator=(MappedFile&& other) noexcept {
    swap(other);
    return *this;
  }
  ~MappedFile();

  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }
  /// Gives the memory of the first `bytes` back to the system (whole pages; they read as 0 after).
  void release_front(std::size_t bytes);

private:
  void swap(MappedFile& other) {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(released_, other.released_);
  }

  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t released_ = 0;
};

/// A descriptor that closes itself.
class Descriptor {
public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();
  int get() const { return number_; }

private:
  int number_;
};

/// Creates an empty memory file; the descriptor is negative, and errno set, where the system
/// refuses.
Descriptor create_memory_file();

/// A file has reached the limit on its size (RLIMIT_FSIZE).
struct MemoryFileFull : FrameError {
  using FrameError::FrameError;
};

/// Writes all bytes; throws MemoryFileFull where the file may not grow, FrameError where memory is
/// short.
void write_all(int descriptor, const void* bytes, std::size_t count);

} // namespace vdbeam
