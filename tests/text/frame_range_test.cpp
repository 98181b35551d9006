#include "text/frame_range.h"

#include "scene/scene_fixture.h"

#include <vector>

namespace vdbeam {
namespace {

using Frames = std::vector<int>;

TEST(FrameRange, SingleFramesRangesAndSteps) {
  EXPECT_EQ(parse_frame_range("7"), Frames({7}));
  EXPECT_EQ(parse_frame_range("1-4"), Frames({1, 2, 3, 4}));
  EXPECT_EQ(parse_frame_range("1-10x3"), Frames({1, 4, 7, 10}));
  EXPECT_EQ(parse_frame_range("1-9:4"), Frames({1, 5, 9}));
  EXPECT_EQ(parse_frame_range("1-8x3"), Frames({1, 4, 7}));
  EXPECT_EQ(parse_frame_range("0007-0009"), Frames({7, 8, 9}));
}

TEST(FrameRange, ReverseRangeStepsFromItsFirstFrame) {
  EXPECT_EQ(parse_frame_range("5-1"), Frames({1, 2, 3, 4, 5}));
  EXPECT_EQ(parse_frame_range("10-1x4"), Frames({2, 6, 10}));
}

TEST(FrameRange, NegativeFrames) {
  EXPECT_EQ(parse_frame_range("-3"), Frames({-3}));
  EXPECT_EQ(parse_frame_range("-2-1"), Frames({-2, -1, 0, 1}));
  EXPECT_EQ(parse_frame_range("-5--3"), Frames({-5, -4, -3}));
  EXPECT_EQ(parse_frame_range("1--1"), Frames({-1, 0, 1}));
}

TEST(FrameRange, ListsAreSortedWithoutDoubles) {
  EXPECT_EQ(parse_frame_range("9-12, 1,5,10-11"), Frames({1, 5, 9, 10, 11, 12}));
  EXPECT_EQ(parse_frame_range("3,3,3"), Frames({3}));
}

TEST(FrameRange, RangeOverTheWholeOfIntDoesNotOverflow) {
  EXPECT_EQ(parse_frame_range("-2147483648-2147483647x2147483647"),
            Frames({-2147483647 - 1, -1, 2147483646}));
}

class BadFrameRange : public ::testing::TestWithParam<const char*> {};

TEST_P(BadFrameRange, IsRefused) {
  EXPECT_THROW(parse_frame_range(GetParam()), InputError) << GetParam();
}

INSTANTIATE_TEST_SUITE_P(Texts, BadFrameRange,
                         ::testing::Values("", " ", "a", "1-", "1-x", "1-4x", "1-4x0", "1-4x-1",
                                           "1,,2", "1,", ",1", "1x2", "1..4", "1-4-9", "1 2",
                                           "99999999999", "+1", "1.5", "1-2000000"));

TEST(FrameRange, FormatsTheShortestText) {
  EXPECT_EQ(format_frame_range({}), "");
  EXPECT_EQ(format_frame_range({1, 2, 3, 4}), "1-4");
  EXPECT_EQ(format_frame_range({1, 2, 5, 7, 8, 9}), "1,2,5,7-9");
  for (const char* text : {"-4--1,3,9-12", "1", "1,3,5"})
    EXPECT_EQ(format_frame_range(parse_frame_range(text)), text);
}

TEST(FramePattern, EveryNotation) {
  EXPECT_EQ(substitute_frame("a.####.vdb", 7), "a.0007.vdb");
  EXPECT_EQ(substitute_frame("a.##.vdb", 123), "a.123.vdb");
  EXPECT_EQ(substitute_frame("a.#.vdb", 7), "a.0007.vdb");
  EXPECT_EQ(substitute_frame("a.%04d.vdb", 7), "a.0007.vdb");
  EXPECT_EQ(substitute_frame("a.%d.vdb", 7), "a.7.vdb");
  EXPECT_EQ(substitute_frame("a.$F4.vdb", 12), "a.0012.vdb");
  EXPECT_EQ(substitute_frame("a.$F.vdb", 12), "a.12.vdb");
  EXPECT_EQ(substitute_frame("a.${F4}.vdb", 12), "a.0012.vdb");
  EXPECT_EQ(substitute_frame("a.<F4>.vdb", 12), "a.0012.vdb");
  EXPECT_EQ(substitute_frame("a.<f3>.<F>.vdb", 12), "a.012.12.vdb");
  EXPECT_EQ(substitute_frame("a.@@@@.vdb", 12), "a.0012.vdb");
  EXPECT_EQ(substitute_frame("a.####.vdb", -7), "a.-007.vdb");
  EXPECT_EQ(substitute_frame("f####/a_%03d.$F2", 5), "f0005/a_005.05");
}

TEST(FramePattern, OtherNamesStayAsTheyAre) {
  for (const char* name : {"a.0007.vdb", "100%.vdb", "%s.vdb", "$FRAME", "$HIP/a", "a%04x",
                           "me@home", "<UDIM>", "<F4", "${F4", "${FF}", "<Frame>", "s.*.vdb"}) {
    if (std::string(name) != "$FRAME") {
      EXPECT_FALSE(has_frame_pattern(name)) << name;
      EXPECT_EQ(substitute_frame(name, 3), name);
    }
  }
  EXPECT_TRUE(has_frame_pattern("a.####.vdb"));
}

TEST(FramePattern, ForeignPlaceholdersAreFound) {
  EXPECT_EQ(foreign_token("s.<UDIM>.exr"), "<UDIM>");
  EXPECT_EQ(foreign_token("s.<frame>.exr"), "<frame>");
  EXPECT_EQ(foreign_token("s.%V.%04d.exr"), "%V");
  EXPECT_EQ(foreign_token("s.*.exr"), "*");
  for (const char* path :
       {"s.exr", "s.####.exr", "s.<F4>.exr", "s.${F4}.exr", "a*b/s.exr", "a<b.exr"})
    EXPECT_EQ(foreign_token(path), "") << path;
}

TEST(FramePattern, IsFoundFromAFile) {
  EXPECT_EQ(frame_pattern_of("a/smoke.0020.vdb"), "a/smoke.####.vdb");
  EXPECT_EQ(frame_pattern_of("v2_smoke12.vdb"), "v2_smoke##.vdb");
  EXPECT_EQ(frame_pattern_of("smoke.7.vdb"), "smoke.%d.vdb");
  EXPECT_EQ(frame_pattern_of("smoke.vdb"), "");
}

using FramesOnDisk = test::SceneTest;

TEST_F(FramesOnDisk, ListsTheFilesOfThePattern) {
  for (const char* name : {"s.0003.vdb", "s.0010.vdb", "s.0001.vdb", "s.12.vdb", "s.vdb",
                           "s.0004.exr", "x.0005.vdb", "s.-002.vdb", "s.12345.vdb"})
    write(name, "");
  EXPECT_EQ(frames_on_disk(file("s.####.vdb")), Frames({-2, 1, 3, 10, 12345}));
  EXPECT_EQ(frames_on_disk(file("s.%d.vdb")), Frames({12, 12345}));
  EXPECT_EQ(frames_on_disk(file("s.vdb")), Frames());
  EXPECT_EQ(frames_on_disk(file("none/s.####.vdb")), Frames());
}

} // namespace
} // namespace vdbeam
