#include "film/cryptomatte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace vdbeam {
namespace {

/// Values that Appleby's own code and other implementations give.
TEST(Cryptomatte, HashIsMurmurs) {
  EXPECT_EQ(murmur_hash(""), 0u);
  EXPECT_EQ(murmur_hash("hello"), 0x248bfa47u);
  EXPECT_EQ(murmur_hash("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(murmur_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(Cryptomatte, IdsAreNumbersThatFilesKeep) {
  for (int i = 0; i < 5000; ++i) {
    const float id = object_id("object" + std::to_string(i));
    ASSERT_TRUE(std::isnormal(id)) << i;
  }
}

TEST(Cryptomatte, SortsByCoverage) {
  Image image;
  image.width = 2;
  image.height = 1;
  const std::vector<std::string> names{"a", "b", "c"};
  const float coverage[2][3] = {{0.25f, 0.5f, 0.125f}, {0, 0.75f, 0}};
  add_cryptomatte(
      names, [&](std::size_t object, std::size_t pixel) { return coverage[pixel][object]; }, image);
  const auto value = [&](const char* channel, std::size_t pixel) {
    return image.find(channel)->data[pixel];
  };
  EXPECT_EQ(value("CryptoObject00.R", 0), object_id("b"));
  EXPECT_EQ(value("CryptoObject00.G", 0), 0.5f);
  EXPECT_EQ(value("CryptoObject00.B", 0), object_id("a"));
  EXPECT_EQ(value("CryptoObject00.A", 0), 0.25f);
  EXPECT_EQ(value("CryptoObject01.R", 0), object_id("c"));
  EXPECT_EQ(value("CryptoObject01.G", 0), 0.125f);
  EXPECT_EQ(value("CryptoObject00.R", 1), object_id("b"));
  EXPECT_EQ(value("CryptoObject00.B", 1), 0);
  EXPECT_EQ(value("CryptoObject02.A", 1), 0);
  EXPECT_FALSE(image.find("CryptoObject00.R")->half);
}

TEST(Cryptomatte, AttributesTellTheNames) {
  Image image;
  image.width = image.height = 1;
  add_cryptomatte(
      {"smoke", "the \"dragon\""}, [](std::size_t, std::size_t) { return 0.5f; }, image);
  std::string manifest;
  for (const auto& [name, text] : image.metadata) {
    EXPECT_TRUE(name.starts_with("cryptomatte/")) << name;
    EXPECT_EQ(name.find('/', 12), 19u) << "seven digits";
    if (name.ends_with("/manifest"))
      manifest = text;
  }
  EXPECT_EQ(image.metadata.size(), 4u);
  char digits[9];
  std::snprintf(digits, sizeof digits, "%08x", std::bit_cast<std::uint32_t>(object_id("smoke")));
  EXPECT_TRUE(manifest.starts_with(std::string("{\"smoke\":\"") + digits + "\",")) << manifest;
  EXPECT_NE(manifest.find("\"the \\\"dragon\\\"\":"), std::string::npos) << manifest;
}

} // namespace
} // namespace vdbeam
