#include "farm/job_seal.h"

#include "scene/content_hash.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

constexpr std::string_view author = "Written by vdbeam farm ", checksum = ", checksum ";
constexpr std::size_t digits = 16;

/// Where the digits of the checksum begin; npos in a text without a mark.
std::size_t checksum_place(const std::string& text) {
  const std::size_t mark = text.find(author);
  const std::size_t at = mark == text.npos ? mark : text.find(checksum, mark + author.size());
  const bool fits = at != text.npos && text.size() - at >= checksum.size() + digits;
  return fits ? at + checksum.size() : text.npos;
}

/// Checksum of a text in which the checksum itself is replaced by zeros.
std::string checksum_of(const std::string& text) {
  ContentHash hash;
  hash.add(text.data(), text.size());
  return fmt::format("{:016x}", hash.value());
}

} // namespace

std::string job_mark(const std::string& engine) {
  return fmt::format("{}{}{}{}", author, engine, checksum, std::string(digits, '0'));
}

std::string sealed_job(std::string text) {
  const std::size_t place = checksum_place(text);
  return place == text.npos ? text : text.replace(place, digits, checksum_of(text));
}

JobFile judge_job(const std::string& text) {
  const std::size_t place = checksum_place(text);
  if (place == text.npos)
    return JobFile::other;
  std::string blank = text;
  blank.replace(place, digits, digits, '0');
  return sealed_job(blank) == text ? JobFile::ours : JobFile::changed;
}

} // namespace vdbeam
