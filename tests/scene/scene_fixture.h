#pragma once

#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

namespace vdbeam::test {

/// A fresh folder that goes with the test, with helpers to write scene files into it.
class SceneTest : public ::testing::Test {
protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "vdbeam_scene_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }
  /// Loads this text as "s.toml" of a folder that holds "cloud.vdb" (its content is never parsed).
  Scene load(const std::string& text, const std::vector<std::string>& overrides = {},
             const FrameTime& frame = {}) const {
    if (!std::filesystem::exists(file("cloud.vdb")))
      write("cloud.vdb", " BDV first");
    return load_scene(write("s.toml", text), frame, overrides);
  }
  /// The message of the InputError that this text causes, without the folder's name; empty if none.
  std::string error_of(const std::string& text,
                       const std::vector<std::string>& overrides = {}) const {
    try {
      load(text, overrides);
    } catch (const InputError& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      return without_folder(error.what());
    }
    return {};
  }
  std::string without_folder(std::string message) const {
    const std::string prefix = folder_.string() + "/";
    for (std::size_t at = 0; (at = message.find(prefix, at)) != std::string::npos;)
      message.erase(at, prefix.size());
    return message;
  }

  std::filesystem::path folder_;
};

} // namespace vdbeam::test
