#include "fuzz/scene_case.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace vdbeam {
namespace {

/// Inputs that a fuzzer found worth keeping, and every prefix of the sample scenes' first lines.
TEST(FuzzCorpus, EveryInputGivesASceneOrOneLine) {
  const test::TempFolder folder;
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(VDBEAM_SOURCE_DIR "/tests/fuzz/corpus")) {
    SCOPED_TRACE(entry.path().string());
    EXPECT_EQ(
        test::read_scene_bytes(test::read_bytes(entry.path().string()), folder.file("s.toml")), "");
    ++count;
  }
  EXPECT_GT(count, 10);
}

TEST(FuzzCorpus, EveryPrefixOfAScene) {
  const test::TempFolder folder;
  const std::string text = test::read_bytes(VDBEAM_SOURCE_DIR "/data/cloud.toml");
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_EQ(test::read_scene_bytes(text.substr(0, size), folder.file("s.toml")), "") << size;
}

} // namespace
} // namespace vdbeam
