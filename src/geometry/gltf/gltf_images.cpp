#include "geometry/gltf/gltf_images.h"

#include "geometry/gltf/gltf_files.h"
#include "geometry/gltf/gltf_json.h"
#include "machine/guarded_process.h"
#include "machine/input_file.h"
#include "machine/memory.h"
#include "text/printable.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace vdbeam {
namespace {

using Json = nlohmann::json;

/// What base64 encodes; it ends at the first character that does not belong to it.
std::string base64_decoded(std::string_view text) {
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos)
      break;
    bits = bits << 6 | static_cast<unsigned>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 0xff);
    }
  }
  return bytes;
}

/// What a data: URI holds.
std::string data_of_uri(const std::string& uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || uri.rfind(";base64", comma) == std::string::npos)
    throw InputError("its data: URI is not in base64");
  return base64_decoded(std::string_view(uri).substr(comma + 1));
}

/// Bytes [offset, offset + length) of a file.
std::string part_of_file(const std::string& path, std::uint64_t offset, std::uint64_t length) {
  if (offset + length < offset || offset + length > check_input_file(path))
    throw InputError("its buffer is shorter than it says");
  InputStream file(path);
  file.seekg(static_cast<std::streamoff>(offset));
  std::string bytes(length, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(length));
  return bytes;
}

/// Where the bytes of a .glb's buffer begin: behind the header, the JSON, and the heads of both
/// chunks.
std::uint64_t start_of_glb_buffer(const std::string& path) {
  const std::string start = part_of_file(path, 12, 4);
  std::uint32_t length = 0;
  for (int i = 3; i >= 0; --i)
    length = length << 8 | static_cast<unsigned char>(start[static_cast<std::size_t>(i)]);
  return 12 + 8 + length + 8;
}

/// The file of a picture, as it is encoded.
std::string encoded_image(const std::string& path, int index) {
  const Json gltf = read_gltf_json(path);
  const Json& image = gltf.at("images").at(static_cast<std::size_t>(index));
  if (image.contains("uri"))
    return data_of_uri(image["uri"].get<std::string>());
  const Json& view = gltf.at("bufferViews").at(image.at("bufferView").get<std::size_t>());
  const auto offset = view.value("byteOffset", std::uint64_t{0});
  const auto length = view.at("byteLength").get<std::uint64_t>();
  const Json& buffer = gltf.at("buffers").at(view.at("buffer").get<std::size_t>());
  if (!buffer.contains("uri"))
    return part_of_file(path, start_of_glb_buffer(path) + offset, length);
  const auto uri = buffer["uri"].get<std::string>();
  if (!uri.starts_with("data:"))
    return part_of_file(named_by_uri((std::filesystem::path(path).parent_path() / uri).string()),
                        offset, length);
  const std::string bytes = data_of_uri(uri);
  if (offset > bytes.size() || length > bytes.size() - offset)
    throw InputError("its buffer is shorter than it says");
  return bytes.substr(offset, length);
}

/// An open file without a name.
class MemoryFile {
public:
  explicit MemoryFile(const MappedFile& content) : descriptor_(memfd_create("image", MFD_CLOEXEC)) {
    if (descriptor_ < 0)
      throw FrameError("there is no memory for an image");
    write_all(descriptor_, content.data(), content.size());
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(descriptor_); }
  std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

private:
  int descriptor_;
};

bool can_be_read(const std::string& kind) {
  return kind == "png" || kind == "jpeg" || kind == "jpg" || kind == "exr" || kind == "hdr";
}

} // namespace

GltfPicture find_gltf_picture(const std::string& path, const Json& image, int index) {
  const auto text = [&](const char* name) {
    return image.is_object() && image.contains(name) && image[name].is_string()
               ? image[name].get<std::string>()
               : std::string();
  };
  const std::string uri = text("uri"), type = text("mimeType");
  std::string kind, name = fmt::format("image {}", index);
  GltfPicture picture{path, index, ""};
  if (uri.starts_with("data:image/")) {
    kind = uri.substr(11, uri.find(';') - 11);
  } else if (uri.empty()) {
    kind = type.starts_with("image/") ? type.substr(6) : "png"; // whose first bytes decide
  } else {
    picture.file = named_by_uri((std::filesystem::path(path).parent_path() / uri).string());
    picture.image = -1;
    kind = lower_case(std::filesystem::path(picture.file).extension().string());
    kind.erase(0, 1);
    name = "image " + as_utf8(uri);
  }
  if (!can_be_read(kind))
    picture = {"", -1,
               fmt::format("its {} is not used: textures are PNG, JPEG, EXR or HDR images", name)};
  return picture;
}

Image read_gltf_image(const std::string& path, int index) {
  const std::uint64_t bytes = check_input_file(path) + bytes_of_gltf_files(path);
  GuardLimits limits;
  limits.cpu_seconds = 2 + 5e-6 * static_cast<double>(bytes);
  limits.bytes = std::min(free_memory(), (std::uint64_t(256) << 20) + 200 * bytes);
  const std::string name = fmt::format("{}: image {}", path, index);
  std::string file;
  try {
    const MemoryFile copy(run_guarded(name, limits, [&](int output) {
      const std::string encoded = encoded_image(path, index);
      write_all(output, encoded.data(), encoded.size());
    }));
    file = copy.path();
    return read_image(file);
  } catch (const Error& problem) {
    std::string text = problem.what();
    if (!file.empty() && text.starts_with(file))
      text.replace(0, file.size(), name);
    else if (!text.starts_with(path))
      text = name + ": " + text;
    throw InputError(text);
  }
}

Image read_picture(const GltfPicture& picture) {
  return picture.image < 0 ? read_image(picture.file)
                           : read_gltf_image(picture.file, picture.image);
}

bool is_encoded(const GltfPicture& picture) {
  const std::string ending = lower_case(std::filesystem::path(picture.file).extension().string());
  return ending != ".exr" && ending != ".hdr";
}

} // namespace vdbeam
