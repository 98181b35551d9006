#include "lights/lamps/ies_profile.h"
#include "support/degrees.h"
#include "support/ies_text.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sys/stat.h>

namespace vdbeam {
namespace {

using test::angles;
using test::ies_text;

/// The integral over all directions by the midpoint rule.
double by_midpoints(const IesProfile& profile) {
  constexpr int n = 720;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double v = 180.0 * (i + 0.5) / n, h = 360.0 * (j + 0.5) / n;
      sum += profile.at(v, h) * std::sin(v * degrees);
    }
  return sum * (std::numbers::pi / n) * (2 * std::numbers::pi / n);
}

TEST(IesProfile, InterpolatesBetweenTheAnglesOfTheFile) {
  const IesProfile profile(ies_text({0, 60, 90}, {0}, [](double v, double) { return 200 - v; }),
                           "a.ies");
  EXPECT_DOUBLE_EQ(profile.candela(), 200);
  EXPECT_DOUBLE_EQ(profile.at(0, 10), 1);
  EXPECT_DOUBLE_EQ(profile.at(30, 170), 0.85);
  EXPECT_DOUBLE_EQ(profile.at(90, 350), 0.55);
  EXPECT_EQ(profile.at(90.1, 0), 0);
  EXPECT_EQ(profile.at(180, 0), 0);
}

/// A sphere that shines alike everywhere, a Lambertian disk, and a profile without symmetry.
TEST(IesProfile, IntegralIsThatOfTheInterpolatedProfile) {
  const IesProfile even(ies_text({0, 180}, {0}, [](double, double) { return 5; }), "a.ies");
  EXPECT_NEAR(even.integral(), 4 * std::numbers::pi, 1e-12);
  const IesProfile matt(ies_text(angles(0, 90, 900), {0},
                                 [](double v, double) { return 70 * std::cos(v * degrees); }),
                        "a.ies");
  EXPECT_NEAR(matt.integral(), std::numbers::pi, 1e-6);
  const auto uneven = [](double v, double h) { return (180 - v) * (1.5 + std::sin(h * degrees)); };
  for (const auto& planes : {angles(0, 360, 24), angles(0, 180, 12), angles(0, 90, 6),
                             angles(90, 270, 12), angles(0, 345, 23)}) {
    const IesProfile profile(ies_text(angles(0, 180, 18), planes, uneven), "a.ies");
    EXPECT_NEAR(profile.integral(), by_midpoints(profile), 2e-5 * profile.integral())
        << planes.back();
  }
}

TEST(IesProfile, PlanesThatTheFileLeavesOutAreMirrorImages) {
  const auto uneven = [](double, double h) { return 1000 - h; };
  const auto read = [&](const std::vector<double>& planes) {
    return IesProfile(ies_text({0, 180}, planes, uneven), "a.ies");
  };
  const IesProfile whole = read(angles(0, 360, 36)), half = read(angles(0, 180, 18)),
                   quarter = read(angles(0, 90, 9)), other = read(angles(90, 270, 18));
  for (const double h : {0.0, 5.0, 90.0, 133.0, 180.0, 222.0, 270.0, 301.0, 359.0}) {
    const double about_0 = h > 180 ? 360 - h : h;
    const double about_90 = h < 90 ? 180 - h : h > 270 ? 540 - h : h;
    const double in_quarter = about_0 > 90 ? 180 - about_0 : about_0;
    EXPECT_NEAR(whole.at(50, h), (1000 - h) / 1000, 1e-12);
    EXPECT_NEAR(half.at(50, h), (1000 - about_0) / 1000, 1e-12);
    EXPECT_NEAR(quarter.at(50, h), (1000 - in_quarter) / 1000, 1e-12);
    EXPECT_NEAR(other.at(50, h), (1000 - about_90) / 910, 1e-12);
  }
}

TEST(IesProfile, ReadsOlderFilesWithTilt) {
  const std::string text = "a line\nIt is from 1986\nTILT=INCLUDE\n1\n3\n0 45 90\n1,0.9,0.8\n"
                           "2 500 2.5 2 1 1 1 0.1 0.1 0\n0.5 1 40\n0 90\n0\n8\n4\n";
  const IesProfile profile(text, "a.ies");
  EXPECT_DOUBLE_EQ(profile.candela(), 8 * 2.5 * 0.5);
  EXPECT_DOUBLE_EQ(profile.at(45, 0), 0.75);
}

std::string complaint(const std::string& text) {
  try {
    IesProfile(text, "a.ies");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(IesProfile, BadFilesAreToldInALine) {
  const std::string head = "IESNA:LM-63-2002\nTILT=NONE\n";
  const auto flat = [](double, double) { return 1; };
  EXPECT_EQ(complaint(""),
            "a.ies:0: is not a photometric file of LM-63: it ends before a line TILT=NONE");
  EXPECT_EQ(complaint(std::string(5000, '\x7f')),
            "a.ies:1: is not a photometric file of LM-63: it ends before a line TILT=NONE");
  EXPECT_EQ(complaint(head), "a.ies:3: ends where the number of lamps should be");
  EXPECT_EQ(complaint(head + "1 lumens"),
            "a.ies:3: lumens per lamp must be a number, got \"lumens\"");
  EXPECT_EQ(complaint(head + "1 nan"), "a.ies:3: lumens per lamp must be a number, got \"nan\"");
  EXPECT_EQ(complaint(head + "1 1 1\n2e9 1"), "a.ies:4: the number of vertical angles must be a "
                                              "whole number from 1 to 10000, got 2000000000");
  EXPECT_EQ(complaint(head + "1 1 1 10000 10000"),
            "a.ies:3: has 10000 x 10000 intensities; there may be 4194304");
  EXPECT_EQ(complaint(head + "1 1 1 2 1 2"),
            "a.ies:3: the photometric type must be 1 (C), got 2 (B): convert the file to type C");
  EXPECT_EQ(complaint(head + "1 1 0"),
            "a.ies:3: the multiplier of candela must be greater than 0, got 0");
  EXPECT_EQ(complaint(ies_text({0, 90, 45}, {0}, flat)),
            "a.ies:7: a vertical angle must ascend, got 45 after 90");
  EXPECT_EQ(complaint(ies_text({0, 200}, {0}, flat)),
            "a.ies:7: a vertical angle must lie in [0, 180], got 200");
  EXPECT_EQ(
      complaint(ies_text({0, 90}, {0, 40}, flat)),
      "a.ies:8: the horizontal angles must go from 0 to 90, 180 or 360, or from 90 to 270, got 0 "
      "to 40");
  EXPECT_EQ(complaint(ies_text({0, 90}, {0}, [](double v, double) { return v - 10; })),
            "a.ies:9: an intensity must be at least 0, got -10");
  EXPECT_EQ(complaint(ies_text({0, 90}, {0}, [](double, double) { return 0; })),
            "a.ies:9: all intensities are 0: the lamp is dark");
  const std::string whole = ies_text({0, 90}, {0}, flat);
  for (std::size_t size = 0; size + 4 < whole.size(); ++size)
    EXPECT_NE(complaint(whole.substr(0, size)), "") << size;
}

TEST(IesProfile, FilesAreOpenedByTheFunctionThatNeverWaits) {
  const test::TempFolder folder;
  const std::string pipe = folder.file("a.ies");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(read_ies_profile(pipe), InputError);
  EXPECT_THROW(read_ies_profile(folder.file("none.ies")), InputError);
}

} // namespace
} // namespace vdbeam
