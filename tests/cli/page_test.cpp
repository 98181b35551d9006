#include "cli_fixture.h"

#include "vdbeam/image_file.h"

#include <nlohmann/json.hpp>

namespace vdbeam::test {
namespace {

using Json = nlohmann::json;

/// Three frames and their page; the second one fails.
class PageTest : public CliTest {
protected:
  void SetUp() override {
    CliTest::SetUp();
    for (const char* frame : {"1", "2", "3"})
      std::filesystem::copy_file(fog_vdb, file(std::string("c.000") + frame + ".vdb"));
    write("c.0002.vdb", "no VDB & <no> \"HTML\"");
    std::ifstream scene(cloud);
    std::stringstream text;
    text << scene.rdbuf();
    std::string toml = text.str();
    toml.replace(toml.find("cloud.vdb"), 9, "c.####.vdb");
    write("s.toml", toml);
  }
  ProgramResult batch(std::vector<std::string> more) const {
    std::vector<std::string> words{"s.toml", "-o", "o.####.exr", "--passes", "3"};
    words.insert(words.end(), more.begin(), more.end());
    return render(words);
  }
  bool page_has(const std::string& page, const std::string& text) const {
    return read(page).find(text) != std::string::npos;
  }
};

TEST_F(PageTest, ABatchWritesItsPage) {
  const auto result = batch({"-f", "1-3", "--html", "page", "--summary", "s.json"});
  EXPECT_EQ(result.code, 3) << result.error;
  EXPECT_TRUE(exists("page/frame.0001.png"));
  EXPECT_FALSE(exists("page/frame.0002.png"));
  for (const char* text : {"<b>2 of 3</b>", "frame 1: MRSE ", "frame 2: failed",
                           "is not a VDB file", "--html page --summary s.json", "vdbeam 0.1.0"})
    EXPECT_TRUE(page_has("page/index.html", text)) << text;
  EXPECT_FALSE(page_has("page/index.html", "not finished"));
  const Json summary = Json::parse(read("s.json"));
  EXPECT_EQ(summary["frames"][1]["exit_code"], 2);
  EXPECT_GT(summary["frames"][2]["error"], 0);
  EXPECT_EQ(summary["frames"][2]["error"].get<double>(),
            read_image(file("o.0003.exr")).numbers.at("vdbeam:errorEstimate"));
  const Image thumbnail = read_image(file("page/frame.0003.png"));
  EXPECT_EQ(thumbnail.width, 32);

  // The summary makes the same page, but for its date.
  const auto page = run({"summary", "s.json", "--html", "again"});
  EXPECT_EQ(page.code, 0) << page.error;
  const auto frames = [&](const std::string& name) {
    const std::string text = read(name);
    return text.substr(0, text.find("<h2>How"));
  };
  EXPECT_EQ(frames("again/index.html"), frames("page/index.html"));
  EXPECT_EQ(read("again/frame.0003.png"), read("page/frame.0003.png"));
}

TEST_F(PageTest, ThePageIsReplacedAfterEachFrame) {
  const pid_t child = start({"render", "s.toml", "-f", "1,3-400", "-o", "o.####.exr", "--html",
                             "page", "--missing", "hold", "--resolution", "32x18", "--passes", "1",
                             "--set", "render.photons=2000", "-q"});
  wait_until(child, [&] { return exists("page/index.html"); });
  EXPECT_TRUE(page_has("page/index.html", "not finished"));
  EXPECT_TRUE(page_has("page/index.html", " of 399</b>"));
  kill(child, SIGTERM);
  const auto result = finish(child);
  EXPECT_EQ(result.code, 143) << result.error;
  EXPECT_FALSE(page_has("page/index.html", "not finished"));
  EXPECT_TRUE(page_has("page/index.html", "not begun"));
}

TEST_F(PageTest, TasksOfAFarmAreMergedByFrame) {
  for (const char* frame : {"1", "2", "3"}) // `####` is the first frame of the task
    batch({"-f", frame, "--summary", "t.####.json"});
  EXPECT_TRUE(exists("t.0002.json"));
  ASSERT_EQ(run({"summary", "t.0001.json", "t.0002.json", "t.0003.json", "--html", "page"}).code,
            0);
  EXPECT_TRUE(page_has("page/index.html", "<b>2 of 3</b>"));
  // A later task renders the failed frame; the order of the files does not matter.
  std::filesystem::copy_file(fog_vdb, file("c.0002.vdb"),
                             std::filesystem::copy_options::overwrite_existing);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // dates have seconds
  ASSERT_EQ(batch({"-f", "2", "--summary", "later.json"}).code, 0);
  const auto merged =
      run({"summary", "later.json", "t.0001.json", "t.0002.json", "t.0003.json", "--html", "page"});
  EXPECT_NE(merged.error.find("3 frames: 3 done (1-3)"), std::string::npos) << merged.error;
  EXPECT_TRUE(page_has("page/index.html", "<b>3 of 3</b>"));
  EXPECT_FALSE(page_has("page/index.html", "Failed frames"));
}

TEST_F(PageTest, SkippedFramesShowTheirImages) {
  batch({"-f", "1,3"});
  ASSERT_EQ(batch({"-f", "1,3", "--skip-existing", "--html", "page"}).code, 0);
  EXPECT_TRUE(page_has("page/index.html", "of them skipped"));
  EXPECT_TRUE(page_has("page/index.html", "frame 3: MRSE "));
  EXPECT_TRUE(exists("page/frame.0003.png"));
}

TEST_F(PageTest, PngImagesHaveThumbnailsAndErrors) {
  ASSERT_EQ(render({"s.toml", "-f", "1", "-o", "o.png", "--passes", "3", "--html", "page"}).code,
            0);
  EXPECT_TRUE(page_has("page/index.html", "frame 1: MRSE "));
  // Shown as it is: the view transform is not applied once more.
  const Image image = read_image(file("o.png")),
              thumbnail = read_image(file("page/frame.0001.png"));
  for (std::size_t i = 0; i < image.channels[0].data.size(); ++i)
    EXPECT_NEAR(image.channels[0].data[i], thumbnail.channels[0].data[i], 0.01);
}

TEST_F(PageTest, ThumbnailsAreSmall) {
  ASSERT_EQ(run({"render", "s.toml", "-f", "1", "-o", "o.exr", "--passes", "1", "--resolution",
                 "500x100", "--html", "page", "--set", "render.photons=2000"})
                .code,
            0);
  const Image thumbnail = read_image(file("page/frame.0001.png"));
  EXPECT_EQ(thumbnail.width, 320);
  EXPECT_EQ(thumbnail.height, 64);
}

TEST_F(PageTest, ImagesThatAreGoneLeaveFramesWithoutThumbnails) {
  batch({"-f", "1,3", "--summary", "s.json"});
  std::filesystem::remove(file("o.0003.exr"));
  const auto result = run({"summary", "s.json", "--html", "page"});
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.error.find("o.0003.exr"), std::string::npos) << result.error;
  EXPECT_TRUE(exists("page/frame.0001.png"));
  EXPECT_FALSE(exists("page/frame.0003.png"));
}

TEST_F(PageTest, OutputsOfThePageReplaceNoInput) {
  const auto expect_refused = [&](const std::vector<std::string>& words, const std::string& why) {
    const auto result = run(words);
    EXPECT_EQ(result.code, 2) << result.error;
    EXPECT_EQ(result.error_lines(), 1U) << result.error;
    EXPECT_NE(result.error.find(why), std::string::npos) << result.error;
  };
  std::filesystem::create_directory(file("page"));
  std::filesystem::copy_file(file("s.toml"), file("page/index.html"));
  std::filesystem::copy_file(fog_vdb, file("page/c.0001.vdb"));
  expect_refused({"render", "page/index.html", "-f", "1", "-o", "o.exr", "--html", "page"},
                 "--html page/index.html: is the same file as the scene");
  expect_refused({"render", "s.toml", "-f", "1", "-o", "page/frame.####.png", "--html", "page"},
                 "the thumbnails of --html");
  expect_refused({"render", "s.toml", "-f", "1", "-o", "o.exr", "--html", "no/page"},
                 "there is no folder no");
  expect_refused({"render", "s.toml", "-f", "1", "-o", "o.exr", "--html", "s.toml"},
                 "--html s.toml: is not a folder");
  expect_refused({"render", "s.toml", "-f", "1", "-o", "o.exr", "--html", "p.html"},
                 "--html p.html: name a folder, e.g. p; the page is index.html in it");
  expect_refused({"render", "s.toml", "-f", "1", "-o", "o.exr", "--html", "p.####"},
                 "without a place for the frame number");
  expect_refused(
      {"render", "s.toml", "-f", "1", "-o", "o.exr", "--html", "page", "--pass-range", "0-1"},
      "--html: excludes --pass-range");
  // Images that a summary names are inputs.
  write("evil.json", R"({"scene": "s.toml", "frames_asked": [1], "frames": [{"frame": 1,
        "status": "done", "output": "page/frame.0001.png"}]})");
  std::filesystem::copy_file(fog_vdb, file("page/frame.0001.png"));
  expect_refused({"summary", "evil.json", "--html", "page"}, "the image of frame 1");
  std::filesystem::create_hard_link(file("evil.json"), file("page/linked.json"));
  std::filesystem::remove(file("page/index.html"));
  std::filesystem::create_hard_link(file("evil.json"), file("page/index.html"));
  expect_refused({"summary", "evil.json", "--html", "page"}, "the summary evil.json");
}

TEST_F(PageTest, BadSummariesGetOneLine) {
  const auto expect_refused = [&](const std::string& text, const std::string& why) {
    write("b.json", text);
    const auto result = run({"summary", "b.json", "--html", "page"});
    EXPECT_EQ(result.code, 2) << text << result.error;
    EXPECT_EQ(result.error_lines(), 1U) << result.error;
    EXPECT_NE(result.error.find("b.json: " + why), std::string::npos) << result.error;
    EXPECT_NE(result.error.find("vdbeam render --summary"), std::string::npos) << result.error;
    EXPECT_FALSE(exists("page"));
  };
  expect_refused("{", "is not JSON");
  expect_refused("[1]", "must be an object");
  expect_refused("{}", "scene is missing");
  expect_refused(R"({"scene": 1})", "scene must be a text, got 1");
  expect_refused(R"({"scene": "s", "frames_asked": [1.5], "frames": []})",
                 "frames_asked must be a whole number, got 1.5");
  expect_refused(R"({"scene": "s", "frames_asked": [99999999999], "frames": []})",
                 "frames_asked must be a whole number, got 99999999999");
  expect_refused(R"({"scene": "s", "frames_asked": 1, "frames": []})",
                 "frames_asked must be a list");
  expect_refused(R"({"scene": "s", "frames_asked": [1], "frames": [{"frame": 1}]})",
                 "frames.0.status is missing");
  expect_refused(
      R"({"scene": "s", "frames_asked": [1], "frames": [{"frame": 1, "status": "odd"}]})",
      "frames.0.status must be done, skipped, failed or interrupted, got odd");
  expect_refused(R"({"scene": "s", "frames_asked": [], "frames": [], "machine": 3})",
                 "machine. must be an object");
}

TEST_F(PageTest, SummariesOfTwoScenesAreRefused) {
  write("a.json", R"({"scene": "a.toml", "frames_asked": [1], "frames": []})");
  write("b.json", R"({"scene": "b.toml", "frames_asked": [1], "frames": []})");
  const auto result = run({"summary", "a.json", "b.json", "--html", "page"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.error.find("make a page for each"), std::string::npos) << result.error;
}

} // namespace
} // namespace vdbeam::test
