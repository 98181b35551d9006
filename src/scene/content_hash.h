#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

struct XXH3_state_s;

namespace vdbeam {

/// 64-bit XXH3 hash of bytes, the same on every machine of one byte order; not for security.
class ContentHash {
public:
  ContentHash();

  void add(const void* data, std::size_t size);
  void add_number(std::uint64_t x) { add(&x, sizeof x); }
  /// Hash of everything added so far.
  std::uint64_t value() const;

private:
  struct Delete {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Delete> state_;
};

/// Hash of a file's bytes. Throws InputError where it cannot be read, and Stopped (StopReading).
std::uint64_t hash_file(const std::string& path);

} // namespace vdbeam
