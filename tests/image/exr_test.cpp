#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <half.h>

#include <cmath>
#include <csignal>
#include <random>
#include <sys/resource.h>

namespace vdbeam {
namespace {

using test::read_bytes;
using test::TempFolder;
using test::write_bytes;

Image make_image(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  std::mt19937 random(7);
  std::lognormal_distribution<float> values;
  for (const char* name : {"R", "G", "B", "A", "volume_direct.R", "depth.Z"}) {
    ImageChannel channel{name, {}, std::string(name) != "depth.Z"};
    for (int i = 0; i < width * height; ++i)
      channel.data.push_back(values(random));
    image.channels.push_back(channel);
  }
  return image;
}

/// The one line that reading throws, or "" where it does not.
std::string read_error(const std::string& path) {
  try {
    read_image(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string write_error(const Image& image, const std::string& path) {
  try {
    write_exr(image, path);
  } catch (const FrameError& error) {
    return error.what();
  }
  return "";
}

TEST(Exr, RoundTripKeepsFloatsAndRoundsHalves) {
  TempFolder folder;
  const Image image = make_image(37, 23);
  write_exr(image, folder.file("a.exr"));
  const Image back = read_image(folder.file("a.exr"));
  ASSERT_EQ(back.width, 37);
  ASSERT_EQ(back.height, 23);
  ASSERT_EQ(back.channels.size(), image.channels.size());
  for (const ImageChannel& channel : image.channels) {
    const ImageChannel* read = back.find(channel.name);
    ASSERT_TRUE(read) << channel.name;
    EXPECT_EQ(read->half, channel.half) << channel.name;
    for (std::size_t i = 0; i < channel.data.size(); ++i)
      ASSERT_EQ(read->data[i], channel.half ? float(half(channel.data[i])) : channel.data[i]);
  }
}

TEST(Exr, KeepsAttributes) {
  TempFolder folder;
  Image image = make_image(4, 3);
  image.metadata["vdbeam.scene"] = "cloud.toml";
  image.numbers["vdbeam.seconds"] = 0.1;
  image.numbers["framesPerSecond"] = 24;
  image.numbers["vdbeam.frame"] = -7;
  image.numbers["vdbeam.seed"] = 3e10; // too large for an integer attribute
  image.integers = {"vdbeam.frame", "vdbeam.seed"};
  image.metadata["timeCode"] = "01:02:03:04";
  image.matrices["position"] = {1, 2, 3};
  image.matrices["worldToCamera"] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
  write_exr(image, folder.file("a.exr"));
  const Image back = read_image(folder.file("a.exr"));
  EXPECT_EQ(back.metadata.at("vdbeam.scene"), "cloud.toml");
  EXPECT_EQ(back.numbers.at("vdbeam.seconds"), 0.1);
  EXPECT_EQ(back.numbers.at("framesPerSecond"), 24);
  EXPECT_EQ(back.numbers.at("vdbeam.frame"), -7);
  EXPECT_EQ(back.numbers.at("vdbeam.seed"), 3e10);
  EXPECT_TRUE(back.integers.contains("vdbeam.frame"));
  EXPECT_FALSE(back.integers.contains("vdbeam.seed"));
  EXPECT_EQ(back.metadata.at("timeCode"), "01:02:03:04");
  EXPECT_EQ(back.matrices.at("position"), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(back.matrices.at("worldToCamera"), image.matrices.at("worldToCamera"));

  Imf::InputFile file(folder.file("a.exr").c_str());
  EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
  ASSERT_TRUE(Imf::hasChromaticities(file.header()));
  EXPECT_FLOAT_EQ(Imf::chromaticities(file.header()).red.x, 0.64f);
  EXPECT_TRUE(Imf::hasFramesPerSecond(file.header()));
}

TEST(Exr, AttributeThatClashesWithAStandardOneIsAFrameError) {
  TempFolder folder;
  Image image = make_image(4, 3);
  image.metadata["compression"] = "best";
  EXPECT_NE(write_error(image, folder.file("a.exr")), "");
  EXPECT_TRUE(folder.names().empty());
}

TEST(Exr, HalfOverflowBecomesAFloatChannel) {
  TempFolder folder;
  Image image = make_image(4, 3);
  image.channels[0].data[5] = 1e6f;
  image.channels[1].data[5] = 65504.0f;
  image.channels[2].data[5] = std::numeric_limits<float>::infinity();
  write_exr(image, folder.file("a.exr"));
  const Image back = read_image(folder.file("a.exr"));
  EXPECT_EQ(back.find("R")->data[5], 1e6f);
  EXPECT_FALSE(back.find("R")->half);
  EXPECT_EQ(back.find("G")->data[5], 65504.0f);
  EXPECT_TRUE(back.find("G")->half);
  EXPECT_TRUE(std::isinf(back.find("B")->data[5]));
}

TEST(Exr, DarkChannelsKeepTheirDigits) {
  TempFolder folder;
  for (const float radiance : {1e-20f, 1e-7f, 1e-4f, 2e-3f, 0.0f}) {
    Image image = make_image(4, 3);
    for (std::size_t i = 0; i < image.channels[0].data.size(); ++i)
      image.channels[0].data[i] = i == 3 ? radiance : 0.5f * radiance;
    write_exr(image, folder.file("a.exr"));
    const Image back = read_image(folder.file("a.exr"));
    EXPECT_EQ(back.find("R")->half, radiance == 0 || radiance > 1e-3f) << radiance;
    EXPECT_NEAR(back.find("R")->data[3], radiance, 1e-3f * radiance);
  }
}

TEST(Exr, ReplacesAFileAndLeavesNothingElse) {
  TempFolder folder;
  write_bytes(folder.file("a.exr"), "old");
  write_exr(make_image(4, 3), folder.file("a.exr"));
  EXPECT_EQ(read_image(folder.file("a.exr")).width, 4);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.exr"});
}

TEST(Exr, WritesThroughASymbolicLink) {
  TempFolder folder;
  write_bytes(folder.file("real.exr"), "old");
  std::filesystem::create_symlink("real.exr", folder.file("link.exr"));
  write_exr(make_image(4, 3), folder.file("link.exr"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.exr")));
  EXPECT_EQ(read_image(folder.file("real.exr")).width, 4);
}

TEST(Exr, MissingFolderDeviceAndFolderAreFrameErrors) {
  TempFolder folder;
  const Image image = make_image(4, 3);
  const std::string missing = write_error(image, folder.file("no/such/a.exr"));
  EXPECT_NE(missing.find("No such file or directory"), std::string::npos) << missing;
  EXPECT_NE(missing.find("create its folder"), std::string::npos) << missing;
  EXPECT_NE(write_error(image, "/dev/null").find("not a regular file"), std::string::npos);
  EXPECT_NE(write_error(image, folder.file("")).find("Is a directory"), std::string::npos);
  EXPECT_NE(write_error(image, ""), "");
}

/// Files may not grow over `bytes` while it lives: what a full disk looks like to the writer.
class FileSizeLimit {
public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &saved_);
    const rlimit limit{bytes, saved_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &saved_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
  rlimit saved_{};
  void (*handler_)(int);
};

TEST(Exr, FailedWriteKeepsTheOldFileAndRemovesTheTemporaryOne) {
  TempFolder folder;
  const Image image = make_image(200, 100);
  write_bytes(folder.file("a.exr"), "old");
  for (const rlim_t bytes : {0u, 100u, 5000u, 50000u}) {
    std::string line;
    {
      const FileSizeLimit limit(bytes);
      line = write_error(image, folder.file("a.exr"));
    }
    EXPECT_NE(line.find("File too large"), std::string::npos) << line;
    EXPECT_EQ(read_bytes(folder.file("a.exr")), "old");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.exr"});
  }
}

TEST(Exr, MalformedImagesAreFrameErrors) {
  TempFolder folder;
  Image image = make_image(4, 3);
  image.channels[2].data.pop_back();
  EXPECT_NE(write_error(image, folder.file("a.exr")).find("channel B"), std::string::npos);
  EXPECT_NE(write_error(Image{}, folder.file("a.exr")), "");
}

void write_windowed(const std::string& path, Imath::Box2i display, Imath::Box2i data,
                    const char* channel) {
  Imf::Header header(display, data);
  header.channels().insert(channel, Imf::Channel(Imf::UINT));
  std::vector<std::uint32_t> values;
  for (int y = data.min.y; y <= data.max.y; ++y)
    for (int x = data.min.x; x <= data.max.x; ++x)
      values.push_back(static_cast<std::uint32_t>(1000 + 100 * y + x));
  Imf::FrameBuffer buffer;
  const auto width = static_cast<std::size_t>(data.max.x - data.min.x + 1);
  buffer.insert(channel, Imf::Slice::Make(Imf::UINT, values.data(), data, 4, 4 * width));
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(data.max.y - data.min.y + 1);
}

TEST(Exr, DataWindowIsPlacedInTheDisplayWindow) {
  TempFolder folder;
  // Data over, inside and off the display window.
  const Imath::Box2i display({2, 1}, {9, 6});
  const Imath::Box2i windows[] = {
      {{4, 3}, {5, 5}}, {{-3, -2}, {5, 3}}, {{0, 0}, {12, 9}}, {{20, 20}, {22, 21}}};
  for (const Imath::Box2i& data : windows) {
    write_windowed(folder.file("a.exr"), display, data, "R");
    const Image image = read_image(folder.file("a.exr"));
    ASSERT_EQ(image.width, 8);
    ASSERT_EQ(image.height, 6);
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) {
        const bool inside = data.intersects(Imath::V2i{x + 2, y + 1});
        ASSERT_EQ(image.find("R")->data[static_cast<std::size_t>(8 * y + x)],
                  inside ? static_cast<float>(1000 + 100 * (y + 1) + x + 2) : 0.0f);
      }
  }
}

TEST(Exr, LuminanceBecomesGrey) {
  TempFolder folder;
  write_windowed(folder.file("a.exr"), {{0, 0}, {3, 2}}, {{0, 0}, {3, 2}}, "Y");
  const Image image = read_image(folder.file("a.exr"));
  for (const char* name : {"R", "G", "B"}) {
    ASSERT_TRUE(image.find(name));
    EXPECT_EQ(image.find(name)->data, image.find("Y")->data);
  }
  EXPECT_EQ(image.find("R")->data[4], 1100.0f);
}

TEST(Exr, TruncatedFilesAreInputErrors) {
  TempFolder folder;
  write_exr(make_image(64, 64), folder.file("a.exr"));
  const std::string bytes = read_bytes(folder.file("a.exr"));
  for (std::size_t size = 0; size < bytes.size(); size += bytes.size() / 40) {
    write_bytes(folder.file("b.exr"), bytes.substr(0, size));
    const std::string line = read_error(folder.file("b.exr"));
    EXPECT_NE(line, "") << size;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

TEST(Exr, MutatedFilesAreReadOrRefusedWithinBoundedMemory) {
  TempFolder folder;
  write_exr(make_image(16, 16), folder.file("a.exr"));
  const std::string bytes = read_bytes(folder.file("a.exr"));
  std::mt19937 random(11);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string mutated = bytes;
    for (int k = 0; k < 3; ++k)
      mutated[4 + random() % std::min<std::size_t>(mutated.size() - 4, 600)] =
          static_cast<char>(random());
    write_bytes(folder.file("b.exr"), mutated);
    refused += read_error(folder.file("b.exr")).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 50);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(usage.ru_maxrss, 1 << 20) << "KiB";
#endif
}

TEST(Exr, AbsurdWindowsAreRefused) {
  TempFolder folder;
  write_exr(make_image(16, 16), folder.file("a.exr"));
  std::string bytes = read_bytes(folder.file("a.exr"));
  const std::size_t window = bytes.find("dataWindow");
  ASSERT_NE(window, std::string::npos);
  const std::size_t upper = window + std::string("dataWindow").size() + 1 + 6 + 4 + 8;
  for (const std::size_t at : {upper + 2, upper + 6, upper + 3, upper + 7}) {
    std::string huge = bytes;
    huge[at] = 0x7f;
    write_bytes(folder.file("b.exr"), huge);
    EXPECT_NE(read_error(folder.file("b.exr")), "");
  }
}

TEST(ReadImage, NamesWhatIsWrong) {
  TempFolder folder;
  EXPECT_NE(read_error(folder.file("none.exr")).find("No such file"), std::string::npos);
  write_bytes(folder.file("empty.exr"), "");
  EXPECT_NE(read_error(folder.file("empty.exr")).find("empty"), std::string::npos);
  write_bytes(folder.file("text.exr"), "hello, world");
  EXPECT_NE(read_error(folder.file("text.exr")).find("neither"), std::string::npos);
  EXPECT_NE(read_error(folder.file("")), "");
}

} // namespace
} // namespace vdbeam
