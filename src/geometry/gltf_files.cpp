#include "geometry/gltf_files.h"

#include "machine/input_file.h"
#include "text/text.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace vdbeam {
namespace {

/// No file of text is larger that names others: it would hold its numbers itself.
constexpr std::uintmax_t most_bytes = std::uintmax_t(64) << 20;

/// The text of a JSON string that follows a key and its colon, or none.
std::string value_at(const std::string& json, std::size_t after_key) {
  const std::size_t colon = json.find_first_not_of(" \t\r\n", after_key);
  if (colon == std::string::npos || json[colon] != ':')
    return {};
  const std::size_t quote = json.find_first_not_of(" \t\r\n", colon + 1);
  if (quote == std::string::npos || json[quote] != '"')
    return {};
  const std::size_t end = json.find('"', quote + 1);
  return end == std::string::npos ? std::string() : json.substr(quote + 1, end - quote - 1);
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

} // namespace

std::string named_by_uri(const std::string& path) {
  std::error_code failed;
  return std::filesystem::exists(path, failed) ? path : percent_decoded(path);
}

std::vector<std::string> gltf_files(const std::string& path) {
  std::error_code failed;
  std::vector<std::string> files;
  if (lower_case(std::filesystem::path(path).extension().string()) != ".gltf" ||
      !std::filesystem::is_regular_file(path, failed) ||
      std::filesystem::file_size(path, failed) > most_bytes)
    return files;
  std::ifstream stream(path, std::ios::binary);
  const std::string json{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
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
  for (const std::string& file : gltf_files(path)) {
    std::error_code failed;
    const std::uint64_t bytes = std::filesystem::file_size(file, failed);
    sum += failed ? 0 : bytes;
  }
  return sum;
}

std::string model_identity(const std::string& path) {
  std::string identity = file_identity(path);
  for (const std::string& file : gltf_files(path))
    identity.append("|").append(file_identity(file));
  return identity;
}

} // namespace vdbeam
