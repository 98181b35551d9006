#include "vdb/vdb_names.h"

#include "text/printable.h"
#include "text/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace vdbeam {

namespace {

/// Levenshtein's edit distance, capitals ignored.
std::size_t edit_distance(const std::string& one, const std::string& other) {
  const std::string a = lower_case(one), b = lower_case(other);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

} // namespace

std::string same_grid_name(const std::string& wanted, const std::vector<std::string>& names) {
  std::string found;
  for (const std::string& name : names) {
    // Scene files are UTF-8; names in VDBs need not be.
    if (name == wanted || as_utf8(name) == wanted)
      return name;
    if (lower_case(name) != lower_case(wanted))
      continue;
    if (!found.empty())
      return {};
    found = name;
  }
  return found;
}

std::string missing_grid_message(const std::string& path, const std::string& wanted,
                                 const std::vector<std::string>& names) {
  if (names.empty())
    return fmt::format("{}: has no grid \"{}\", and none at all", path, wanted);
  constexpr std::size_t shown = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), shown); ++i)
    list += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", names[i]);
  if (names.size() > shown)
    list += fmt::format(" and {} more", names.size() - shown);
  std::string message = fmt::format("{}: has no grid \"{}\"; it holds {}", path, wanted, list);

  const auto distance = [&](const std::string& name) { return edit_distance(wanted, name); };
  const auto nearest =
      std::min_element(names.begin(), names.end(),
                       [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  if (names.size() > 1 && distance(*nearest) <= std::max<std::size_t>(2, wanted.size() / 3))
    message += fmt::format("; did you mean \"{}\"?", *nearest);
  return message;
}

} // namespace vdbeam
