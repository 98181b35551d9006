#include "page/batch_page.h"
#include "page/html_text.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

PageFrame done(int number, double brightness) {
  PageFrame frame;
  frame.number = number;
  frame.status = "done";
  frame.seconds = 2;
  frame.thumbnail = "frame." + std::to_string(number) + ".png";
  frame.picture.brightness = brightness;
  return frame;
}

PageFrame failed(int number, const std::string& reason) {
  PageFrame frame;
  frame.number = number;
  frame.status = "failed";
  frame.reason = reason;
  frame.exit_code = 3;
  return frame;
}

TEST(HtmlText, LeavesNothingThatHtmlCouldRead) {
  EXPECT_EQ(html_text("a<b>&\"'\x1b\n"), "a&lt;b&gt;&amp;&quot;&#39;\\x1b ");
  EXPECT_EQ(html_text("\xe9"), "\xc3\xa9"); // Latin-1
}

TEST(Flicker, IsTheMeanRelativeChangeBetweenNeighbours) {
  EXPECT_FALSE(flicker({}));
  EXPECT_FALSE(flicker({done(1, 2)}));
  EXPECT_NEAR(*flicker({done(1, 1), done(2, 3), done(3, 3)}), 0.5, 1e-12); // (1 + 0) / 2
  EXPECT_EQ(*flicker({done(1, 0), done(2, 0)}), 0);
  // A failed frame has no neighbours.
  EXPECT_FALSE(flicker({done(1, 1), failed(2, ""), done(3, 9)}));
}

TEST(BatchPage, EscapesEveryText) {
  const std::string evil = "<script>alert(1)</script>\"'&";
  BatchPage page;
  page.scene = page.machines.emplace_back(evil);
  page.commands = page.versions = page.dates = page.machines;
  page.frames = {failed(1, evil), done(2, 1)};
  page.frames[1].thumbnail = evil;
  const std::string html = page_html(page);
  EXPECT_EQ(html.find("<script>alert"), html.npos);
  EXPECT_EQ(html.find("\"'&"), html.npos);
  EXPECT_NE(html.find("<code>&lt;script&gt;alert(1)&lt;/script&gt;"), html.npos);
}

TEST(BatchPage, ListsFailuresWithTheirExitCodes) {
  BatchPage page;
  page.frames = {done(1, 1), failed(2, "disk full"), failed(4, "old")};
  page.frames[2].exit_code.reset();
  const std::string html = page_html(page);
  EXPECT_NE(html.find("<td class=\"number\">2</td><td class=\"number\">3</td><td "
                      "class=\"line-text\"><code>disk full</code>"),
            html.npos);
  EXPECT_NE(html.find("<td class=\"number\">unknown</td>"), html.npos);
  EXPECT_NE(html.find("<b>1 of 3</b>"), html.npos);
}

TEST(BatchPage, SaysWhetherTheBatchGoesOn) {
  BatchPage page;
  page.frames = {done(1, 1)};
  EXPECT_EQ(page_html(page).find("not finished"), std::string::npos);
  page.finished = false;
  EXPECT_NE(page_html(page).find("not finished"), std::string::npos);
}

TEST(BatchPage, HoldsWithoutFrames) {
  const std::string html = page_html({});
  EXPECT_EQ(html.find("id=\"film\""), html.npos);
  EXPECT_NE(html.find("no values"), html.npos);
}

TEST(BatchPage, FoldsCommandsOfManyTasks) {
  BatchPage page;
  for (int task = 0; task < 4; ++task)
    page.commands.push_back("vdbeam render -f " + std::to_string(task));
  page.machines = {"same", "same"};
  page.dates = {"2026-01-02", "2026-01-01"};
  const std::string html = page_html(page);
  EXPECT_NE(html.find("<summary>4 different</summary>"), html.npos);
  EXPECT_NE(html.find("<dd><div>same</div></dd>"), html.npos);
  EXPECT_NE(html.find("2026-01-01 to 2026-01-02"), html.npos);
}

} // namespace
} // namespace vdbeam
