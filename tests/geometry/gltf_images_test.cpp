#include "geometry/gltf/gltf_images.h"

#include "image/texture.h"

#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

namespace vdbeam {
namespace {

using test::TempFolder;
using test::write_bytes;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

/// A .glb with this JSON and this buffer.
std::string glb(std::string json, std::string buffer) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
  const auto number = [](std::size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i)
      bytes += static_cast<char>(value >> 8 * i & 0xff);
    return bytes;
  };
  return "glTF" + number(2) + number(28 + json.size() + buffer.size()) + number(json.size()) +
         "JSON" + json + number(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

class GltfImages : public testing::Test {
protected:
  GltfImages() {
    Image image;
    image.width = 2;
    image.height = 1;
    // Codes of 0.5 and 0.25 in green, 1 and 0 in blue.
    image.channels = {{"R", {0, 1}}, {"G", {0.214041f, 0.050876f}}, {"B", {1, 0}}};
    write_png(image, folder_.file("a.png"), 0, "srgb");
    png_ = bytes_of(folder_.file("a.png"));
  }
  void check(const std::string& path) const {
    const Image image = read_gltf_image(path, 0);
    EXPECT_EQ(image.width, 2) << path;
    EXPECT_NEAR(image.find("G")->data[0], 0.214, 0.005) << path;
  }

  TempFolder folder_;
  std::string png_;
};

TEST_F(GltfImages, InBuffersAndText) {
  const std::string view = fmt::format(
      R"("images": [{{"bufferView": 0, "mimeType": "image/png"}}],
         "bufferViews": [{{"buffer": 0, "byteOffset": 4, "byteLength": {}}}])",
      png_.size());
  write_bytes(folder_.file("a.glb"), glb(fmt::format(R"({{{}, "buffers": [{{"byteLength": {}}}]}})",
                                                     view, png_.size() + 4),
                                         "1234" + png_));
  write_bytes(folder_.file("b.bin"), "1234" + png_);
  write_bytes(folder_.file("b.gltf"), "{" + view + R"(, "buffers": [{"uri": "b.bin"}]})");
  write_bytes(folder_.file("c.gltf"), "{" + view + R"(, "buffers": [{"uri": "data:any;base64,)" +
                                          base64("1234" + png_) + R"("}]})");
  write_bytes(folder_.file("d.gltf"),
              R"({"images": [{"uri": "data:image/png;base64,)" + base64(png_) + R"("}]})");
  for (const char* name : {"a.glb", "b.gltf", "c.gltf", "d.gltf"})
    check(folder_.file(name));
}

TEST_F(GltfImages, DamageIsOneLine) {
  const auto complaint = [&](const std::string& text) {
    write_bytes(folder_.file("x.gltf"), text);
    try {
      read_gltf_image(folder_.file("x.gltf"), 0);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const std::string name = folder_.file("x.gltf");
  for (const char* text :
       {"{}", "no JSON", R"({"images": [{"uri": "data:image/png,plain"}]})",
        R"({"images": [{"uri": "data:image/png;base64,AAAA"}]})",
        R"({"images": [{"bufferView": 0}], "bufferViews": [{"buffer": 0, "byteOffset": 8,
            "byteLength": 18446744073709551615}], "buffers": [{"uri": "data:;base64,AAAA"}]})",
        R"({"images": [{"bufferView": 0}], "bufferViews": [{"buffer": 0, "byteLength": 9}],
            "buffers": [{"uri": "data:;base64,AAAA"}]})"}) {
    const std::string line = complaint(text);
    EXPECT_TRUE(line.starts_with(name)) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(line.find("/proc"), std::string::npos) << line;
  }
}

/// Pictures of data are no colours: the numbers count, not the light that they would be.
TEST_F(GltfImages, DataOfEightBitsIsDecoded) {
  const GltfPicture picture{folder_.file("a.png"), -1, ""};
  std::vector<std::string> notes;
  const Texture texture =
      make_data_texture(read_picture(picture), "a.png",
                        {.use = TextureUse::roughness, .encoded = is_encoded(picture)}, notes);
  const auto [least, most] = texture.range(1);
  EXPECT_NEAR((least + most) / 2, 0.375, 0.006);
  EXPECT_FALSE(is_encoded({"a.exr", -1, ""}));
}

} // namespace
} // namespace vdbeam
