#pragma once

#include "vdbeam/deep_image.h"

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputFile.h>
#include <ImfHeader.h>
#include <gtest/gtest.h>

#include <string>

namespace vdbeam::test {

/// The samples of a deep EXR, through OpenEXR's own reader.
inline DeepImage read_deep(const std::string& path) {
  Imf::DeepScanLineInputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  DeepImage image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  const auto width = static_cast<std::size_t>(image.width);
  image.counts.resize(width * static_cast<std::size_t>(image.height));
  const std::ptrdiff_t shift =
      static_cast<std::ptrdiff_t>(window.min.y) * image.width + window.min.x;
  const auto base = [&](void* data, std::size_t size) {
    return static_cast<char*>(data) - shift * static_cast<std::ptrdiff_t>(size);
  };
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, base(image.counts.data(), 4), 4, 4 * width));
  file.setFrameBuffer(frame);
  file.readPixelSampleCounts(window.min.y, window.max.y);
  std::size_t samples = 0;
  for (const std::uint32_t count : image.counts)
    samples += count;
  const std::pair<const char*, std::vector<float>*> channels[] = {
      {"R", &image.r}, {"G", &image.g}, {"B", &image.b},
      {"A", &image.a}, {"Z", &image.z}, {"ZBack", &image.z_back}};
  std::vector<std::vector<float*>> pointers;
  for (const auto& [name, values] : channels) {
    values->resize(samples);
    std::vector<float*>& list = pointers.emplace_back();
    std::size_t at = 0;
    for (const std::uint32_t count : image.counts) {
      list.push_back(values->data() + at);
      at += count;
    }
    frame.insert(name, Imf::DeepSlice(Imf::FLOAT, base(list.data(), sizeof(float*)), sizeof(float*),
                                      sizeof(float*) * width, sizeof(float)));
  }
  file.setFrameBuffer(frame);
  file.readPixelSampleCounts(window.min.y, window.max.y);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

inline void expect_same_deep(const DeepImage& a, const DeepImage& b) {
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.z_back, b.z_back);
  EXPECT_EQ(a.r, b.r);
  EXPECT_EQ(a.g, b.g);
  EXPECT_EQ(a.b, b.b);
  EXPECT_EQ(a.a, b.a);
}

} // namespace vdbeam::test
