#include "vdb/vdb_reader.h"

#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

namespace vdbeam {
namespace {

/// Reads damaged copies of a real file; every one must end in a grid or an Error, in time. That
/// this program still runs after them is the rest of the test.
class HostileFile : public ::testing::Test {
protected:
  static constexpr double limit = 1;
  static constexpr double ample = 300; ///< where a result is expected, however busy the machine is

  void SetUp() override {
    VolumeOptions options;
    options.size = 24;
    write_volume("noise", folder_.file("good.vdb"), options);
    good_ = test::read_bytes(folder_.file("good.vdb"));
    ASSERT_GT(good_.size(), 10000u);
  }

  /// True where the file could be read all the same.
  bool read(const std::string& bytes, double seconds_allowed = limit) {
    const std::string path = folder_.file("damaged.vdb");
    test::write_bytes(path, bytes);
    const auto start = std::chrono::steady_clock::now();
    bool is_read = true;
    try {
      read_density_grid(path, "density", {seconds_allowed, std::uint64_t(1) << 29});
    } catch (const Error& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find(path), 0u) << line;
      EXPECT_EQ(line.find('\n'), line.npos) << line;
      is_read = false;
    }
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, seconds_allowed + 60) << "far beyond the limit, also for a busy machine";
    return is_read;
  }

  test::TempFolder folder_;
  std::string good_;
};

TEST_F(HostileFile, cut_short) {
  for (std::size_t part = 0; part < 60; ++part)
    EXPECT_FALSE(read(good_.substr(0, good_.size() * part / 60))) << part;
  for (std::size_t bytes = 0; bytes < 1200; bytes += 17)
    EXPECT_FALSE(read(good_.substr(0, bytes))) << bytes;
  EXPECT_TRUE(read(good_, ample));
}

TEST_F(HostileFile, changed_bytes_in_the_header) {
  std::mt19937 random(1);
  int read_all_the_same = 0;
  for (int n = 0; n < 120; ++n) {
    std::string bytes = good_;
    bytes[random() % 1200] = static_cast<char>(random());
    read_all_the_same += read(bytes);
  }
  EXPECT_LT(read_all_the_same, 110) << "the damage does no harm, so nothing is tested";
}

TEST_F(HostileFile, huge_numbers_in_the_header) {
  for (std::size_t at = 0; at < 1200; at += 11) {
    std::string bytes = good_;
    bytes.replace(at, 4, "\xff\xff\xff\x7f");
    read(bytes);
  }
}

TEST_F(HostileFile, changed_bytes_in_the_body) {
  std::mt19937 random(2);
  int read_all_the_same = 0;
  for (int n = 0; n < 120; ++n) {
    std::string bytes = good_;
    const std::size_t at = 1200 + random() % (good_.size() - 1300);
    for (std::size_t i = 0; i < 1 + random() % 4; ++i)
      bytes[at + i] = static_cast<char>(random());
    read_all_the_same += read(bytes);
  }
  EXPECT_LT(read_all_the_same, 110) << "the damage does no harm, so nothing is tested";
}

TEST_F(HostileFile, summaries_are_guarded_too) {
  std::mt19937 random(3);
  for (int n = 0; n < 30; ++n) {
    std::string bytes = good_;
    bytes[random() % bytes.size()] = static_cast<char>(random());
    test::write_bytes(folder_.file("damaged.vdb"), bytes);
    try {
      summarize_vdb(folder_.file("damaged.vdb"), {limit, std::uint64_t(1) << 29});
    } catch (const Error&) {
    }
  }
  test::write_bytes(folder_.file("damaged.vdb"), good_.substr(0, good_.size() / 2));
  EXPECT_THROW(summarize_vdb(folder_.file("damaged.vdb")), FrameError);
}

} // namespace
} // namespace vdbeam
