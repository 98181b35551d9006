#include "scene/content_hash.h"

#include "machine/input_file.h"
#include "machine/stop_reading.h"

#include <algorithm>
#include <ctime>
#include <map>
#include <mutex>
#include <new>
#include <sys/stat.h>
#include <vector>
#include <xxhash.h>

namespace vdbeam {

ContentHash::ContentHash() : state_(XXH3_createState()) {
  if (!state_ || XXH3_64bits_reset(state_.get()) == XXH_ERROR)
    throw std::bad_alloc();
}

void ContentHash::Delete::operator()(XXH3_state_s* state) const {
  XXH3_freeState(state);
}

void ContentHash::add(const void* data, std::size_t size) {
  XXH3_64bits_update(state_.get(), data, size);
}

std::uint64_t ContentHash::value() const {
  return XXH3_64bits_digest(state_.get());
}

namespace {

std::uint64_t hash_contents(const std::string& path) {
  const InputFile file = open_input_file(path, EmptyFile::accepted);
  ContentHash hash;
  std::vector<char> buffer(1 << 20);
  while (const std::size_t got = read_bytes(file, path, buffer.data(), buffer.size())) {
    hash.add(buffer.data(), got);
    StopReading::check();
  }
  return hash.value();
}

/// A file's hash and the state of the file that it belongs to.
struct KnownFile {
  struct stat status {};
  std::uint64_t hash = 0;
};

/// File systems round times to ticks: a file that changed just now may change again unseen.
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
