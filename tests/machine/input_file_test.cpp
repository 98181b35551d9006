#include "machine/input_file.h"

#include "support/temp_folder.h"
#include "vdbeam/error.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace vdbeam {
namespace {

namespace fs = std::filesystem;

class InputFiles : public ::testing::Test {
protected:
  std::string file(const std::string& name) const { return folder_.file(name); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }
  /// What is said of a path behind its name; every way to open a file says the same.
  static std::string refusal(const std::string& path) {
    std::string text;
    const auto expect = [&](const auto& open) {
      try {
        open();
        ADD_FAILURE() << path << " is opened";
      } catch (const InputError& error) {
        const std::string line = error.what();
        EXPECT_EQ(line.find(path), 0u) << line;
        EXPECT_TRUE(text.empty() || line == text) << line;
        text = line;
      }
    };
    expect([&] { open_input_file(path); });
    expect([&] { check_input_file(path, EmptyFile::accepted); });
    expect([&] { read_start(path, 4); });
    expect([&] { read_text(path, 100); });
    expect([&] { InputStream stream(path); });
    return text.substr(std::min(text.size(), path.size()));
  }
  test::TempFolder folder_;
};

TEST_F(InputFiles, AreRegularFiles) {
  ASSERT_EQ(mkfifo(file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(refusal(file("pipe")), ": is a pipe, not a regular file");
  EXPECT_EQ(refusal("/tmp"), ": is a folder, not a regular file");
  EXPECT_EQ(refusal("/dev/zero"), ": is a device, not a regular file");
  fs::create_symlink("pipe", file("link"));
  EXPECT_EQ(refusal(file("link")), ": is a pipe, not a regular file");

  const int end = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  file("socket").copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(end, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(refusal(file("socket")), ": is a socket, not a regular file");
  close(end);
}

TEST_F(InputFiles, HaveNamesThatLeadSomewhere) {
  EXPECT_EQ(refusal(file("none")), ": No such file or directory");
  EXPECT_FALSE(is_there(file("none")));
  fs::create_symlink("loop", file("loop"));
  EXPECT_EQ(refusal(file("loop")), ": its links lead in a circle");
  EXPECT_TRUE(is_there(file("loop")));
  try {
    open_input_file(file(std::string(5000, 'x')));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("File name too long"), std::string::npos);
  }
}

TEST_F(InputFiles, EmptyOnesMayStillBeCopied) {
  const std::string path = write("empty", "");
  EXPECT_THROW(open_input_file(path), FrameError); // trying again may help
  EXPECT_EQ(check_input_file(path, EmptyFile::accepted), 0u);
  EXPECT_EQ(read_text(path, 100), "");
}

/// The size is known before a byte is read: this file takes no room on the disk.
TEST_F(InputFiles, TooLargeTextsAreNotRead) {
  const std::string path = write("large", "");
  fs::resize_file(path, std::uintmax_t(1) << 40);
  try {
    read_text(path, 1 << 20);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("has 1024.0 GiB, more than the 1 MiB"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(InputFiles, AreReadWhole) {
  std::string text;
  for (int i = 0; i < 30'000; ++i)
    text += std::to_string(i) + "\n";
  const std::string path = write("numbers", text);
  EXPECT_EQ(read_text(path, text.size()), text);
  EXPECT_EQ(read_start(path, 5), "0\n1\n2");
  InputStream stream(path);
  EXPECT_EQ(stream.bytes(), text.size());
  std::string read, line;
  while (std::getline(stream, line))
    read += line + "\n";
  EXPECT_EQ(read, text);
}

TEST_F(InputFiles, CanBeSoughtIn) {
  std::string text;
  for (int i = 0; i < 200'000; ++i)
    text += static_cast<char>('a' + i % 26);
  InputStream stream(write("letters", text));
  EXPECT_EQ(stream.get(), 'a');
  stream.seekg(100'000);
  EXPECT_EQ(stream.tellg(), 100'000);
  EXPECT_EQ(stream.get(), text[100'000]);
  stream.seekg(3, std::ios::cur);
  EXPECT_EQ(stream.get(), text[100'004]);
  stream.seekg(-1, std::ios::end);
  EXPECT_EQ(stream.get(), text.back());
  EXPECT_EQ(stream.get(), std::char_traits<char>::eof());
  stream.clear();
  stream.seekg(1);
  EXPECT_EQ(stream.get(), 'b');
}

} // namespace
} // namespace vdbeam
