#include "render/film_file.h"

#include "image/exr_stream.h"
#include "text/frame_range.h"
#include "vdbeam/error.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

static_assert(std::endian::native == std::endian::little, "doubles are stored low half first");
constexpr const char* film_format = "4";
constexpr int largest_side = 65536;

Imath::Box2i data_window(const Image& header) {
  return {{header.x, header.y}, {header.x + header.width - 1, header.y + header.height - 1}};
}

/// Calls visit(channel name, slice) for the planes of a film that lies over `window`.
template <class Visit>
void visit_slices(Film& film, const Imath::Box2i& window, const Visit& visit) {
  const auto width = static_cast<std::size_t>(film.width());
  const auto slice = [&](Imf::PixelType type, const void* first, std::size_t stride) {
    return Imf::Slice::Make(type, first, window, stride, stride * width);
  };
  for (const FilmPlane& plane : film.planes()) {
    const std::string name = fmt::format("film.{}", plane.name);
    if (const auto* doubles = std::get_if<double*>(&plane.values)) {
      const char* first = reinterpret_cast<const char*>(*doubles);
      visit(name + ".low", slice(Imf::UINT, first, 8 * plane.stride));
      visit(name + ".high", slice(Imf::UINT, first + 4, 8 * plane.stride));
    } else if (const auto* floats = std::get_if<float*>(&plane.values)) {
      visit(name, slice(Imf::FLOAT, *floats, 4 * plane.stride));
    } else {
      const auto* counts = std::get<std::uint32_t*>(plane.values);
      visit(name, slice(Imf::UINT, counts, 4 * plane.stride));
    }
  }
}

/// Runs OpenEXR and turns its errors into ours.
template <class Failure, class Body>
auto with_exr(const std::string& path, const char* problem, const Body& body) {
  try {
    return body();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    std::string reason = error.what();
    for (char& c : reason)
      c = c == '\n' ? ' ' : c;
    throw Failure(fmt::format("{}: {}: {}", path, problem, reason));
  }
}

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

/// Film planes and the picture that viewers show.
void write_planes(const FilmFileInfo& info, Film& film, AtomicFile& file) {
  Image header = info.header;
  header.metadata.insert_or_assign("vdbeam:film", std::string(film_format));
  header.metadata["vdbeam:passHash"] = info.pass_hash;
  header.metadata["vdbeam:arithmetic"] = info.arithmetic;
  header.metadata["vdbeam:passSet"] = format_frame_range(info.passes);
  header.metadata["vdbeam:invalidValues"] = std::to_string(info.invalid_values);
  header.numbers["vdbeam:frame"] = info.frame;
  header.numbers["vdbeam:seconds"] = info.seconds;
  header.numbers["vdbeam:passes"] = static_cast<double>(info.passes.size());
  header.integers.insert({"vdbeam:frame", "vdbeam:passes"});
  header.numbers.erase("vdbeam:complete");
  Imf::Header exr = exr_header(header, file.path());
  const Imath::Box2i window = exr.dataWindow();
  Imf::FrameBuffer pixels;
  const auto add = [&](const std::string& name, const Imf::Slice& slice) {
    exr.channels().insert(name, Imf::Channel(slice.type));
    pixels.insert(name, slice);
  };
  const Image picture = film.develop();
  for (const char* name : {"R", "G", "B", "A"})
    add(name, Imf::Slice::Make(Imf::FLOAT, picture.find(name)->data.data(), window));
  visit_slices(film, window, add);
  AtomicStream stream(file);
  Imf::OutputFile output(stream, exr);
  output.setFrameBuffer(pixels);
  output.writePixels(film.height());
}

std::vector<int> parse_passes(const std::string& text, const std::string& path) {
  try {
    const std::vector<int> passes = parse_frame_range(text);
    if (passes.front() < 0)
      fail_damaged(path);
    return passes;
  } catch (const InputError&) {
    fail_damaged(path);
  }
}

void check_windows(const Imf::Header& header, const std::string& path) {
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  const bool right = !data.isEmpty() && display.min == Imath::V2i(0, 0) &&
                     display.intersects(data.min) && display.intersects(data.max) &&
                     display.max.x < largest_side && display.max.y < largest_side;
  if (!right)
    fail_damaged(path);
}

FilmFileInfo parse_info(const Imf::InputFile& file, const std::string& path) {
  FilmFileInfo info;
  Image& header = info.header;
  copy_attributes(file.header(), header);
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
  check_windows(file.header(), path);
  const Imath::Box2i data = file.header().dataWindow(), display = file.header().displayWindow();
  header.x = data.min.x;
  header.y = data.min.y;
  header.width = data.max.x - data.min.x + 1;
  header.height = data.max.y - data.min.y + 1;
  header.full_width = display.max.x + 1;
  header.full_height = display.max.y + 1;
  info.pass_hash = text("vdbeam:passHash");
  info.arithmetic = text("vdbeam:arithmetic");
  info.passes = parse_passes(text("vdbeam:passSet"), path);
  info.invalid_values = parse_count(text("vdbeam:invalidValues"), path);
  const double frame = number("vdbeam:frame");
  info.seconds = number("vdbeam:seconds");
  if (!(std::abs(frame) < std::numeric_limits<int>::max()) || !(info.seconds >= 0))
    fail_damaged(path);
  info.frame = static_cast<int>(frame);
  return info;
}

} // namespace

bool FilmFileInfo::joins(const FilmFileInfo& other) const {
  return pass_hash == other.pass_hash && frame == other.frame && arithmetic == other.arithmetic &&
         data_window(header) == data_window(other.header) &&
         header.full_width == other.header.full_width &&
         header.full_height == other.header.full_height;
}

void write_film(const FilmFileInfo& info, Film& film, const std::string& path) {
  AtomicFile file(path);
  with_exr<FrameError>(path, "cannot be written", [&] { write_planes(info, film, file); });
  file.commit();
}

FilmFileInfo read_film_info(const std::string& path) {
  return with_exr<InputError>(path, "not a readable EXR", [&] {
    check_attribute_sizes(path);
    return parse_info(Imf::InputFile(path.c_str()), path);
  });
}

Film read_film(const std::string& path, const FilmFileInfo& info) {
  return with_exr<InputError>(path, "not a readable EXR", [&] {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    if (!file.isComplete() || window != data_window(info.header))
      fail_damaged(path);
    const bool glows = file.header().channels().findChannel("film.emission.R.sum.low") != nullptr;
    Film film(info.header.width, info.header.height, glows);
    Imf::FrameBuffer pixels;
    visit_slices(film, window, [&](const std::string& name, const Imf::Slice& slice) {
      const Imf::Channel* channel = file.header().channels().findChannel(name);
      if (!channel || channel->type != slice.type || channel->xSampling != 1 ||
          channel->ySampling != 1)
        fail_damaged(path);
      pixels.insert(name, slice);
    });
    file.setFrameBuffer(pixels);
    file.readPixels(window.min.y, window.max.y);
    film.set_counts(static_cast<int>(info.passes.size()), info.invalid_values);
    return film;
  });
}

} // namespace vdbeam
