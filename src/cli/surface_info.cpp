#include "cli/surface_info.h"

#include "geometry/mesh_reader.h"
#include "image/color_conversion.h"
#include "text/text.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

namespace vdbeam::cli {
namespace {

std::string extension_of(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

std::string point_text(const Vec3d& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

Boxd bounds_of(const Mesh& mesh) {
  Boxd bounds;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      bounds.extend(mesh.center + Vec3d(mesh.positions[vertex]));
  return bounds;
}

std::string uv_text(const Mesh& mesh) {
  if (mesh.uvs.empty())
    return "none: textures cannot be used";
  constexpr float infinity = std::numeric_limits<float>::infinity();
  float least_u = infinity, most_u = -infinity, least_v = infinity, most_v = -infinity;
  for (const Uv& uv : mesh.uvs) {
    least_u = std::min(least_u, uv.u);
    most_u = std::max(most_u, uv.u);
    least_v = std::min(least_v, uv.v);
    most_v = std::max(most_v, uv.v);
  }
  return fmt::format("yes: u from {:.4g} to {:.4g}, v from {:.4g} to {:.4g}", least_u, most_u,
                     least_v, most_v);
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0;
  std::size_t finite = 0, others = 0, negative = 0, above_one = 0;
};

Range range_of(const ImageChannel& channel) {
  Range range;
  for (const float x : channel.data) {
    if (!std::isfinite(x)) {
      ++range.others;
      continue;
    }
    const auto value = static_cast<double>(x);
    range.least = std::min(range.least, value);
    range.most = std::max(range.most, value);
    range.sum += value;
    ++range.finite;
    range.negative += x < 0;
    range.above_one += x > 1;
  }
  return range;
}

std::string values(std::size_t count) {
  return count == 1 ? "1 value" : fmt::format("{} values", count);
}

/// Interpretation of its numbers.
std::string colors_text(const Image& image, const std::string& extension) {
  if (extension == ".png")
    return "sRGB, made linear: 8 or 16 bits per channel, Rec.709 primaries";
  if (!image.primaries)
    return "unknown: R, G and B are used unchanged";
  const std::array spaces{ColorSpace::rec709, ColorSpace::rec2020, ColorSpace::acescg,
                          ColorSpace::aces2065_1};
  const std::array names{"Rec.709 (rec709)", "Rec.2020 (rec2020)", "ACEScg (acescg)",
                         "ACES2065-1 (aces2065_1)"};
  for (std::size_t i = 0; i < spaces.size(); ++i)
    if (image.primaries->is_near(chromaticities_of(spaces[i])))
      return fmt::format("linear, with the primaries of {}", names[i]);
  return "linear, with custom primaries";
}

} // namespace

std::string mesh_info(const std::string& path) {
  const Mesh mesh = read_mesh(path, {.uvs = true, .normals = true});
  const Boxd bounds = bounds_of(mesh);
  const char* normals = mesh.normals.empty() ? "none: triangles are flat without smooth_angle"
                                             : "yes: they shade it unless file_normals = false";
  std::string text = fmt::format(
      "{}\n  triangles     {}\n  vertices      {}\n  bounds        {} to {}\n  size          {}\n"
      "  UV            {}\n  normals       {}\n",
      path, mesh.triangles.size(), mesh.positions.size(), point_text(bounds.lower),
      point_text(bounds.upper), point_text(bounds.size()), uv_text(mesh), normals);
  for (const std::string& note : mesh.notes)
    text += fmt::format("  looks wrong   {}\n", note);
  return text;
}

bool is_picture_file(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".exr" || extension == ".hdr" || extension == ".png";
}

std::string picture_info(const std::string& path) {
  const Image image = read_image(path);
  std::vector<std::string> names;
  for (const ImageChannel& channel : image.channels)
    names.push_back(channel.name);
  std::string text = fmt::format(
      "{}\n  size          {} x {} pixels\n  channels      {}\n  colours       {}\n", path,
      image.width, image.height, fmt::join(names, ", "), colors_text(image, extension_of(path)));
  Range all;
  for (const char* name : {"R", "G", "B"}) {
    const ImageChannel* channel = image.find(name);
    if (!channel) {
      text += fmt::format("  looks wrong   there is no channel {}: it is neither a texture nor a "
                          "sky\n",
                          name);
      continue;
    }
    const Range range = range_of(*channel);
    if (range.finite > 0)
      text += fmt::format("  {}             {:.6g} to {:.6g}, mean {:.6g}\n", name, range.least,
                          range.most, range.sum / static_cast<double>(range.finite));
    all.others += range.others;
    all.negative += range.negative;
    all.above_one += range.above_one;
  }
  if (all.above_one > 0)
    text += fmt::format("  as albedo     {} above 1, clamped to 1; lights and skies keep them\n",
                        values(all.above_one));
  if (all.negative > 0)
    text += fmt::format("  looks wrong   {} below 0, taken for 0\n", values(all.negative));
  if (all.others > 0)
    text += fmt::format("  looks wrong   {}: infinite or NaN\n", values(all.others));
  return text;
}

} // namespace vdbeam::cli
