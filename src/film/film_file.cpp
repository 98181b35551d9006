#include "film/film_file.h"

#include "image/plane_file.h"
#include "text/frame_range.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

constexpr const char* film_format = "6";

[[noreturn]] void fail_damaged(const std::string& path) {
  throw InputError(path + ": is a damaged partial image; delete it and render its passes again");
}

std::uint64_t parse_count(const std::string& text, const std::string& path) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    fail_damaged(path);
  return value;
}

std::vector<int> parse_passes(const std::string& text, const std::string& path) {
  try {
    const std::vector<int> passes = parse_frame_range(text);
    if (passes.front() >= 0 && passes.back() < most_passes)
      return passes;
  } catch (const InputError&) { // is no list of numbers
  }
  fail_damaged(path);
}

/// The film's planes as the file names them.
std::vector<ImagePlane> file_planes(Film& film) {
  std::vector<ImagePlane> planes = film.planes();
  for (ImagePlane& plane : planes)
    plane.name = "film." + plane.name;
  return planes;
}

FilmFileInfo parse_info(Image header, const std::string& path) {
  for (const char* of_every_file : {"pixelAspectRatio", "screenWindowWidth"})
    header.numbers.erase(of_every_file);
  const auto text = [&](const char* name) {
    const auto found = header.metadata.find(name);
    return found == header.metadata.end() ? std::string() : found->second;
  };
  const auto number = [&](const char* name) {
    const auto found = header.numbers.find(name);
    return found == header.numbers.end() ? std::nan("") : found->second;
  };
  if (text("vdbeam:film") != film_format)
    throw InputError(path + ": is not a partial image of this version of vdbeam; make one with "
                            "vdbeam render --pass-range");
  FilmFileInfo info;
  info.pass_hash = text("vdbeam:passHash");
  info.arithmetic = text("vdbeam:arithmetic");
  info.passes = parse_passes(text("vdbeam:passSet"), path);
  info.invalid_values = parse_count(text("vdbeam:invalidValues"), path);
  const double frame = number("vdbeam:frame");
  info.seconds = number("vdbeam:seconds");
  if (header.width == 0 || !(std::abs(frame) < std::numeric_limits<int>::max()) ||
      !(info.seconds >= 0))
    fail_damaged(path);
  info.frame = static_cast<int>(frame);
  info.unbiased = number("vdbeam:unbiased") == 1;
  info.glows = header.find("film.emission.R.sum.low") != nullptr;
  const auto names_between = [&](const std::string& before, const std::string& after) {
    std::vector<std::string> names;
    for (const ImageChannel& channel : header.channels)
      if (channel.name.starts_with(before) && channel.name.ends_with(after))
        names.push_back(
            channel.name.substr(before.size(), channel.name.size() - before.size() - after.size()));
    return names;
  };
  info.groups = names_between("film.group.", ".R.sum.low");
  info.objects = names_between("film.object.", ".sum.low");
  std::sort(info.objects.begin(), info.objects.end());
  info.planes = names_between("film.plane.", ".sum.low");
  std::sort(info.planes.begin(), info.planes.end());
  for (const ImageChannel& channel : header.channels) {
    info.deep_edge_planes += channel.name.starts_with("film.deep.edges.") ? 1 : 0;
    info.deep_piece_planes += channel.name.starts_with("film.deep.rests.") ? 1 : 0;
  }
  header.channels.clear();
  info.header = std::move(header);
  return info;
}

} // namespace

bool FilmFileInfo::joins(const FilmFileInfo& other) const {
  return pass_hash == other.pass_hash && frame == other.frame && arithmetic == other.arithmetic &&
         header.x == other.header.x && header.y == other.header.y &&
         header.width == other.header.width && header.height == other.header.height &&
         header.full_width == other.header.full_width &&
         header.full_height == other.header.full_height;
}

void write_film(const FilmFileInfo& info, Film& film, const std::string& path, Links links) {
  Image picture = info.header;
  picture.metadata.insert_or_assign("vdbeam:film", std::string(film_format));
  picture.metadata["vdbeam:passHash"] = info.pass_hash;
  picture.metadata["vdbeam:arithmetic"] = info.arithmetic;
  picture.metadata["vdbeam:passSet"] = format_frame_range(info.passes);
  picture.metadata["vdbeam:invalidValues"] = std::to_string(info.invalid_values);
  picture.numbers["vdbeam:frame"] = info.frame;
  picture.numbers["vdbeam:seconds"] = info.seconds;
  picture.numbers["vdbeam:unbiased"] = info.unbiased ? 1 : 0;
  picture.numbers["vdbeam:passes"] = static_cast<double>(info.passes.size());
  picture.integers.insert({"vdbeam:frame", "vdbeam:unbiased", "vdbeam:passes"});
  picture.numbers.erase("vdbeam:complete");
  if (film.deep())
    picture.numbers["vdbeam:deepAlphaError"] =
        static_cast<double>(film.deep()->layout().alpha_error);
  Image developed = film.develop();
  for (ImageChannel& channel : developed.channels)
    if (channel.name.size() == 1) // R, G, B and A: what viewers show
      picture.channels.push_back(std::move(channel));
  write_planes(picture, file_planes(film), path, links);
}

FilmFileInfo read_film_info(const std::string& path) {
  return parse_info(read_exr_header(path), path);
}

Film read_film(const std::string& path, const FilmFileInfo& info) {
  std::optional<DeepFilm> deep;
  if (info.deep_piece_planes > 0)
    deep.emplace(static_cast<std::size_t>(info.header.width) * info.header.height,
                 info.deep_edge_planes, info.deep_piece_planes);
  Film film(info.header.width, info.header.height, info.glows, info.groups, std::move(deep),
            info.objects, info.planes);
  if (!read_planes(path, info.header.width, info.header.height, file_planes(film)))
    fail_damaged(path);
  const auto error = info.header.numbers.find("vdbeam:deepAlphaError");
  const float alpha_error =
      error == info.header.numbers.end() ? 0 : static_cast<float>(error->second);
  if (film.deep() && !film.deep()->finish_reading(alpha_error))
    fail_damaged(path);
  film.set_counts(static_cast<int>(info.passes.size()), info.invalid_values);
  return film;
}

} // namespace vdbeam
