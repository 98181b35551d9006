#pragma once

#include "vdbeam/error.h"
#include "vdbeam/image.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace vdbeam::test {

/// The values of a channel. Throws FrameError where the image has none of that name.
inline const std::vector<float>& plane(const Image& image, const std::string& name) {
  const ImageChannel* channel = image.find(name);
  if (!channel)
    throw FrameError("no channel " + name);
  return channel->data;
}

/// Channels, names and values, bit for bit.
inline void expect_same_pixels(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    EXPECT_EQ(a.channels[c].name, b.channels[c].name);
    ASSERT_EQ(a.channels[c].data.size(), b.channels[c].data.size());
    EXPECT_EQ(std::memcmp(a.channels[c].data.data(), b.channels[c].data.data(),
                          a.channels[c].data.size() * sizeof(float)),
              0)
        << a.channels[c].name;
  }
}

} // namespace vdbeam::test
