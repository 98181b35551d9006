// Files that all threads pack are to the bit those that OpenEXR writes by itself.
#include "image/exr_scanlines.h"

#include "support/temp_folder.h"

#include <ImfChannelList.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <fstream>
#include <iterator>
#include <random>

namespace vdbeam {
namespace {

constexpr int width = 37, height = 301;

/// A float and a half channel, some of whose blocks are constant.
struct Pixels {
  std::vector<float> depth = std::vector<float>(width * height);
  std::vector<Imath::half> red = std::vector<Imath::half>(width * height);

  Pixels() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(0, 2);
    for (int i = 0; i < width * height; ++i) {
      const bool even = i / width / 20 % 2 == 0;
      depth[static_cast<std::size_t>(i)] = even ? 1 : value(random);
      red[static_cast<std::size_t>(i)] = Imath::half(even ? 0.5f : value(random));
    }
  }

  Imf::FrameBuffer buffer(const Imath::Box2i& window) const {
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice::Make(Imf::HALF, red.data(), window));
    buffer.insert("depth.Z", Imf::Slice::Make(Imf::FLOAT, depth.data(), window));
    return buffer;
  }
};

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ExrScanlines, AreThoseOfOpenExr) {
  const test::TempFolder folder;
  const Pixels pixels;
  const Imath::Box2i window({-3, -20}, {width - 4, height - 21});
  for (int c = 0; c < Imf::NUM_COMPRESSION_METHODS; ++c) {
    Imf::Header header({{0, 0}, {63, 299}}, window);
    header.compression() = static_cast<Imf::Compression>(c);
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.channels().insert("depth.Z", Imf::Channel(Imf::FLOAT));
    header.insert("comment", Imf::StringAttribute(std::string(1000, 'x')));
    const Imf::FrameBuffer buffer = pixels.buffer(window);
    {
      Imf::OutputFile file(folder.file("theirs.exr").c_str(), header, 0);
      file.setFrameBuffer(buffer);
      file.writePixels(height);
    }
    const std::string theirs = bytes_of(folder.file("theirs.exr"));
    for (const std::size_t threads : {1u, 2u, 5u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      AtomicFile file(folder.file("ours.exr"));
      write_scanlines(
          header, [&](const Imath::Box2i&, BandHalves&) { return buffer; }, file);
      file.commit();
      EXPECT_EQ(bytes_of(folder.file("ours.exr")), theirs) << "compression " << c;
    }
  }
}

} // namespace
} // namespace vdbeam
