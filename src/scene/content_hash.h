#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace vdbeam {

/// A fast 64-bit hash of bytes, the same on every machine of one byte order; not for security.
/// 8 bytes at a time in four independent lanes of multiply and rotate, so that it keeps up with the
/// disk cache.
class ContentHash {
public:
  void add(const void* data, std::size_t size);
  void add_number(std::uint64_t x) { add(&x, sizeof x); }
  /// Of everything so far.
  std::uint64_t value() const;

private:
  void add_block(const unsigned char* block);

  std::uint64_t lanes_[4] = {0x9e3779b97f4a7c15, 0xc2b2ae3d27d4eb4f, 0x165667b19e3779f9,
                             0x27d4eb2f165667c5};
  unsigned char pending_[32] = {};
  std::size_t pending_size_ = 0;
  std::uint64_t total_ = 0;
};

/// Hash of a file's bytes. Throws InputError where it cannot be read.
std::uint64_t hash_file(const std::string& path);

} // namespace vdbeam
