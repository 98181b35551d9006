#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cmath>
#include <string>
#include <vector>

namespace vdbeam {
namespace {

using test::TempFolder;
using test::write_bytes;

/// A JPEG of the highest quality, its pixels of this format.
std::string jpeg_of(const std::vector<unsigned char>& pixels, int width, int height,
                    TJPF format = TJPF_RGB, TJSAMP sampling = TJSAMP_444) {
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const tjhandle encoder = tjInitCompress();
  EXPECT_EQ(tjCompress2(encoder, pixels.data(), width, 0, height, format, &bytes, &size, sampling,
                        100, TJFLAG_ACCURATEDCT),
            0)
      << tjGetErrorStr2(encoder);
  std::string file(reinterpret_cast<const char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(encoder);
  return file;
}

double light_of(double code) {
  const double x = code / 255;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

std::string problem_of(const std::string& path) {
  try {
    read_image(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The first bytes decide, not the name. Codes are rounded twice, in YCbCr and in RGB.
TEST(ReadJpeg, CodesAreSrgb) {
  const TempFolder folder;
  const std::string path = folder.file("wood.png");
  std::vector<unsigned char> pixels;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      for (const int code : {8 * x, 16 * y, 100})
        pixels.push_back(static_cast<unsigned char>(code));
  write_bytes(path, jpeg_of(pixels, 32, 16));
  const Image image = read_image(path);
  ASSERT_EQ(image.width, 32);
  ASSERT_EQ(image.height, 16);
  const char* names[] = {"R", "G", "B"};
  for (std::size_t i = 0; i < 512; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double code = pixels[3 * i + c];
      const double read = image.find(names[c])->data[i];
      EXPECT_GE(read, light_of(std::max(0.0, code - 3)) - 1e-6) << i << names[c];
      EXPECT_LE(read, light_of(code + 3) + 1e-6) << i << names[c];
    }
}

TEST(ReadJpeg, GreyHasThreeChannels) {
  const TempFolder folder;
  const std::string path = folder.file("grey.jpg");
  write_bytes(path, jpeg_of(std::vector<unsigned char>(64, 188), 8, 8, TJPF_GRAY, TJSAMP_GRAY));
  const Image image = read_image(path);
  for (const char* name : {"R", "G", "B"})
    EXPECT_NEAR(image.find(name)->data[20], light_of(188), 1e-6) << name;
}

TEST(ReadJpeg, ReportsWhatItCannotRead) {
  const TempFolder folder;
  const std::string path = folder.file("a.jpg");
  std::vector<unsigned char> pixels(64 * 64 * 4);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = static_cast<unsigned char>(i * i % 251);
  write_bytes(path, jpeg_of(pixels, 64, 64, TJPF_CMYK));
  EXPECT_NE(problem_of(path).find("CMYK"), std::string::npos) << problem_of(path);

  const std::string whole = jpeg_of(pixels, 64, 64);
  for (const std::size_t length : {std::size_t{3}, whole.size() / 8, whole.size() / 2}) {
    write_bytes(path, whole.substr(0, length));
    EXPECT_TRUE(problem_of(path).starts_with(path + ": not a readable JPEG: ")) << problem_of(path);
  }

  // Height and width stand behind the mark of the frame and the number of bits.
  std::string huge = whole;
  const std::size_t frame = huge.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  huge.replace(frame + 5, 4, "\xff\xd0\xff\xd0");
  write_bytes(path, huge);
  EXPECT_NE(problem_of(path).find("2^28"), std::string::npos) << problem_of(path);
  huge.replace(frame + 5, 4, "\x30\x10\x30\x10");
  write_bytes(path, huge);
  EXPECT_NE(problem_of(path).find("is damaged"), std::string::npos) << problem_of(path);
}

} // namespace
} // namespace vdbeam
