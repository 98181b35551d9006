#include "image/texture.h"

#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>

namespace vdbeam {
namespace {

/// Grey values, row by row from the top.
Image grey_image(int width, int height, const std::vector<float>& values) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, values});
  return image;
}
Texture texture(const Image& image, TextureWrap wrap = TextureWrap::repeat) {
  std::vector<std::string> notes;
  return {image, wrap, 1e30f, "memory", notes};
}
float at(const Texture& texture, double u, double v) {
  return texture.at({static_cast<float>(u), static_cast<float>(v)}).x;
}

TEST(Texture, texels_lie_where_the_picture_has_them) {
  const Texture picture = texture(grey_image(2, 2, {1, 2, 3, 4}), TextureWrap::clamp);
  EXPECT_EQ(at(picture, 0.25, 0.75), 1);
  EXPECT_EQ(at(picture, 0.75, 0.75), 2);
  EXPECT_EQ(at(picture, 0.25, 0.25), 3);
  EXPECT_EQ(at(picture, 0.75, 0.25), 4);
  EXPECT_EQ(at(picture, 0.5, 0.5), 2.5f);
}

TEST(Texture, wraps) {
  const Image image = grey_image(4, 1, {1, 2, 3, 4});
  const Texture repeated = texture(image), mirrored = texture(image, TextureWrap::mirror),
                clamped = texture(image, TextureWrap::clamp);
  for (const double whole : {-5.0, -2.0, 0.0, 1.0, 4.0})
    EXPECT_EQ(at(repeated, whole + 0.125, 0.5), 1);
  EXPECT_EQ(at(repeated, 0, 0.5), 2.5f);
  EXPECT_EQ(at(mirrored, 1.125, 0.5), 4);
  EXPECT_EQ(at(mirrored, -0.125, 0.5), 1);
  EXPECT_EQ(at(mirrored, 2.125, 0.5), 1);
  EXPECT_EQ(at(mirrored, 1, 0.5), 4);
  EXPECT_EQ(at(clamped, -3, 0.5), 1);
  EXPECT_EQ(at(clamped, 7, 0.5), 4);
  EXPECT_EQ(at(clamped, NAN, 0.5), 1);
  EXPECT_TRUE(std::isfinite(at(repeated, INFINITY, 1e30)));
}

/// A grid of the middles of 20 by 20 parts of each texel finds the mean exactly.
TEST(Texture, keeps_the_mean) {
  const Image image = grey_image(3, 2, {1, 0, 5, 2, 8, 0});
  for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp}) {
    const Texture picture = texture(image, wrap);
    double sum = 0;
    for (int i = 0; i < 60; ++i)
      for (int j = 0; j < 40; ++j)
        sum += at(picture, (i + 0.5) / 60, (j + 0.5) / 40);
    EXPECT_NEAR(sum / 2400, 16.0 / 6, 1e-5);
  }
}

TEST(Texture, mends_values_and_tells) {
  test::TempFolder folder;
  MaterialSettings material;
  material.texture = folder.file("picture.exr");
  Image image = grey_image(3, 1, {-1, NAN, INFINITY});
  for (ImageChannel& channel : image.channels)
    channel.half = false;
  write_exr(image, material.texture);
  std::vector<std::string> notes;
  const Texture albedo = read_texture(material, false, notes);
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_NE(notes[0].find("6 values that are infinite"), std::string::npos) << notes[0];
  EXPECT_NE(notes[1].find("3 values below 0"), std::string::npos) << notes[1];
  EXPECT_NE(notes[2].find("3 values above 1"), std::string::npos) << notes[2];
  EXPECT_EQ(at(albedo, 1.0 / 6, 0.5), 0);
  EXPECT_EQ(at(albedo, 0.5, 0.5), 0);
  EXPECT_NEAR(at(albedo, 5.0 / 6, 0.5), 1, 1e-6);
  EXPECT_NEAR(at(read_texture(material, true, notes), 5.0 / 6, 0.5), 65504, 0.1);
}

/// The primary red of Rec. 709 in ACEScg (as the conversion's own tests have it).
TEST(Texture, is_in_the_working_space) {
  test::TempFolder folder;
  MaterialSettings material;
  material.texture = folder.file("red.exr");
  material.color_space = ColorSpace::acescg;
  Image image = grey_image(1, 1, {0});
  image.channels[0].data[0] = 1;
  write_exr(image, material.texture);
  std::vector<std::string> notes;
  const Rgb red = read_texture(material, false, notes).at({0.5f, 0.5f});
  const Vec3d expected = rgb_matrix({}, chromaticities_of(ColorSpace::acescg)).apply({1, 0, 0});
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(red[c], expected[c], 1e-5);
  EXPECT_LT(red.x, 0.7f);
}

/// One row.
template <class T>
void write_row(const std::string& path, const std::vector<T>& values, png_uint_32 format) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.format = format;
  png.width = static_cast<png_uint_32>(values.size() / PNG_IMAGE_SAMPLE_CHANNELS(format));
  png.height = 1;
  ASSERT_TRUE(png_image_write_to_file(&png, path.c_str(), 0, values.data(), 0, nullptr));
}

/// By the curve of IEC 61966-2-1.
TEST(ReadPng, srgb_of_8_bits) {
  test::TempFolder folder;
  const std::string path = folder.file("ramp.png");
  std::vector<png_byte> codes;
  for (int code = 0; code < 256; ++code)
    codes.insert(codes.end(), {static_cast<png_byte>(code), static_cast<png_byte>(255 - code), 0});
  write_row(path, codes, PNG_FORMAT_RGB);
  const Image read = read_image(path);
  ASSERT_EQ(read.width, 256);
  for (std::size_t i = 0; i < 256; ++i) {
    const double x = static_cast<double>(i) / 255;
    const double linear = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(read.find("R")->data[i], linear, 1e-6) << i;
    EXPECT_NEAR(read.find("G")->data[255 - i], linear, 1e-6) << i;
    EXPECT_EQ(read.find("B")->data[i], 0);
  }
}

TEST(ReadPng, linear_of_16_bits_without_its_alpha) {
  test::TempFolder folder;
  const std::string path = folder.file("linear.png");
  // Multiplied by alpha, as libpng wants them: half of (1, 0.5, 0).
  write_row<png_uint_16>(path, {32768, 16384, 0, 32768, 65535, 6554, 0, 65535},
                         PNG_FORMAT_LINEAR_RGB_ALPHA);
  const Image read = read_image(path);
  ASSERT_EQ(read.width, 2);
  EXPECT_NEAR(read.find("R")->data[0], 1, 1e-3);
  EXPECT_NEAR(read.find("G")->data[0], 0.5, 1e-3);
  EXPECT_NEAR(read.find("G")->data[1], 0.1, 1e-4);
  EXPECT_EQ(read.find("B")->data[1], 0);
  EXPECT_NEAR(read.find("A")->data[0], 0.5, 1e-4);
  EXPECT_EQ(read.find("A")->data[1], 1);
}

TEST(ReadPng, keeps_alpha_of_8_bits) {
  test::TempFolder folder;
  const std::string path = folder.file("leaf.png");
  write_row<png_byte>(path, {255, 0, 0, 51, 0, 255, 0, 255}, PNG_FORMAT_RGBA);
  const Image read = read_image(path);
  EXPECT_NEAR(read.find("A")->data[0], 0.2f, 1e-6f);
  EXPECT_EQ(read.find("R")->data[0], 1);
}

/// An image of numbers counts as it was written, and one with alpha as its alpha.
TEST(DataTexture, numbers_and_alpha) {
  test::TempFolder folder;
  std::vector<std::string> notes;
  const auto value = [&](const std::string& path, const DataKind& kind) {
    return make_data_texture(read_image(path), path, kind, notes).at({0.5f, 0.5f});
  };
  const std::string grey = folder.file("grey.png"), leaf = folder.file("leaf.png");
  write_row<png_byte>(grey, {51, 102, 204}, PNG_FORMAT_RGB);
  write_row<png_byte>(leaf, {51, 102, 204, 153}, PNG_FORMAT_RGBA);
  const DataKind roughness{.use = TextureUse::roughness, .encoded = true};
  EXPECT_NEAR(value(grey, roughness).y, 0.4f, 1e-5f);
  EXPECT_NEAR(value(leaf, roughness).z, 0.8f, 1e-5f);
  EXPECT_NEAR(value(leaf, {.use = TextureUse::opacity, .encoded = true}).y, 0.6f, 1e-5f);
  EXPECT_NEAR(value(grey, {.use = TextureUse::opacity, .encoded = true}).y, 0.4f, 1e-5f);
  EXPECT_EQ(value(grey, {.use = TextureUse::opacity, .encoded = true, .alpha_only = true}).y, 1);
  EXPECT_TRUE(notes.empty());
}

TEST(ReadPng, damaged_files_are_one_clear_line) {
  test::TempFolder folder;
  const std::string path = folder.file("ramp.png");
  write_png(grey_image(16, 16, std::vector<float>(256, 0.5f)), path, 0);
  std::string bytes;
  {
    std::ifstream file(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  for (std::size_t size = 4; size < bytes.size() - 16; ++size) {
    std::ofstream(path, std::ios::binary) << bytes.substr(0, size);
    try {
      read_image(path);
      ADD_FAILURE() << "cut to " << size << " bytes it was read";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("not a readable PNG"), std::string::npos)
          << error.what();
    }
  }
}

} // namespace
} // namespace vdbeam
