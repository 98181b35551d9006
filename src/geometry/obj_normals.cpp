#include "geometry/obj_normals.h"

#include "machine/input_file.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace vdbeam {
namespace {

constexpr std::string_view blanks = " \t\r";

/// Takes the first word off a line; empty at its end.
std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.size(), line.find_first_not_of(blanks)));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

/// The number of the normal in `vertex/texture/normal`; 0 where the corner names none.
std::int64_t normal_of(std::string_view corner) {
  const std::size_t first = corner.find('/'), second = corner.find('/', first + 1);
  std::int64_t number = 0;
  if (first != corner.npos && second != corner.npos)
    std::from_chars(corner.data() + second + 1, corner.data() + corner.size(), number);
  return number;
}

/// Calls visit(kind, rest) for each line that begins with this kind of word; a line that ends with
/// a backslash goes on in the next.
template <class Visit>
void for_each_line(const std::string& path, const Visit& visit) {
  InputStream file(path);
  std::string line, kind;
  for (bool goes_on = false; std::getline(file, line);) {
    std::string_view rest = line;
    rest = rest.substr(0, rest.find_last_not_of(blanks) + 1);
    const bool next_too = !rest.empty() && rest.back() == '\\';
    rest.remove_suffix(next_too);
    if (!goes_on)
      kind = take_word(rest);
    visit(kind, rest, !goes_on);
    goes_on = next_too;
  }
}

} // namespace

std::uint64_t count_missing_normals(const std::string& obj_path) {
  std::int64_t all = 0;
  for_each_line(obj_path, [&](std::string_view kind, std::string_view, bool begins) {
    all += begins && kind == "vn";
  });
  std::int64_t before = 0;
  std::uint64_t missing = 0;
  for_each_line(obj_path, [&](std::string_view kind, std::string_view rest, bool begins) {
    before += begins && kind == "vn";
    if (kind != "f")
      return;
    for (std::string_view corner = take_word(rest); !corner.empty(); corner = take_word(rest)) {
      // Numbers below 0 count back from the last normal before the face.
      const std::int64_t number = normal_of(corner);
      missing += number > all || number < -before;
    }
  });
  return missing;
}

} // namespace vdbeam
