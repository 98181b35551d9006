#include "cli_fixture.h"

namespace vdbeam {
namespace {

using Usage = test::CliTest;

TEST_F(Usage, HelpOfEveryCommandHasExamples) {
  const auto top = run({"--help"});
  EXPECT_EQ(top.code, 0);
  EXPECT_NE(top.out.find("Exit codes:"), std::string::npos);
  for (const char* command :
       {"render", "info", "live", "init", "plan", "compare", "merge", "summary", "farm", "help"}) {
    EXPECT_NE(top.out.find(std::string("\n  ") + command + " "), std::string::npos) << command;
    const auto help = run({command, "--help"});
    EXPECT_EQ(help.code, 0) << command;
    EXPECT_TRUE(help.error.empty()) << help.error;
    EXPECT_NE(help.out.find("Examples:"), std::string::npos) << command;
    EXPECT_NE(help.out.find(std::string("vdbeam ") + command), std::string::npos) << command;
  }
}

TEST_F(Usage, VersionNamesTheLibraries) {
  const auto result = run({"--version"});
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.out.starts_with("vdbeam ")) << result.out;
  for (const char* name : {"OpenVDB 10", "oneTBB 20", "OpenEXR 3", "SIMD "})
    EXPECT_NE(result.out.find(name), std::string::npos) << result.out;
}

TEST_F(Usage, SceneKeysAreListed) {
  const auto result = run({"--help-scene"});
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.out.find("droplet_diameter"), std::string::npos);
}

TEST_F(Usage, WrongUseIsBadInputOnOneLine) {
  const std::vector<std::vector<std::string>> wrong{{},
                                                    {"rander"},
                                                    {"render"},
                                                    {"render", cloud, "--nonsense"},
                                                    {"render", cloud, "--passes"},
                                                    {"render", cloud, "extra"},
                                                    {"render", cloud, "--exposure", "bright"},
                                                    {"compare", "a.exr"},
                                                    {"info"},
                                                    {"plan", cloud, "-f", "x"}};
  for (const auto& arguments : wrong) {
    const auto result = run(arguments);
    EXPECT_EQ(result.code, 2) << result.error;
    EXPECT_EQ(result.error_lines(), 1u) << result.error;
    EXPECT_TRUE(result.out.empty()) << result.out;
  }
}

TEST_F(Usage, TyposAreToldWithWhatWasMeant) {
  const std::string s = VDBEAM_SOURCE_DIR "/data/smoke/smoke.00";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{},
       "vdbeam: which command? render, info, live, init, plan, compare, merge, summary, farm "
       "or help; vdbeam --help describes them\n"},
      {{"rendr", "x.vdb"},
       "vdbeam: rendr is not one of its commands, which are render, info, live, init, plan, "
       "compare, merge, summary, farm and help; did you mean render?\n"},
      {{"x.vdb"}, "vdbeam: x.vdb is not a command; to render it: vdbeam render x.vdb\n"},
      {{"x.toml"}, "vdbeam: x.toml is not a command; to render it: vdbeam render x.toml\n"},
      {{"--versoin"}, "vdbeam: there is no option --versoin; did you mean --version?\n"},
      {{"help", "rander"}, "vdbeam help: there is no command rander; did you mean render?\n"},
      {{"farm"},
       "vdbeam farm: which command? slurm or openjd; vdbeam farm --help describes them\n"},
      {{"farm", "slrum"},
       "vdbeam farm: slrum is not one of its commands, which are slurm and "
       "openjd; did you mean slurm?\n"},
      {{"farm", "slurm", cloud, "--frmes", "2"},
       "vdbeam farm slurm: there is no option --frmes; did you mean --frames?\n"},
      {{"render", cloud, "--tiem", "5s"},
       "vdbeam render: there is no option --tiem; did you mean --time?\n"},
      {{"render", cloud, "--tiem=5s"},
       "vdbeam render: there is no option --tiem; did you mean --time?\n"},
      {{"render", "--tiem", "5s"},
       "vdbeam render: there is no option --tiem; did you mean --time?\n"},
      {{"render", cloud, "--samples", "4"},
       "vdbeam render: there is no option --samples; did you mean --passes?\n"},
      {{"render", cloud, "--spp=4"},
       "vdbeam render: there is no option --spp; did you mean --passes?\n"},
      {{"render", cloud, "--size", "640x360"},
       "vdbeam render: there is no option --size; did you mean --resolution WxH?\n"},
      {{"plan", cloud, "--fov", "30"},
       "vdbeam plan: there is no option --fov; did you mean --set camera.fov=VALUE?\n"},
      {{"render", cloud, "--region", "10", "10", "20", "20"},
       "vdbeam render: the value of --region is one word: --region 10,10,20,20\n"},
      {{"render", "--resolution", "64", "36", cloud},
       "vdbeam render: the value of --resolution is one word: --resolution 64x36\n"},
      {{"render", cloud, "--set", "camera.position=0", "0", "5"},
       "vdbeam render: the value of --set is one word: --set camera.position=[0,0,5]\n"},
      {{"help", "lihgt"}, "vdbeam help: there is no command lihgt; did you mean light?\n"},
      {{"render", cloud, "-x"},
       "vdbeam render: there is no option -x; vdbeam render --help lists them all\n"},
      {{"render"},
       "vdbeam render: SCENE|VDB is missing: Scene file, or a VDB (#### for the frame "
       "number)\n"},
      {{"render", cloud, "--passes"}, "vdbeam render: --passes needs a value: --passes N\n"},
      {{"render", cloud, "--passes", "2", "--passes", "3"},
       "vdbeam render: --passes may be given once only: --passes N\n"},
      {{"render", cloud, "--exposure", "bright"},
       "vdbeam render: --exposure bright: must be a number\n"},
      {{"render", cloud, "--on-error", "stpo"},
       "vdbeam render: --on-error stpo: must be continue or stop; did you mean stop?\n"},
      {{"render", s + "01.vdb", s + "12.vdb", s + "24.vdb"},
       "vdbeam render: takes one scene, got 3 files; for a sequence write " +
           s.substr(0, s.size() - 2) + "####.vdb -f 1,12,24\n"}};
  for (const auto& [arguments, message] : cases) {
    const auto result = run(arguments);
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.error, message);
    EXPECT_TRUE(result.out.empty()) << result.out;
  }
}

TEST_F(Usage, HelpIsACommandToo) {
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
  EXPECT_EQ(run({"help", "render"}).out, run({"render", "--help"}).out);
  EXPECT_EQ(run({"help", "farm", "slurm"}).out, run({"farm", "slurm", "--help"}).out);
  EXPECT_EQ(run({"-v"}).out, run({"--version"}).out);
}

TEST_F(Usage, HelpOfATableOfAScene) {
  const std::string light = run({"help", "light"}).out;
  EXPECT_TRUE(light.starts_with("light\n")) << light;
  EXPECT_NE(light.find("\n  irradiance "), std::string::npos) << light;
  EXPECT_EQ(light.find("\n  extinction "), std::string::npos) << light;
  EXPECT_EQ(run({"help", "scene", "light"}).out, light);
  EXPECT_EQ(run({"help", "phase"}).out, run({"help", "volume.phase"}).out);
  EXPECT_EQ(run({"help", "scene"}).out + "\n", run({"--help-scene"}).out);
  // A command has the name first.
  EXPECT_NE(run({"help", "render"}).out, run({"help", "scene", "render"}).out);
  std::stringstream lines(run({"help", "scene"}).out);
  for (std::string line; std::getline(lines, line);)
    EXPECT_LE(line.size(), 80u) << line;
}

TEST_F(Usage, HelpFitsATerminal) {
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{},
                                             {"render"},
                                             {"info"},
                                             {"init"},
                                             {"plan"},
                                             {"compare"},
                                             {"merge"},
                                             {"summary"},
                                             {"farm"},
                                             {"farm", "slurm"},
                                             {"farm", "openjd"},
                                             {"help"}}) {
    std::vector<std::string> words{"help"};
    words.insert(words.end(), command.begin(), command.end());
    std::stringstream lines(run(words).out);
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count)
      EXPECT_LE(line.size(), 100u) << line;
    EXPECT_GT(count, 5u);
  }
  const std::string help = run({"help", "render"}).out;
  for (const char* heading :
       {"\nWhen to stop:\n", "\nScene:\n", "\nOutput:\n", "\nSequences and farms:\n"})
    EXPECT_NE(help.find(heading), std::string::npos) << heading;
}

TEST_F(Usage, BadValuesNameTheirOption) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--passes", "0"}, "--passes 0: render.passes must be at least 1, got 0\n"},
      {{"--time", "soon"},
       "--time soon: render.time must be seconds or a text like \"90s\", \"5m\" or \"1h30m\" or "
       "\"none\", got \"soon\"\n"},
      {{"--time", "5min"},
       "--time 5min: render.time must be seconds or a text like \"90s\", \"5m\" or \"1h30m\" or "
       "\"none\", got \"5min\"; did you mean 5m?\n"},
      {{"--set", "camera.position=0,0,5"},
       "--set camera.position=0,0,5: camera.position must be 3 numbers, got \"0,0,5\"; did you "
       "mean [0, 0, 5]?\n"},
      {{"--estimator", "beem"},
       "--estimator beem: render.estimator must be auto, beam, gather, march or path, got "
       "\"beem\"; did "
       "you mean "
       "beam?\n"},
      {{"--resolution", "640"}, "--resolution 640: must look like 640x360\n"},
      {{"--resolution", "0x10"}, "--resolution 0x10: image.width must lie in [1, 65536], got 0\n"},
      {{"--seed", "-1"}, "--seed -1: render.seed must be at least 0, got -1\n"},
      {{"-f", "1..3"},
       "--frames: frames must look like 7, 1-24, 1-100x2 or 1,5,9-12, got \"1..3\"\n"},
      {{"--set", "camera.fov"},
       "--set camera.fov: must look like key.path=value, e.g. volume.0.extinction=80\n"},
      {{"-f", "1-3", "-o", "a.exr"}, "-o a.exr: 3 frames would go to one file; write a.####.exr\n"},
      {{"-f", "1-3", "-o", "a.####.exr", "--preview", "a.png"},
       "--preview a.png: 3 frames would go to one file; write a.####.png\n"},
      {{"-o", "a.<UDIM>.exr"},
       "-o a.<UDIM>.exr: <UDIM> does not stand for the frame number; write a.####.exr\n"},
      {{"-f", "1-2", "-o", "a.%V.%04d.exr"},
       "-o a.%V.%04d.exr: %V does not stand for the frame number; write a.%04d.exr\n"},
      {{"-o", "$SHOT/a.exr"},
       "-o $SHOT/a.exr: there is no folder $SHOT; $SHOT is not expanded: write out the path\n"},
      {{"-o", "none/a.exr"},
       "-o none/a.exr: there is no folder none; make it with: mkdir -p none\n"},
      {{"-o", "."}, "-o .: is a folder; add a file's name\n"},
      {{"--report", "none/r.json"},
       "--report none/r.json: there is no folder none; make it with: mkdir -p none\n"},
      {{"--reference", "none.exr"}, ""},
      {{"-o", "a.jpeg"}, ""}};
  for (const auto& [options, message] : cases) {
    std::vector<std::string> arguments{"render", cloud};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.code, 2) << result.error;
    EXPECT_EQ(result.error_lines(), 1u) << result.error;
    if (!message.empty()) {
      EXPECT_EQ(result.error, message);
    }
    EXPECT_TRUE(files().empty());
  }
}

TEST_F(Usage, SceneErrorsHaveFileAndLine) {
  write("s.toml", "[image]\nwidht = 3\n");
  for (const char* command : {"render", "plan"}) {
    const auto result = run({command, "s.toml"});
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.error, "s.toml:2: unknown key image.widht; did you mean width?\n");
  }
}

TEST_F(Usage, FolderWithoutPermission) {
  std::filesystem::create_directory(folder_ / "locked");
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms::owner_read |
                                                       std::filesystem::perms::owner_exec);
  const auto result = run({"render", cloud, "-o", "locked/a.exr"});
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms::owner_all);
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.error,
            "-o locked/a.exr: no permission to write into locked; choose another folder\n");
}

} // namespace
} // namespace vdbeam
