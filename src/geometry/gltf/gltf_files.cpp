#include "geometry/gltf/gltf_files.h"

#include "geometry/gltf/gltf_json.h"
#include "machine/input_file.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>

namespace vdbeam {
namespace {

/// No file of text is larger that names others: it would hold its numbers itself.
constexpr std::uintmax_t most_bytes = std::uintmax_t(64) << 20;

/// The JSON string that follows a key and its colon, or nothing.
std::string value_at(const std::string& json, std::size_t after_key) {
  const std::size_t colon = json.find_first_not_of(" \t\r\n", after_key);
  if (colon == std::string::npos || json[colon] != ':')
    return {};
  const std::size_t quote = json.find_first_not_of(" \t\r\n", colon + 1);
  if (quote == std::string::npos || json[quote] != '"')
    return {};
  std::size_t end = quote + 1;
  while (end < json.size() && json[end] != '"')
    end += json[end] == '\\' ? 2 : 1;
  const auto text = nlohmann::json::parse(json.substr(quote, end + 1 - quote), nullptr, false);
  return text.is_string() ? text.get<std::string>() : std::string();
}

/// A URI with each %20 and the like replaced by its character; what is no such code stays.
std::string percent_decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const char* digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2 && code != 0) {
      text += static_cast<char>(code);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

bool has_extension(const std::string& path, const char* extension) {
  return lower_case(std::filesystem::path(path).extension().string()) == extension;
}

/// A file that cannot be read names no other; whoever needs it will complain.
template <class Read>
std::string text_or_nothing(const Read& read) {
  try {
    return read();
  } catch (const Error&) {
    return {};
  }
}

/// The JSON of a glTF; empty for other files and for unreadable ones.
std::string json_text(const std::string& path) {
  const bool binary = has_extension(path, ".glb");
  if (!binary && !has_extension(path, ".gltf"))
    return {};
  return text_or_nothing(
      [&] { return binary ? read_glb_text(path) : read_text(path, most_bytes); });
}

} // namespace

std::string named_by_uri(const std::string& path) {
  std::error_code failed;
  return std::filesystem::exists(path, failed) ? path : percent_decoded(path);
}

bool is_animated_gltf(const std::string& path) {
  return json_text(path).find("\"animations\"") != std::string::npos;
}

std::vector<std::string> gltf_files(const std::string& path) {
  std::vector<std::string> files;
  const std::string json = json_text(path);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const std::string key = "\"uri\"";
  for (std::size_t at = json.find(key); at != std::string::npos; at = json.find(key, at + 1))
    if (const std::string uri = value_at(json, at + key.size());
        !uri.empty() && uri.rfind("data:", 0) != 0)
      files.push_back(named_by_uri((folder / uri).string()));
  return files;
}

std::uint64_t bytes_of_gltf_files(const std::string& path) {
  std::uint64_t sum = 0;
  for (const std::string& file : gltf_files(path))
    try {
      if (is_there(file))
        sum += check_input_file(file, EmptyFile::accepted);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: names {}", path, error.what()));
    }
  return sum;
}

std::vector<std::string> files_named_by_model(const std::string& path) {
  if (!has_extension(path, ".obj"))
    return gltf_files(path);
  constexpr std::size_t head = std::size_t(1) << 20; // libraries stand before what uses them
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::vector<std::string> files;
  std::istringstream lines(text_or_nothing([&] { return read_start(path, head); }));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "mtllib")
      continue;
    // A name with spaces, or several names.
    if (std::string whole; std::getline(words >> std::ws, whole)) {
      whole.erase(whole.find_last_not_of(" \t\r") + 1);
      files.push_back((folder / whole).string());
    }
    words.clear();
    words.str(line);
    words >> word;
    while (words >> word)
      files.push_back((folder / word).string());
  }
  return files;
}

std::string model_identity(const std::string& path) {
  std::string identity = file_identity(path);
  for (const std::string& file : gltf_files(path))
    identity.append("|").append(file_identity(file));
  return identity;
}

} // namespace vdbeam
