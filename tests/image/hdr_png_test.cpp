#include "image/output_formats.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <limits>
#include <random>

namespace vdbeam {
namespace {

using test::read_bytes;
using test::TempFolder;
using test::write_bytes;

std::string header(const std::string& resolution, const std::string& extra = "") {
  return "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n" + extra + "\n" + resolution + "\n";
}

/// The pixel (x, y) counted from the top left of a test picture: exponent 136 scales by 1.
std::string pixel(int x, int y) {
  return {static_cast<char>(10 * x + 5), static_cast<char>(20 * y + 7), static_cast<char>(200),
          static_cast<char>(136)};
}

void expect_test_picture(const Image& image, int width, int height, float scale = 1) {
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y * width + x);
      ASSERT_EQ(image.find("R")->data[i], scale * static_cast<float>(10 * x + 5));
      ASSERT_EQ(image.find("G")->data[i], scale * static_cast<float>(20 * y + 7));
      ASSERT_EQ(image.find("B")->data[i], scale * 200.0f);
    }
}

TEST(Hdr, AllOrientations) {
  TempFolder folder;
  const int w = 5, h = 3;
  for (const char sy : {'-', '+'})
    for (const char sx : {'-', '+'})
      for (const bool columns : {false, true}) {
        std::string x_size = std::string(1, sx) + "X 5", y_size = std::string(1, sy) + "Y 3";
        std::string bytes = header(columns ? x_size + " " + y_size : y_size + " " + x_size);
        for (int j = 0; j < (columns ? w : h); ++j)
          for (int i = 0; i < (columns ? h : w); ++i) {
            const int x = columns ? j : i, y = columns ? i : j;
            bytes += pixel(sx == '+' ? x : w - 1 - x, sy == '-' ? y : h - 1 - y);
          }
        write_bytes(folder.file("a.hdr"), bytes);
        expect_test_picture(read_image(folder.file("a.hdr")), w, h);
      }
}

TEST(Hdr, RunLengthEncodedPlanes) {
  TempFolder folder;
  const int w = 20, h = 4;
  std::string bytes = header("-Y 4 +X 20", "EXPOSURE=2\nEXPOSURE=2\n");
  for (int y = 0; y < h; ++y) {
    bytes += {2, 2, 0, static_cast<char>(w)};
    bytes += static_cast<char>(w); // red: 20 literal bytes
    for (int x = 0; x < w; ++x)
      bytes += pixel(x, y)[0];
    for (std::size_t c = 1; c < 4; ++c) // the others: runs of 15 and 5
      bytes +=
          {static_cast<char>(128 + 15), pixel(0, y)[c], static_cast<char>(128 + 5), pixel(0, y)[c]};
  }
  write_bytes(folder.file("a.hdr"), bytes);
  expect_test_picture(read_image(folder.file("a.hdr")), w, h, 0.25f);
}

TEST(Hdr, OldRuns) {
  TempFolder folder;
  // 1 pixel and 300 = 44 + 1 * 256 repetitions.
  const std::string bytes = header("-Y 1 +X 301") + std::string("\x40\x50\x60\x88", 4) +
                            std::string("\1\1\1\x2c", 4) + std::string("\1\1\1\1", 4);
  write_bytes(folder.file("a.hdr"), bytes);
  const Image image = read_image(folder.file("a.hdr"));
  for (std::size_t i = 0; i < 301; ++i)
    ASSERT_EQ(image.find("G")->data[i], 80.0f);
}

TEST(Hdr, ZeroExponentIsBlack) {
  TempFolder folder;
  write_bytes(folder.file("a.hdr"), header("-Y 1 +X 1") + std::string("\x40\x50\x60\0", 4));
  EXPECT_EQ(read_image(folder.file("a.hdr")).find("R")->data[0], 0.0f);
}

TEST(Hdr, MalformedFilesAreInputErrors) {
  TempFolder folder;
  const std::string bad[] = {
      "#?RADIANCE\n",
      header("-Y 4 +Y 20"),
      header("-Y 0 +X 20"),
      header("-Y -4 +X 20"),
      header("-Y 1000000 +X 1000000"),
      header("-Y 99999999999999999999 +X 4"),
      header("-Y 4 +X 20"),                                        // no pixels
      header("-Y 1 +X 20") + std::string("\2\2\0\x15", 4),         // wrong length
      header("-Y 1 +X 20") + std::string("\2\2\0\x14\xff\x07", 6), // run too long
      header("-Y 1 +X 20") + std::string("\2\2\0\x14\0", 5),       // run of nothing
      header("-Y 1 +X 20") + std::string("\1\1\1\x05", 4),         // repeats nothing
      header("-Y 1 +X 1", "EXPOSURE=-1\n") + std::string("\1\2\3\4", 4),
      "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd",
      "#?" + std::string(100000, 'x'),
  };
  for (const std::string& bytes : bad) {
    write_bytes(folder.file("a.hdr"), bytes);
    EXPECT_THROW(read_image(folder.file("a.hdr")), InputError) << bytes.substr(0, 80);
  }
}

TEST(Hdr, MessagesQuoteInOneLine) {
  TempFolder folder;
  write_bytes(folder.file("a.hdr"), "#?RADIANCE\nFORMAT=62\rbit\x01\n\n-Y 1 +X 1\nabcd");
  try {
    read_image(folder.file("a.hdr"));
    ADD_FAILURE() << "was read";
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find_first_of("\r\n\x01"), line.npos) << line;
  }
}

TEST(Hdr, MutatedFilesNeverCrash) {
  TempFolder folder;
  std::string bytes = header("-Y 4 +X 20");
  for (int y = 0; y < 4; ++y)
    bytes += std::string("\2\2\0\x14\x94\x01\x94\x02\x94\x03\x94\x88", 12);
  std::mt19937 random(3);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string mutated = bytes;
    for (int k = 0; k < 2; ++k)
      mutated[2 + random() % (mutated.size() - 2)] = static_cast<char>(random());
    write_bytes(folder.file("a.hdr"), mutated);
    try {
      read_image(folder.file("a.hdr"));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

std::vector<unsigned char> read_png(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_file(&png, path.c_str())) << png.message;
  png.format = PNG_FORMAT_RGB;
  std::vector<unsigned char> pixels(PNG_IMAGE_SIZE(png));
  EXPECT_TRUE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr)) << png.message;
  return pixels;
}

Image make_grey(const std::vector<float>& values) {
  Image image;
  image.width = static_cast<int>(values.size());
  image.height = 1;
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, values});
  return image;
}

TEST(Png, EncodesSrgbAndSurvivesAnyValue) {
  TempFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  const Image image =
      make_grey({0, 0.001f, 0.18f, 0.5f, 1, 7, -3, std::nanf(""), infinity, -infinity});
  write_png(image, folder.file("a.png"), 0, "srgb");
  const std::vector<unsigned char> pixels = read_png(folder.file("a.png"));
  // 18 % grey is sRGB 117.6, half is 187.5 (IEC 61966-2-1); dithering takes a level beside that.
  const double expected[] = {0, 3.29, 117.65, 187.52, 255, 255, 0, 0, 255, 0};
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_GE(pixels[3 * i + 1], std::floor(expected[i])) << i;
    EXPECT_LE(pixels[3 * i + 1], std::ceil(expected[i])) << i;
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"});
}

TEST(Png, APassingOneHasTheSamePixels) {
  TempFolder folder;
  std::vector<float> ramp;
  for (int i = 0; i < 4096; ++i)
    ramp.push_back(static_cast<float>(i) / 2048);
  write_png(make_grey(ramp), folder.file("a.png"));
  write_png(make_grey(ramp), folder.file("b.png"), 0, "filmic", ImageLife::passing);
  EXPECT_EQ(read_png(folder.file("a.png")), read_png(folder.file("b.png")));
}

TEST(Png, ExposureIsInStops) {
  TempFolder folder;
  write_png(make_grey({0.25f}), folder.file("a.png"), 1, "srgb");
  EXPECT_EQ(read_png(folder.file("a.png"))[0], 188);
}

/// Neither a sky has bands, nor does a value that 8 bits hold change.
TEST(Png, IsDithered) {
  const TempFolder folder;
  std::vector<float> sky(64 * 64);
  for (std::size_t i = 0; i < sky.size(); ++i)
    sky[i] = 0.2f + 0.0002f * static_cast<float>(i / 64); // between two levels
  Image image = make_grey(sky);
  image.width = image.height = 64;
  write_png(image, folder.file("sky.png"), 0, "srgb");
  const std::vector<unsigned char> pixels = read_png(folder.file("sky.png"));
  for (std::size_t row = 0; row < 64; ++row) {
    double sum = 0;
    for (std::size_t x = 0; x < 64; ++x)
      sum += pixels[3 * (row * 64 + x)];
    const double linear = 0.2 + 0.0002 * static_cast<double>(row);
    EXPECT_NEAR(sum / 64, 255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055), 0.1) << row;
  }
  for (const float value : {0.0f, 1.0f}) {
    image.channels = make_grey(std::vector<float>(64 * 64, value)).channels;
    write_png(image, folder.file("even.png"), 0, "srgb");
    for (const unsigned char pixel : read_png(folder.file("even.png")))
      ASSERT_EQ(pixel, value * 255);
  }
}

TEST(Png, UnknownViewsAreInputErrors) {
  TempFolder folder;
  EXPECT_THROW(write_png(make_grey({1}), folder.file("a.png"), 0, "none"), InputError);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Png, FailuresAreFrameErrors) {
  TempFolder folder;
  EXPECT_THROW(write_png(make_grey({1}), folder.file("no/a.png")), FrameError);
  Image image = make_grey({1});
  image.channels.pop_back();
  EXPECT_THROW(write_png(image, folder.file("a.png")), FrameError);
  EXPECT_TRUE(folder.names().empty());
}

TEST(OutputFormats, EveryFormatWritesItsFile) {
  TempFolder folder;
  for (const OutputFormat& format : output_formats()) {
    const std::string path = folder.file(std::string("a").append(format.extension));
    write_image(make_grey({0.5f, 1}), path);
    EXPECT_GT(read_bytes(path).size(), 0u) << path;
  }
  EXPECT_EQ(output_format("x/Y.EXR").extension, ".exr");
}

TEST(OutputFormats, UnknownExtensionNamesTheKnown) {
  try {
    output_format("cloud.tif");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(".exr or .png"), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace vdbeam
