#include "scene/content_hash.h"

#include "vdbeam/error.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <sys/stat.h>
#include <vector>

namespace vdbeam {
namespace {

constexpr std::uint64_t odd_1 = 0x9e3779b97f4a7c15, odd_2 = 0xd6e8feb86659fd93;

/// A bijection in which every input bit reaches every output bit.
std::uint64_t scramble(std::uint64_t x) {
  x ^= x >> 32;
  x *= odd_2;
  x ^= x >> 32;
  x *= odd_2;
  return x ^ (x >> 32);
}

} // namespace

void ContentHash::add_block(const unsigned char* block) {
  for (int i = 0; i < 4; ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, block + 8 * i, 8);
    lanes_[i] = std::rotl((lanes_[i] ^ word) * odd_1, 29) * odd_2;
  }
}

void ContentHash::add(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  total_ += size;
  if (pending_size_ > 0) {
    const std::size_t taken = std::min(size, sizeof pending_ - pending_size_);
    std::memcpy(pending_ + pending_size_, bytes, taken);
    pending_size_ += taken;
    bytes += taken;
    size -= taken;
    if (pending_size_ < sizeof pending_)
      return;
    add_block(pending_);
    pending_size_ = 0;
  }
  for (; size >= sizeof pending_; bytes += sizeof pending_, size -= sizeof pending_)
    add_block(bytes);
  std::memcpy(pending_, bytes, size);
  pending_size_ = size;
}

std::uint64_t ContentHash::value() const {
  ContentHash end = *this;
  if (end.pending_size_ > 0) {
    std::memset(end.pending_ + end.pending_size_, 0, sizeof end.pending_ - end.pending_size_);
    end.add_block(end.pending_);
  }
  std::uint64_t result = scramble(total_);
  for (const std::uint64_t lane : end.lanes_)
    result = scramble(result ^ lane) * odd_1;
  return scramble(result);
}

namespace {

std::uint64_t hash_contents(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw InputError(path + ": cannot be opened");
  ContentHash hash;
  std::vector<char> buffer(1 << 20);
  while (stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) ||
         stream.gcount() > 0)
    hash.add(buffer.data(), static_cast<std::size_t>(stream.gcount()));
  if (stream.bad())
    throw InputError(path + ": cannot be read");
  return hash.value();
}

/// A file's hash and the state of the file that it belongs to.
struct KnownFile {
  struct stat status {};
  std::uint64_t hash = 0;
};

/// File systems tell times in ticks: a file that changed just now may change again unseen.
bool settled(const struct stat& status) {
  constexpr time_t ticks = 2; // FAT counts two seconds at a time
  return std::time(nullptr) - std::max(status.st_mtim.tv_sec, status.st_ctim.tv_sec) > ticks;
}

bool same_state(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
         a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec == b.st_mtim.tv_nsec &&
         a.st_ctim.tv_sec == b.st_ctim.tv_sec && a.st_ctim.tv_nsec == b.st_ctim.tv_nsec;
}

} // namespace

std::uint64_t hash_file(const std::string& path) {
  // A volume or sky that many frames share is read for its hash once.
  static std::mutex mutex;
  static std::map<std::string, KnownFile> known;
  KnownFile file;
  const bool has_state = stat(path.c_str(), &file.status) == 0 && settled(file.status);
  if (has_state) {
    const std::scoped_lock lock(mutex);
    const auto found = known.find(path);
    if (found != known.end() && same_state(found->second.status, file.status))
      return found->second.hash;
  }
  file.hash = hash_contents(path);
  if (has_state) {
    const std::scoped_lock lock(mutex);
    known[path] = file;
  }
  return file.hash;
}

} // namespace vdbeam
