#include "image/layer_names.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

Image with_motion() {
  Image image;
  image.width = 2;
  image.height = 1;
  image.channels = {
      {"R", {1, 1}, true}, {"motion.X", {3, -1}, false}, {"motion.Y", {0.5f, 2}, false}};
  return image;
}

/// What moves by v has been at -v a frame ago, and of a frame later this is -v.
TEST(LayerNames, CyclesHasTwoVectorsBackInTime) {
  Image image = with_motion();
  rename_layers(image, "cycles");
  const std::vector<float> x{-3, 1}, y{-0.5f, -2};
  for (const auto& [name, values] : {std::pair("X", x), {"Y", y}, {"Z", x}, {"W", y}}) {
    const ImageChannel* channel = image.find(std::string("ViewLayer.Vector.") + name);
    ASSERT_NE(channel, nullptr) << name;
    EXPECT_EQ(channel->data, values) << name;
  }
  EXPECT_EQ(image.channels.size(), 5u);
}

TEST(LayerNames, ArnoldHasTheMotionAsItIs) {
  Image image = with_motion();
  rename_layers(image, "arnold");
  EXPECT_EQ(image.find("motionvector.X")->data, with_motion().channels[1].data);
  EXPECT_EQ(image.channels.size(), 3u);
}

} // namespace
} // namespace vdbeam
