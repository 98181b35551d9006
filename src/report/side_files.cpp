#include "report/side_files.h"

#include "image/plane_file.h"
#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <sys/stat.h>
#include <unistd.h>

namespace vdbeam {
namespace {

/// Kind of a file by its attributes.
enum class Content { film, snapshot, other };

/// A damaged file is still ours where its header can be recognised.
Content content_of_damaged(const std::string& path) {
  constexpr std::size_t most = 64 << 10; // a header has some kilobytes
  const std::string start = read_start(path, most);
  const auto holds = [&](const char* text) { return start.find(text) != std::string::npos; };
  if (!start.starts_with("\x76\x2f\x31\x01") || !holds("vdbeam:sceneHash"))
    return Content::other;
  if (holds("vdbeam:film"))
    return Content::film;
  return holds("vdbeam:complete") ? Content::other : Content::snapshot;
}

Content content_of(const std::string& path) {
  try {
    const Image header = read_exr_header(path);
    if (header.metadata.contains("vdbeam:film"))
      return Content::film;
    if (!header.metadata.contains("vdbeam:sceneHash")) // the header may be cut by damage
      return content_of_damaged(path);
    // An image that its limit ended says so, also where it is no more than a quick look.
    const auto stopped = header.metadata.find("vdbeam:stoppedBy");
    const bool goes_on =
        stopped != header.metadata.end() && (stopped->second.empty() || stopped->second == "stop");
    return goes_on && !header.numbers.contains("vdbeam:complete") ? Content::snapshot
                                                                  : Content::other;
  } catch (const InputError&) {
    return content_of_damaged(path);
  }
}

/// True for a file, reached by no link, that is what a render leaves under such a name.
bool is_ours(const std::string& path, const struct stat& status, Output kind) {
  if (!S_ISREG(status.st_mode) || status.st_size == 0)
    return false;
  try {
    return content_of(path) == (kind == Output::checkpoint ? Content::film : Content::snapshot);
  } catch (const Error&) { // not readable
    return false;
  }
}

} // namespace

std::string why_not_replaceable(const std::string& path, Output kind) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0)
    return "";
  if (S_ISLNK(status.st_mode))
    return one_line(path) + ": is a link, which is not followed";
  if ((S_ISREG(status.st_mode) && status.st_size == 0) || is_ours(path, status, kind))
    return "";
  return one_line(path) + (kind == Output::checkpoint ? ": is no checkpoint by vdbeam"
                                                      : ": is no snapshot by vdbeam");
}

void remove_side_file(const std::string& path, Output kind) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0 && is_ours(path, status, kind))
    ::unlink(path.c_str()); // one that stays does no harm
}

bool holds_film(const std::string& path) {
  try {
    return content_of(path) == Content::film;
  } catch (const Error&) {
    return false;
  }
}

} // namespace vdbeam
