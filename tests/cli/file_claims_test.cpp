#include "cli_fixture.h"

#include "keys/scene_keys.h"
#include "report/frame_files.h"
#include "vdbeam/image_file.h"

#include <nlohmann/json.hpp>

namespace vdbeam {
namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;
namespace fs = std::filesystem;

class FileClaims : public test::CliTest {
protected:
  void SetUp() override {
    CliTest::SetUp();
    fs::create_directory(folder_ / "sub");
    for (const char* name : {"c.0001.vdb", "c.0002.vdb", "c.0009.vdb"})
      fs::copy_file(fog_vdb, folder_ / name);
    write("s.toml", "[[volume]]\nfile = 'c.####.vdb'\n[[light]]\ntype = 'environment'\n");
    ASSERT_EQ(render({fog_vdb, "-o", "sky.exr", "--passes", "1", "-q"}).code, 0);
  }
  /// The bytes of every file in the folder.
  std::string everything() const {
    std::string all;
    for (const std::string& name : files())
      all += name + "\n" + (fs::is_regular_file(folder_ / name) ? read(name) : "") + "\n";
    return all;
  }
  /// Refused with one line that names both files, and nothing was touched.
  void expect_refused(const Names& words, const std::string& first, const std::string& second) {
    const std::string before = everything();
    const auto result = run(words);
    std::string line;
    for (const std::string& word : words)
      line += word + " ";
    EXPECT_EQ(result.code, 2) << line << result.error;
    EXPECT_EQ(result.error_lines(), 1u) << line << result.error;
    EXPECT_NE(result.error.find(first), std::string::npos) << line << result.error;
    EXPECT_NE(result.error.find(second), std::string::npos) << line << result.error;
    EXPECT_EQ(everything(), before) << line;
  }
  void expect_render_refused(Names words, const std::string& first, const std::string& second) {
    words.insert(words.begin(), {"render", "s.toml", "-f", "1-2", "--passes", "1"});
    if (std::find(words.begin(), words.end(), "-o") == words.end())
      words.insert(words.end(), {"-o", "o.####.exr"});
    expect_refused(words, first, second);
  }
};

TEST_F(FileClaims, OutputsMayNotReplaceInputs) {
  expect_render_refused({"--summary", "s.toml"}, "--summary s.toml", "the scene s.toml");
  expect_render_refused({"--summary", "./sub/../s.toml"}, "--summary", "the scene s.toml");
  expect_render_refused({"--report", "c.####.vdb"}, "--report c.0001.vdb", "volume.0.file");
  expect_render_refused({"--summary", "c.0002.vdb"}, "--summary c.0002.vdb", "volume.0.file");
  // Not of these frames, but of the sequence.
  expect_render_refused({"--summary", "c.0009.vdb"}, "--summary c.0009.vdb", "volume.0.file");
  expect_render_refused({"--summary", "sky.exr", "--set", "light.0.image=sky.exr"},
                        "--summary sky.exr", "light.0.image sky.exr");
  expect_render_refused({"--summary", "sky.exr", "--reference", "sky.exr"}, "--summary sky.exr",
                        "--reference sky.exr");
  fs::create_symlink("s.toml", folder_ / "link.json");
  expect_render_refused({"--summary", "link.json"}, "--summary link.json", "the scene");
  fs::create_hard_link(folder_ / "s.toml", folder_ / "hard.json");
  expect_render_refused({"--summary", "hard.json"}, "--summary hard.json", "the scene");
  write("n.toml", "[[light]]\ntype = 'environment'\nimage = 'sky.exr'\n");
  expect_refused({"render", "n.toml", "-o", "sky.exr", "--passes", "1"}, "-o sky.exr",
                 "light.0.image sky.exr");
}

TEST_F(FileClaims, OutputsMayNotReplaceEachOther) {
  expect_render_refused({"--summary", "o.0002.exr"}, "--summary o.0002.exr", "-o o.0002.exr");
  expect_render_refused({"--report", "o.####.exr"}, "--report", "-o o.0001.exr");
  expect_render_refused({"--report", "r.####.json", "--summary", "r.0002.json"}, "--report",
                        "--summary");
  expect_render_refused({"--summary", "o.0001.checkpoint.exr"}, "the checkpoint of -o",
                        "--summary");
  expect_render_refused({"--summary", "o.0001.snapshot.exr"}, "the snapshot of -o", "--summary");
  expect_render_refused({"--pass-range", "0-1", "--summary", "o.0001.exr"}, "--summary", "-o");
  // File systems of other systems do not distinguish these.
  expect_render_refused({"--summary", "O.0001.EXR"}, "--summary", "-o o.0001.exr");
  // Neither is there yet: a link to nowhere leads to where the other will be.
  fs::create_symlink("o.0001.exr", folder_ / "sub/link.json");
  fs::remove(folder_ / "sub/link.json");
  fs::create_symlink("../o.0001.exr", folder_ / "sub/link.json");
  expect_render_refused({"--summary", "sub/link.json"}, "--summary sub/link.json", "-o o.0001.exr");
  fs::create_directory_symlink(".", folder_ / "here");
  expect_render_refused({"--summary", "here/o.0001.exr"}, "--summary here/", "-o o.0001.exr");
}

TEST_F(FileClaims, OtherCommandsKeepToItToo) {
  expect_refused({"init", "c.0001.vdb", "-o", "c.0001.vdb", "--force"}, "-o c.0001.vdb",
                 "the volume");
  expect_refused({"init", "c.####.vdb", "-o", "c.0002.vdb", "--force"}, "-o c.0002.vdb",
                 "the volume");
  const auto farm = [](const Names& more) {
    Names words{"farm", "slurm",      "s.toml",   "-f", "1-2",
                "-o",   "o.####.exr", "--passes", "4",  "--job"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expect_refused(farm({"s.toml"}), "--job", "the scene");
  expect_refused(farm({"c.0002.vdb"}), "--job", "volume.0.file");
  expect_refused(farm({"o.0002.exr"}), "--job", "-o");
  expect_refused(farm({"o.0002.passes_2-3.exr", "--splits", "2"}), "--job", "a part of -o");
  const Names part{"render", fog_vdb, "--pass-range", "0",    "-o",
                   "a.exr",  "-q",    "--resolution", "32x18"};
  ASSERT_EQ(run(part).code, 0);
  expect_refused({"merge", "-o", "a.exr", "a.exr"}, "-o a.exr", "the partial image a.exr");
  expect_refused({"merge", "-o", "b.exr", "--partial", "./a.exr", "a.exr"}, "--partial ./a.exr",
                 "the partial image a.exr");
  expect_refused({"merge", "-o", "b.exr", "--partial", "b.exr", "a.exr"}, "--partial b.exr",
                 "-o b.exr");
}

/// Every key that names a file against every output that a render has: the tables know them.
TEST_F(FileClaims, NoOutputReplacesAFileThatAKeyNames) {
  int keys = 0;
  for (const SceneKey& key : scene_keys()) {
    if (key.kind != KeyKind::file)
      continue;
    ++keys;
    EXPECT_NE(key.input, InputKind::none) << key_path(key, 0);
    for (const OutputKind& kind : output_kinds()) {
      FrameFiles given{.output = "o.exr"};
      given.*kind.option = "given.exr";
      const std::string victim = output_path(given, kind.output, 1);
      const std::string bytes = "the bytes of " + victim;
      if (*kind.in_folder != '\0')
        fs::create_directory(folder_ / "given.exr");
      write(victim, bytes);
      Names words{"render", "s.toml", "-f",         "1",     "--passes",
                  "1",      "-o",     given.output, "--set", key_path(key, 0) + "=" + victim};
      if (kind.option != &FrameFiles::output)
        words.insert(
            words.end(),
            {std::string(kind.name).substr(std::string(kind.name).rfind("--")), "given.exr"});
      expect_refused(words, kind.name + std::string(" ") + victim, key_path(key, 0));
      EXPECT_EQ(read(victim), bytes);
      fs::remove(folder_ / victim);
      fs::remove(folder_ / "given.exr");
    }
  }
  EXPECT_GE(keys, 5);
}

TEST_F(FileClaims, WhatFilesNameIsAnInputToo) {
  write("b.bin", "numbers");
  write("m.gltf", R"({"buffers": [{"uri": "b.bin", "byteLength": 7}]})");
  write("m.mtl", "newmtl a");
  write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_render_refused({"--summary", "b.bin", "--set", "mesh.0.file=m.gltf"}, "--summary b.bin",
                        "mesh.0.file");
  expect_render_refused({"--summary", "b.bin", "--set", "camera.file=m.gltf"}, "--summary b.bin",
                        "camera.file");
  expect_render_refused({"--summary", "m.mtl", "--set", "mesh.0.file=m.obj"}, "--summary m.mtl",
                        "mesh.0.file");
  write("config.ocio", "ocio_profile_version: 2");
  setenv("OCIO", file("config.ocio").c_str(), 1);
  expect_render_refused({"--summary", "config.ocio"}, "--summary config.ocio", "OCIO");
  unsetenv("OCIO");
}

TEST_F(FileClaims, MergeKeepsItsPartials) {
  const auto part = [&](const char* range, const char* name) {
    return render({fog_vdb, "--pass-range", range, "-o", name, "-q"}).code;
  };
  ASSERT_EQ(part("0", "shot.deep.exr"), 0);
  ASSERT_EQ(part("1", "p1.exr"), 0);
  expect_refused({"merge", "-o", "shot.exr", "shot.deep.exr", "p1.exr"}, "the deep image of -o",
                 "the partial image shot.deep.exr");
}

TEST_F(FileClaims, FarmReplacesOnlyItsOwnJobFiles) {
  const Names farm{"farm", "slurm", "s.toml", "-f", "1-2", "-o", "o.####.exr", "--passes", "4"};
  const auto with_job = [&](const std::string& name) {
    Names words = farm;
    words.insert(words.end(), {"--job", name});
    return words;
  };
  ASSERT_EQ(run(with_job("job.sh")).code, 0);
  const auto again = run(with_job("job.sh"));
  EXPECT_EQ(again.code, 0) << again.error;
  EXPECT_NE(again.error.find("job.sh: the existing job file is replaced"), std::string::npos)
      << again.error;
  write("job.sh", read("job.sh") + "# by hand\n");
  expect_refused(with_job("job.sh"), "job.sh", "has been edited since vdbeam farm wrote it");
  expect_refused(with_job("sky.exr"), "sky.exr", "was not written by vdbeam farm");
  Names openjd = with_job("job.json");
  openjd[1] = "openjd";
  EXPECT_EQ(run(openjd).code, 0);
  EXPECT_EQ(run(openjd).code, 0);
}

/// What has the name of a checkpoint or snapshot is not always one.
TEST_F(FileClaims, SideFilesOfOthersStay) {
  for (const char* name : {"a.snapshot.exr", "b.checkpoint.exr"})
    fs::copy_file(folder_ / "sky.exr", folder_ / name);
  const std::string sky = read("sky.exr");
  ASSERT_EQ(render({fog_vdb, "-o", "a.exr", "--passes", "1", "-q"}).code, 0);
  EXPECT_EQ(read("a.snapshot.exr"), sky);
  ASSERT_EQ(render({fog_vdb, "-o", "a.exr", "--passes", "1", "-q", "--skip-existing"}).code, 0);
  EXPECT_EQ(read("a.snapshot.exr"), sky);
  expect_refused({"render", fog_vdb, "-o", "b.exr", "--passes", "1"},
                 "b.checkpoint.exr: is no checkpoint by vdbeam", "-o b.exr needs its name");
  // A planted link leads nowhere.
  fs::create_symlink("sky.exr", folder_ / "c.checkpoint.exr");
  expect_refused({"render", fog_vdb, "-o", "c.exr", "--passes", "1"}, "c.checkpoint.exr: is a link",
                 "-o c.exr");
  EXPECT_EQ(read("sky.exr"), sky);
  // Nothing is lost with what is empty, and a partial image begins a frame.
  write("d.checkpoint.exr", "");
  EXPECT_EQ(render({fog_vdb, "-o", "d.exr", "--passes", "1", "-q"}).code, 0);
  ASSERT_EQ(render({fog_vdb, "-o", "e.checkpoint.exr", "--pass-range", "0", "-q"}).code, 0);
  EXPECT_EQ(render({fog_vdb, "-o", "e.exr", "--passes", "1", "-q"}).code, 0);
  EXPECT_FALSE(exists("e.checkpoint.exr"));
}

TEST_F(FileClaims, NamesThatAreTooLongAreRefusedBeforeRendering) {
  const auto refused = [&](const std::string& name, const std::string& text) {
    const auto result = render({fog_vdb, "--passes", "1", "-o", name});
    EXPECT_EQ(result.code, 2) << result.error;
    EXPECT_EQ(result.error_lines(), 1u) << result.error;
    EXPECT_NE(result.error.find(text), std::string::npos) << result.error;
  };
  refused(std::string(260, 'x') + ".exr", "-o: a name of 264 bytes is too long, 255 are possible");
  refused(std::string(245, 'x') + ".exr", "the checkpoint of -o: a name of 260 bytes is too long");
  EXPECT_EQ(render({fog_vdb, "--passes", "1", "-o", std::string(240, 'x') + ".exr"}).code, 0);
}

TEST_F(FileClaims, InputsMayBeTheSameFile) {
  ASSERT_EQ(render({fog_vdb, "-o", "ref.exr", "--passes", "1", "-q"}).code, 0);
  const auto result =
      render({fog_vdb, "-o", "a.exr", "--passes", "1", "--reference", "ref.exr", "--set",
              "light.2.type=environment", "--set", "light.2.image=ref.exr"});
  EXPECT_EQ(result.code, 0) << result.error;
  // Rendering again over what is there is what outputs are for.
  EXPECT_EQ(render({fog_vdb, "-o", "ref.exr", "--passes", "1", "-q"}).code, 0);
}

TEST_F(FileClaims, DashIsTheStandardOutput) {
  const auto report =
      render({"s.toml", "-f", "1", "-o", "a.exr", "--passes", "1", "--report", "-"});
  ASSERT_EQ(report.code, 0) << report.error;
  EXPECT_EQ(Json::parse(report.out)["frame"], 1);
  const auto summary =
      render({"s.toml", "-f", "1-2", "-o", "o.####.exr", "--passes", "1", "--summary", "-"});
  ASSERT_EQ(summary.code, 0) << summary.error;
  EXPECT_EQ(Json::parse(summary.out)["done"], Json::array({1, 2}));
  EXPECT_FALSE(exists("-"));
  expect_render_refused({"--summary", "-", "--report", "-"}, "--summary -", "--report");
  expect_render_refused({"--summary", "-", "--progress", "openjd"}, "--summary -", "--progress");
}

TEST_F(FileClaims, APartialImageIsAnExr) {
  ASSERT_EQ(render({fog_vdb, "-o", "p.exr", "-q", "--pass-range", "0-0"}).code, 0);
  const auto result = run({"merge", "-o", "m.exr", "--partial", "p.png", "p.exr"});
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.error, "--partial p.png: a partial image must be an .exr\n");
  EXPECT_FALSE(exists("p.png"));
}

/// Each frame has four files that are compared with each other. Before folders were listed and
/// claims kept without their texts, it took 20 s of processor time.
TEST_F(FileClaims, HundredsOfThousandsOfFramesTakeSeconds) {
  const auto result = run({"farm", "slurm", fog_vdb, "-f", "1-300000", "--chunk", "1000", "-o",
                           "o.####.exr", "--job", "job.sh"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_LT(result.processor_seconds, 10);
  const auto clash = run({"farm", "slurm", fog_vdb, "-f", "1-300000", "--chunk", "1000", "-o",
                          "o.####.exr", "--job", "O.299999.checkpoint.EXR"});
  EXPECT_EQ(clash.code, 2);
  EXPECT_NE(clash.error.find("is the same file as"), std::string::npos) << clash.error;
}

} // namespace
} // namespace vdbeam
