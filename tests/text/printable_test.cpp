#include "text/printable.h"

#include "text/text.h"
#include "text/wrap.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

TEST(Printable, ControlCharactersAreShown) {
  EXPECT_EQ(printable_line("a\x1b[31mb"), "a\\x1b[31mb");
  EXPECT_EQ(printable_line("a\rb\nc\td"), "a b c d");
  EXPECT_EQ(printable_line("a\x07\x7f"), "a\\x07\\x7f");
  EXPECT_EQ(printable_line("a\x9b"
                           "2J"),
            "a\\x9b2J"); // Latin-1's own escape sequence
  EXPECT_EQ(printable_line("a\xc2\x9b"
                           "2J"),
            "a\\u009b2J"); // the same in UTF-8
  EXPECT_EQ(printable_line("W\xc3\xb6lkchen \xe4"), "W\xc3\xb6lkchen \xe4");
  EXPECT_EQ(printable_text("a\n\tb\r\x1b"), "a\n\tb \\x1b");
}

TEST(Printable, Utf8) {
  for (const char* valid : {"a", "\xc3\xb6", "\xe2\x82\xac", "\xf0\x9f\x8c\xa9"})
    EXPECT_EQ(utf8_length(valid, 0), std::string(valid).size()) << valid;
  for (const char* invalid : {"\xe4", "\xc3", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80",
                              "\xf4\x90\x80\x80", "\x80", "\xff"})
    EXPECT_EQ(utf8_length(invalid, 0), 0u) << invalid;
  EXPECT_EQ(as_utf8("W\xc3\xb6lkchen"), "W\xc3\xb6lkchen");
  EXPECT_EQ(as_utf8("W\xf6lkchen"), "W\xc3\xb6lkchen");
}

TEST(OneLine, KeepsTheReasonBehindALongPath) {
  const std::string path = "/" + std::string(4000, 'p') + "/shot.toml";
  const std::string line = one_line(path + ":3: volume.0.extinction must be at least 0");
  EXPECT_LT(line.size(), 400u);
  EXPECT_TRUE(line.ends_with("/shot.toml:3: volume.0.extinction must be at least 0")) << line;
  const std::string usual = "/" + std::string(250, 'p') + ".toml: reason";
  EXPECT_EQ(one_line(usual), usual);
  std::string spaces = "path";
  for (int i = 0; i < 2000; ++i)
    spaces += " of words";
  EXPECT_TRUE(one_line(spaces + ": the reason").ends_with(": the reason"));
  EXPECT_LE(one_line(spaces).size(), 1500u);
}

TEST(OneLine, CutsBetweenCharacters) {
  std::string text;
  for (int i = 0; i < 500; ++i)
    text += "\xe2\x82\xac";
  for (std::size_t most = 200; most < 210; ++most)
    EXPECT_EQ(as_utf8(shortened(text, most)), shortened(text, most)) << most;
}

TEST(Text, NearestWordIgnoresCapitals) {
  EXPECT_EQ(nearest_word("ACEScg", {"rec709", "acescg", "aces2065_1"}), "acescg");
  EXPECT_EQ(nearest_word("vol1", {"Vol2", "other"}), "Vol2");
}

TEST(Text, RemediesOfValues) {
  const std::pair<const char*, const char*> durations[] = {{"5min", "; did you mean 5m?"},
                                                           {"5 minutes", "; did you mean 5m?"},
                                                           {"90 sec", "; did you mean 90s?"},
                                                           {"1hr30min", "; did you mean 1h30m?"},
                                                           {"2 Hours", "; did you mean 2h?"},
                                                           {"soon", ""},
                                                           {"5x", ""},
                                                           {"min", ""}};
  for (const auto& [text, remedy] : durations)
    EXPECT_EQ(duration_remedy(text), remedy) << text;
  EXPECT_EQ(bracketed_numbers("0,0,5"), "[0, 0, 5]");
  EXPECT_EQ(bracketed_numbers("0 -1.5  5e3"), "[0, -1.5, 5e3]");
  for (const char* text : {"5", "a,b", "1,x", "", ","})
    EXPECT_EQ(bracketed_numbers(text), "") << text;
}

TEST(Text, TwoColumnsWrapInTheSecond) {
  EXPECT_EQ(two_columns("name", "one two three", 10, 17), "  name    one two\n          three\n");
  EXPECT_EQ(two_columns("a_long_name", "one", 10, 17), "  a_long_name\n          one\n");
}

} // namespace
} // namespace vdbeam
