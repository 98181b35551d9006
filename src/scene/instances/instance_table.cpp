#include "scene/instances/instance_table.h"

#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>
#include <sstream>

namespace vdbeam {
namespace {

constexpr std::size_t longest_table = std::size_t(256) << 20;

enum Column : std::size_t { x, y, z, rx, ry, rz, scale, sx, sy, sz, density, matrix, end = 23 };
const std::vector<std::string>& names() {
  static const std::vector<std::string> all{
      "x",   "y",   "z",   "rx",  "ry",  "rz",  "scale", "sx",  "sy",  "sz",  "density", "m00",
      "m01", "m02", "m03", "m10", "m11", "m12", "m13",   "m20", "m21", "m22", "m23"};
  return all;
}

/// The words of a line; brackets and separators count as spaces.
std::vector<std::string> words_of(std::string text) {
  for (char& c : text)
    if (c == ',' || c == ';' || c == '[' || c == ']' || c == '(' || c == ')' || c == '\r')
      c = ' ';
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
    words.push_back(word);
  return words;
}

std::optional<double> number_of(const std::string& word) {
  char* last = nullptr;
  const double value = std::strtod(word.c_str(), &last);
  return last == word.c_str() + word.size() && std::isfinite(value) ? std::optional(value)
                                                                    : std::nullopt;
}

bool names_columns(const std::vector<std::string>& words) {
  return std::isalpha(static_cast<unsigned char>(words[0][0])) != 0 && !number_of(words[0]);
}

} // namespace

std::array<double, 12> placement_matrix(const std::array<double, 3>& translate,
                                        const std::array<double, 3>& degrees,
                                        const std::array<double, 3>& factors) {
  const auto rotate = [](double& a, double& b, double angle) {
    const double radians = angle * 3.14159265358979323846 / 180;
    const double c = std::cos(radians), s = std::sin(radians);
    const double old_a = a;
    a = c * old_a - s * b;
    b = s * old_a + c * b;
  };
  std::array<double, 12> m{};
  for (std::size_t column = 0; column < 3; ++column) {
    std::array<double, 3> axis{};
    axis[column] = factors[column];
    rotate(axis[1], axis[2], degrees[0]);
    rotate(axis[2], axis[0], degrees[1]);
    rotate(axis[0], axis[1], degrees[2]);
    for (std::size_t row = 0; row < 3; ++row)
      m[4 * row + column] = axis[row];
  }
  for (std::size_t row = 0; row < 3; ++row)
    m[4 * row + 3] = translate[row];
  return m;
}

InstanceColumns::InstanceColumns(std::string_view text) {
  for (const std::string& word : words_of(std::string(text))) {
    const auto found = std::find(names().begin(), names().end(), word);
    if (found == names().end()) {
      const auto near = nearest_word(word, names());
      throw InputError(one_line(fmt::format("has the column \"{}\"; {}", word,
                                            near ? "did you mean " + *near + "?"
                                                 : "columns are " + join_words(names(), "and"))));
    }
    columns_.push_back(static_cast<std::size_t>(found - names().begin()));
    if (std::count(columns_.begin(), columns_.end(), columns_.back()) > 1)
      throw InputError(fmt::format("has the column {} twice", word));
  }
  const auto has = [&](std::size_t first, std::size_t last) {
    return std::count_if(columns_.begin(), columns_.end(),
                         [&](std::size_t c) { return c >= first && c <= last; });
  };
  if (columns_.empty())
    throw InputError("has no column: write e.g. \"x y z ry scale\"");
  if (has(matrix, end) > 0 && (has(matrix, end) < 12 || has(x, sz) > 0))
    throw InputError("must have all of m00 to m23 and no other place, or none of them");
  if (has(scale, scale) > 0 && has(sx, sz) > 0)
    throw InputError("must not have both scale and sx, sy or sz");
}

InstanceRow InstanceColumns::row(const std::vector<double>& numbers) const {
  if (numbers.size() != columns_.size())
    throw InputError(fmt::format("must hold {}, one for each column, got {}",
                                 count_text(columns_.size(), "number"), numbers.size()));
  std::array<double, end> all{};
  for (const Column one : {scale, sx, sy, sz, density})
    all[one] = 1;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    all[columns_[i]] = numbers[i];
  InstanceRow result;
  if (std::find(columns_.begin(), columns_.end(), static_cast<std::size_t>(matrix)) !=
      columns_.end())
    std::copy_n(all.begin() + matrix, 12, result.transform.begin());
  else
    result.transform =
        placement_matrix({all[x], all[y], all[z]}, {all[rx], all[ry], all[rz]},
                         {all[sx] * all[scale], all[sy] * all[scale], all[sz] * all[scale]});
  result.density = all[density];
  if (!(result.density >= 0))
    throw InputError(fmt::format("must have a density of at least 0, got {}", result.density));
  const auto& m = result.transform;
  const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) -
                             m[1] * (m[4] * m[10] - m[6] * m[8]) +
                             m[2] * (m[4] * m[9] - m[5] * m[8]);
  const auto size = [&](std::size_t i) { return std::hypot(m[i], m[i + 1], m[i + 2]); };
  if (!(std::abs(determinant) > 1e-12 * size(0) * size(4) * size(8)))
    throw InputError("must be invertible (no scale may be 0)");
  return result;
}

std::vector<InstanceRow> read_instance_file(const std::string& path, const std::string& columns) {
  std::istringstream stream(read_text(path, longest_table));
  std::vector<InstanceRow> rows;
  std::optional<InstanceColumns> meaning;
  int line = 0;
  for (std::string text; std::getline(stream, text);) {
    ++line;
    if (const auto comment = text.find('#'); comment != std::string::npos)
      text.erase(comment);
    const std::vector<std::string> words = words_of(text);
    if (words.empty())
      continue;
    try {
      if (!meaning && names_columns(words)) {
        meaning.emplace(text);
        continue;
      }
      if (!meaning)
        meaning.emplace(columns);
      std::vector<double> numbers;
      for (const std::string& word : words) {
        const auto number = number_of(word);
        if (!number) // quotes nothing: who sees messages may not be allowed to read the file
          throw InputError("must hold finite numbers and nothing else");
        numbers.push_back(*number);
      }
      rows.push_back(meaning->row(numbers));
      if (rows.size() > most_instances)
        throw InputError(
            fmt::format("is one row too many: a scene may have {} instances", most_instances));
    } catch (const InputError& problem) {
      throw InputError(one_line(fmt::format("{}:{}: {}", path, line, problem.what())));
    }
  }
  return rows;
}

} // namespace vdbeam
