#include "image/image_readers.h"
#include "machine/input_file.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace vdbeam {
namespace {

using Rgbe = std::array<unsigned char, 4>;

/// The header of a Radiance picture.
struct HdrHeader {
  double exposure = 1;
  std::int64_t width = 0, height = 0;
  bool columns_first = false; ///< scanlines run along y
  bool flip_x = false, flip_y = false;
};

constexpr char kind[] = "Radiance image";

std::string header_line(std::istream& file, const std::string& path) {
  std::string line;
  for (char c; file.get(c) && c != '\n';) {
    if (line.size() > 4096)
      not_readable(path, kind, "a header line is too long");
    line += c;
  }
  if (!file)
    not_readable(path, kind, "its header ends too early");
  if (!line.empty() && line.back() == '\r')
    line.pop_back();
  return line;
}

/// Parses "-Y height +X width" and its seven siblings.
void parse_resolution(const std::string& line, const std::string& path, HdrHeader& header) {
  std::istringstream words(line);
  std::string first, second;
  std::int64_t first_size = 0, second_size = 0;
  words >> first >> first_size >> second >> second_size;
  const auto is_axis = [](const std::string& s) {
    return s.size() == 2 && (s[0] == '+' || s[0] == '-') && (s[1] == 'X' || s[1] == 'Y');
  };
  if (!words || !is_axis(first) || !is_axis(second) || first[1] == second[1])
    not_readable(path, kind, "its resolution line is not like \"-Y 512 +X 1024\"");
  header.columns_first = first[1] == 'X';
  const std::string& x = header.columns_first ? first : second;
  const std::string& y = header.columns_first ? second : first;
  header.width = header.columns_first ? first_size : second_size;
  header.height = header.columns_first ? second_size : first_size;
  header.flip_x = x[0] == '-';
  header.flip_y = y[0] == '+'; // y points up in the format, rows go down in ours
}

HdrHeader read_header(std::istream& file, const std::string& path) {
  HdrHeader header;
  if (header_line(file, path).substr(0, 2) != "#?")
    not_readable(path, kind, "it does not begin with \"#?\"");
  for (std::string line = header_line(file, path); !line.empty(); line = header_line(file, path)) {
    if (line.rfind("FORMAT=", 0) == 0 && line != "FORMAT=32-bit_rle_rgbe")
      not_readable(path, kind, line + " is not supported; convert it to 32-bit_rle_rgbe");
    if (line.rfind("EXPOSURE=", 0) == 0) // several multiply
      header.exposure *= std::strtod(line.c_str() + 9, nullptr);
  }
  if (!(header.exposure > 0) || !std::isfinite(header.exposure))
    not_readable(path, kind, "its EXPOSURE is not a positive number");
  parse_resolution(header_line(file, path), path, header);
  const bool positive = header.width > 0 && header.height > 0;
  if (!positive || header.width > max_image_side || header.height > max_image_side ||
      header.width * header.height > max_image_pixels)
    not_readable(path, kind,
                 fmt::format("its size of {} x {} pixels is outside 1 to 2^28 pixels", header.width,
                             header.height));
  // A scanline takes 4 bytes at least, and where pixels repeat these may stand for thousands.
  constexpr double pixels_per_byte = 4096;
  check_size_fits_file(path, static_cast<double>(header.width * header.height), pixels_per_byte);
  return header;
}

/// Reads scanlines; the encoding is described in Radiance's filefmts document and in Ward,
/// "Real Pixels", Graphics Gems II, 1991.
class ScanlineReader {
public:
  ScanlineReader(std::istream& file, const std::string& path) : file_(file), path_(path) {}

  void read(std::vector<Rgbe>& line) {
    Rgbe start = pixel();
    const std::size_t coded = static_cast<std::size_t>(start[2]) << 8 | start[3];
    if (start[0] == 2 && start[1] == 2 && start[2] < 128) {
      if (coded != line.size())
        not_readable(path_, kind, "a scanline has a wrong length");
      read_planes(line);
    } else {
      read_old(line, start);
    }
  }

private:
  unsigned char byte() {
    const int c = file_.get();
    if (c == std::char_traits<char>::eof())
      not_readable(path_, kind, "it ends too early");
    return static_cast<unsigned char>(c);
  }
  Rgbe pixel() {
    Rgbe result;
    for (unsigned char& component : result)
      component = byte();
    return result;
  }

  /// Each component run-length encoded on its own.
  void read_planes(std::vector<Rgbe>& line) {
    for (std::size_t component = 0; component < 4; ++component)
      for (std::size_t x = 0; x < line.size();) {
        const unsigned code = byte();
        const bool is_run = code > 128;
        const std::size_t count = is_run ? code - 128 : code;
        if (count == 0 || count > line.size() - x)
          not_readable(path_, kind, "a run leaves its scanline");
        const unsigned char value = is_run ? byte() : 0;
        for (std::size_t i = 0; i < count; ++i)
          line[x++][component] = is_run ? value : byte();
      }
  }

  /// Plain pixels, where (1, 1, 1, n) repeats the last pixel; consecutive counts are the digits of
  /// a number of base 256.
  void read_old(std::vector<Rgbe>& line, Rgbe current) {
    std::size_t x = 0;
    for (int shift = 0;;) {
      if (current[0] == 1 && current[1] == 1 && current[2] == 1) {
        const std::size_t count = shift > 24 ? line.size() + 1 : std::size_t{current[3]} << shift;
        if (x == 0 || count > line.size() - x)
          not_readable(path_, kind, "a run leaves its scanline");
        for (std::size_t i = 0; i < count; ++i, ++x)
          line[x] = line[x - 1];
        shift += 8;
      } else {
        line[x++] = current;
        shift = 0;
      }
      if (x == line.size())
        return;
      current = pixel();
    }
  }

  std::istream& file_;
  const std::string& path_;
};

} // namespace

Image read_hdr(const std::string& path) {
  InputStream file(path);
  const HdrHeader header = read_header(file, path);
  Image image;
  image.width = static_cast<int>(header.width);
  image.height = static_cast<int>(header.height);
  const auto pixels = static_cast<std::size_t>(header.width * header.height);
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, std::vector<float>(pixels), false});

  const std::int64_t lines = header.columns_first ? header.width : header.height;
  std::vector<Rgbe> line(pixels / static_cast<std::size_t>(lines));
  ScanlineReader reader(file, path);
  for (std::int64_t j = 0; j < lines; ++j) {
    reader.read(line);
    for (std::size_t i = 0; i < line.size(); ++i) {
      std::int64_t x = header.columns_first ? j : static_cast<std::int64_t>(i);
      std::int64_t y = header.columns_first ? static_cast<std::int64_t>(i) : j;
      x = header.flip_x ? header.width - 1 - x : x;
      y = header.flip_y ? header.height - 1 - y : y;
      const double scale = line[i][3] == 0 ? 0 : std::ldexp(1 / header.exposure, line[i][3] - 136);
      for (std::size_t c = 0; c < 3; ++c)
        image.channels[c].data[static_cast<std::size_t>(y * header.width + x)] =
            static_cast<float>(line[i][c] * scale);
    }
  }
  return image;
}

} // namespace vdbeam
