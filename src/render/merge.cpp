#include "film/film_file.h"
#include "film/layers.h"
#include "render/error_record.h"
#include "report/image_metadata.h"
#include "text/frame_range.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

namespace vdbeam {
namespace {

struct Partial {
  std::string path;
  FilmFileInfo info;
};

/// All headers, by first pass, so that the order on the command line does not matter.
std::vector<Partial> read_headers(const std::vector<std::string>& paths) {
  std::vector<Partial> partials;
  partials.reserve(paths.size());
  for (const std::string& path : paths)
    partials.push_back({path, read_film_info(path)});
  std::stable_sort(partials.begin(), partials.end(), [](const Partial& a, const Partial& b) {
    return a.info.passes.front() < b.info.passes.front();
  });
  return partials;
}

void check_same(const Partial& first, const Partial& other) {
  const auto fail = [&](const std::string& what) {
    throw InputError(
        fmt::format("{} and {}: {}; only partial images of one scene, frame and region can be "
                    "merged",
                    first.path, other.path, what));
  };
  if (other.info.frame != first.info.frame)
    fail(fmt::format("frames {} and {}", first.info.frame, other.info.frame));
  if (other.info.pass_hash != first.info.pass_hash)
    fail("the scenes differ");
  if (other.info.arithmetic != first.info.arithmetic)
    throw InputError(
        fmt::format("{} and {}: were rendered on machines that round differently (one without "
                    "fused multiply-add, or with another C library); render the passes of one "
                    "frame on machines of one kind",
                    first.path, other.path));
  if (!other.info.joins(first.info))
    fail("sizes or regions differ");
}

/// Adds the passes of `other`; none may be there already.
void add_passes(std::vector<int>& passes, const Partial& other) {
  std::vector<int> common, all;
  std::set_intersection(passes.begin(), passes.end(), other.info.passes.begin(),
                        other.info.passes.end(), std::back_inserter(common));
  if (!common.empty())
    throw InputError(fmt::format("{}: passes {} are there twice; leave out one of the files",
                                 other.path, format_frame_range(common)));
  std::merge(passes.begin(), passes.end(), other.info.passes.begin(), other.info.passes.end(),
             std::back_inserter(all));
  passes = std::move(all);
}

void check_complete(const std::vector<int>& passes, const MergeSettings& settings) {
  std::vector<int> wanted(static_cast<std::size_t>(settings.passes.value_or(passes.back() + 1))),
      missing, surplus;
  std::iota(wanted.begin(), wanted.end(), 0);
  std::set_difference(wanted.begin(), wanted.end(), passes.begin(), passes.end(),
                      std::back_inserter(missing));
  std::set_difference(passes.begin(), passes.end(), wanted.begin(), wanted.end(),
                      std::back_inserter(surplus));
  if (!surplus.empty())
    throw InputError(fmt::format("passes {} are more than the {} that were asked for",
                                 format_frame_range(surplus), wanted.size()));
  if (!missing.empty() && !settings.allow_gaps)
    throw InputError(fmt::format("passes {} are missing; render them with --pass-range, or merge "
                                 "without them with --allow-gaps",
                                 format_frame_range(missing)));
}

/// The picture with the attributes of the first file, brought up to date.
Image finish_image(const Film& film, const FilmFileInfo& info) {
  const Image& header = info.header;
  const auto layers = header.metadata.find("vdbeam:layers");
  Image image =
      develop_layers(film, layers == header.metadata.end() ? std::vector<LayerSettings>{}
                                                           : layers_of_text(layers->second));
  image.primaries = header.primaries;
  image.x = header.x;
  image.y = header.y;
  image.full_width = header.full_width;
  image.full_height = header.full_height;
  for (const auto& [name, text] : header.metadata)
    image.metadata[name] = text; // beside those of Cryptomatte
  image.numbers = header.numbers;
  image.integers = header.integers;
  image.matrices = header.matrices;
  for (const char* name : {"vdbeam:film", "vdbeam:arithmetic", "vdbeam:invalidValues"})
    image.metadata.erase(name);
  image.numbers.erase("vdbeam:unbiased");
  image.metadata["vdbeam:passSet"] = format_frame_range(info.passes);
  image.metadata["vdbeam:stoppedBy"] = "passes";
  image.numbers["vdbeam:passes"] = film.passes();
  image.numbers["vdbeam:seconds"] = info.seconds;
  image.numbers["vdbeam:complete"] = 1;
  image.integers.insert({"vdbeam:passes", "vdbeam:complete"});
  add_error_metadata(image, error_record(film, info.unbiased));
  return image;
}

} // namespace

Image merge_partials(const std::vector<std::string>& paths, const MergeSettings& settings) {
  if (paths.empty())
    throw InputError("nothing to merge");
  const std::vector<Partial> partials = read_headers(paths);
  FilmFileInfo info = partials.front().info;
  for (std::size_t i = 1; i < partials.size(); ++i) {
    check_same(partials.front(), partials[i]);
    add_passes(info.passes, partials[i]);
    info.seconds += partials[i].info.seconds;
    info.invalid_values += partials[i].info.invalid_values;
    for (const char* count : {"vdbeam:photonsStored", "vdbeam:clampRemoved", "vdbeam:clampTotal",
                              "vdbeam:clampedPixels"}) // a sum over the passes
      if (const auto found = partials[i].info.header.numbers.find(count);
          found != partials[i].info.header.numbers.end())
        info.header.numbers[count] += found->second;
  }
  check_complete(info.passes, settings);
  Film film = read_film(partials.front().path, partials.front().info);
  for (std::size_t i = 1; i < partials.size(); ++i)
    film.merge(read_film(partials[i].path, partials[i].info));
  if (!settings.partial.empty())
    write_film(info, film, settings.partial);
  Image image = finish_image(film, info);
  if (const std::optional<DeepImage> deep = film.develop_deep()) {
    image.numbers["vdbeam:deepSamples"] = static_cast<double>(deep->z.size());
    image.integers.insert("vdbeam:deepSamples");
    if (!settings.deep.empty())
      write_deep_exr(*deep, image, settings.deep);
  }
  return image;
}

} // namespace vdbeam
