#include "machine/temporary_files.h"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <regex>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace vdbeam {
namespace {

namespace fs = std::filesystem;

constexpr std::time_t day = 24 * 60 * 60;

const std::string& machine() {
  static const std::string digits = [] {
    std::string id;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
    if (id.size() >= 8)
      return id.substr(0, 8);
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    return fmt::format("{:08x}", std::hash<std::string>()(host) & 0xffffffffu);
  }();
  return digits;
}

/// The machine in a temporary file's name; nothing for other files.
std::optional<std::string> machine_of(const std::string& name) {
  static const std::regex pattern("\\..*\\.([0-9a-f]{8})-[0-9]+-[0-9]+\\.tmp");
  std::smatch match;
  if (!std::regex_match(name, match, pattern))
    return std::nullopt;
  return match[1].str();
}

void remove_if_stale(const fs::path& path, bool of_this_machine, std::time_t now) {
  const int descriptor = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0)
    return;
  struct stat status {};
  const bool lock_taken = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  const bool in_use = !lock_taken && errno == EWOULDBLOCK; // else there are no locks here
  if (!in_use && fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode)) {
    const bool old = now > status.st_mtime + day;
    if (old || (of_this_machine && lock_taken))
      unlink(path.c_str());
  }
  close(descriptor);
}

/// True at the first visit of a folder. `creates`: the visitor creates a file there; such visits
/// are counted apart from others.
bool is_first_visit(const std::string& folder, bool creates) {
  static std::mutex mutex;
  static std::set<std::pair<std::string, bool>> visited;
  const std::lock_guard lock(mutex);
  return visited.emplace(folder, creates).second;
}

/// `now`: the time of the file system's clock.
void remove_stale(const std::string& folder, std::time_t now) {
  std::error_code error;
  for (fs::directory_iterator it(folder.empty() ? "." : folder, error), end; !error && it != end;
       it.increment(error))
    if (const auto writer = machine_of(it->path().filename().string()))
      remove_if_stale(it->path(), *writer == machine(), now);
}

} // namespace

std::string temporary_name(const std::string& name) {
  static std::atomic<unsigned> counter{0};
  // Cut so that it stays within the usual limit of 255 bytes.
  return fmt::format(".{}.{}-{}-{}.tmp", name.substr(0, 200), machine(), getpid(), counter++);
}

bool lock_temporary(int descriptor) {
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    return false;
  struct stat status {};
  return fstat(descriptor, &status) != 0 || status.st_nlink > 0;
}

void remove_stale_temporaries(const std::string& folder, int like) {
  struct stat status {};
  if (fstat(like, &status) == 0 && is_first_visit(folder, true))
    remove_stale(folder, status.st_mtime);
}

void remove_dead_temporaries(const std::string& folder) {
  if (is_first_visit(folder, false))
    remove_stale(folder, std::numeric_limits<std::time_t>::min());
}

} // namespace vdbeam
