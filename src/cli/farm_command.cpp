#include "batch/file_claims.h"
#include "batch/output_paths.h"
#include "batch/still_note.h"
#include "cli/check_render.h"
#include "cli/commands.h"
#include "cli/scene_options.h"
#include "console/streams.h"
#include "farm/engines.h"
#include "farm/job_seal.h"
#include "image/output_formats.h"
#include "machine/atomic_file.h"
#include "machine/input_file.h"
#include "text/frame_range.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {
namespace {

namespace fs = std::filesystem;

const char* const examples = R"(Examples:
  vdbeam farm slurm smoke.toml -f 1-100 -o out/s.####.exr --job s.sbatch && sbatch s.sbatch
  vdbeam farm slurm smoke.toml -f 1-100 -o s.####.exr --passes 64 --splits 4 --job s.sh && bash s.sh
  vdbeam farm openjd smoke.toml -f 1-100 -o out/smoke.####.exr --chunk 5 --job smoke.json
docs/how-to/farm.md describes OpenCue, Deadline and HTCondor too.)";

/// Tasks of an array that Slurm takes unless its administrator allows more (MaxArraySize).
constexpr int usual_array_limit = 1000;

struct FarmOptions {
  SceneOptions scene;
  FarmJob job;
  std::string frames, time_limit, checkpoint = "300s";
  std::vector<std::string> also;
  std::uint64_t memory_mib = 0;
};

double read_duration(const std::string& option, const std::string& text) {
  const auto seconds = parse_duration(text);
  if (!seconds || *seconds <= 0)
    throw InputError(one_line(fmt::format("{} {}: must look like 300s, 5m or 1h30m{}", option, text,
                                          duration_remedy(text))));
  return *seconds;
}

std::vector<int> read_frames(const std::string& text) {
  try {
    return parse_frame_range(text);
  } catch (const InputError& error) {
    throw InputError(one_line(fmt::format("--frames: {}", error.what())));
  }
}

std::string absolute(const std::string& path) {
  return path.empty() ? "" : fs::absolute(path).lexically_normal().string();
}

/// The scene's name with nothing in it that a queueing system or a shell gives a meaning to.
std::string job_name(const std::string& scene) {
  std::string name = fs::path(scene).stem().string().substr(0, 60);
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return c > 127 || (!std::isalnum(c) && c != '.' && c != '-'); }, '_');
  return name.empty() ? "vdbeam" : name;
}

/// Images that the tasks compare their passes with.
int reference_count(const std::vector<std::string>& also) {
  return static_cast<int>(std::count_if(also.begin(), also.end(), [](const std::string& option) {
    return option.starts_with("--reference") || option.starts_with("--second-reference");
  }));
}

/// Memory for the frame that needs most, of the first, the middle and the last one. What such a
/// frame lacks is reported when its turn comes, as by `vdbeam render`; it is an error now only if
/// all of them lack something.
void plan_memory(FarmJob& job, const SceneDocument& document, int references) {
  job.memory_mib = job.merge_memory_mib = 0;
  std::exception_ptr first_error;
  for (const int frame : frames_to_plan(job.frames, document.depends_on_frame())) {
    try {
      const Scene scene = document.scene_at(frame);
      const MemoryPlan plan = plan_memory(scene, references);
      job.memory_mib = std::max(job.memory_mib, task_memory_mib(plan));
      job.merge_memory_mib = std::max(job.merge_memory_mib, merge_memory_mib(plan));
    } catch (const Error&) {
      if (!first_error)
        first_error = std::current_exception();
    }
  }
  if (job.memory_mib == 0)
    std::rethrow_exception(first_error);
}

/// The first of the frames that has everything it needs. Throws InputError where none has.
Scene first_scene(const SceneDocument& document, const std::vector<int>& frames) {
  for (const int frame : frames) {
    try {
      return document.scene_at(frame);
    } catch (const InputError&) {
      continue;
    }
  }
  return document.scene_at(frames.front());
}

/// Notes which frames lack a file. A simulation may still be writing them, so it is no error; a job
/// that handles missing files (--also=--missing=hold) gets no note.
void note_missing(const FarmOptions& options, const SceneDocument& document,
                  const std::vector<int>& frames) {
  if (!document.depends_on_frame()) // what one frame has, all have
    return;
  for (const std::string& option : options.also)
    if (option.starts_with("--missing"))
      return;
  std::vector<int> lacking;
  std::string reason;
  for (const int frame : frames) {
    try {
      document.scene_at(frame);
    } catch (const InputError& error) {
      if (lacking.empty())
        reason = error.what();
      lacking.push_back(frame);
    }
  }
  if (!lacking.empty())
    log("note: {} of {} frames ({}) cannot be rendered until this is fixed: {}", lacking.size(),
        frames.size(), format_frame_range(lacking), reason);
}

/// Refuses a job file that would replace an input, and outputs of the tasks that would.
void check_clashes(const FarmJob& job, const SceneDocument& document) {
  FileClaims claims;
  claims.scene(document, job.scene, job.frames);
  claims.output("--job", job.job_file);
  claims.render({.output = job.output}, job.frames);
  for (const std::string& range : pass_ranges(job)) {
    const FrameFiles part{.output = partial_path(job.output, range)};
    if (part.output == job.output)
      continue;
    check_output_paths(part, job.frames);
    claims.render(part, job.frames, "a part of ");
  }
}

/// A job file may be written anew, but nothing else is replaced. Throws InputError.
void check_job_file(const std::string& path) {
  constexpr std::uint64_t longest = std::uint64_t(64) << 20;
  if (path.empty() || !is_there(path))
    return;
  const std::string text = read_text(path, longest);
  const JobFile found = text.empty() ? JobFile::ours : judge_job(text);
  if (found == JobFile::changed)
    throw InputError(one_line(path) + ": has been edited since vdbeam farm wrote it; give --job "
                                      "another name, or remove the file");
  if (found == JobFile::other)
    throw InputError(one_line(path) +
                     ": exists and was not written by vdbeam farm; give --job another name");
}

/// Refuses a job whose tasks `vdbeam render` would refuse, by that command's own checks.
void check_tasks(const FarmJob& job, const SceneDocument& document,
                 const std::vector<std::string>& scene_words) {
  std::vector<std::string> words{job.scene};
  words.insert(words.end(), job.options.begin(), job.options.end());
  std::string list;
  for (const int frame : job.frames)
    list += (list.empty() ? "" : ",") + std::to_string(frame);
  words.insert(words.end(), {"--frames=" + list, "--skip-existing", "--progress", "plain"});
  std::vector<std::string> part = words, merge = words;
  const std::string range = pass_ranges(job).front();
  part.insert(part.end(), {"-o", partial_path(job.output, range), "--checkpoint",
                           seconds_text(job.checkpoint)});
  try {
    if (!range.empty()) {
      part.insert(part.end(), {"--pass-range", range, "--skip-merged", job.output});
      merge.insert(merge.end(), {"-o", job.output});
      for (const std::string& each : pass_ranges(job))
        merge.push_back("--from-parts=" + partial_path(job.output, each));
      check_render_command(merge, document, scene_words);
    }
    check_render_command(part, document, scene_words);
  } catch (const InputError& error) {
    throw InputError(one_line(fmt::format("the tasks of this job would fail: {}", error.what())));
  }
}

FarmJob make_job(const FarmOptions& options) {
  FarmJob job = options.job;
  job.checkpoint = read_duration("--checkpoint", options.checkpoint);
  const SceneDocument document = options.scene.open();
  job.frames = read_frames(options.frames);
  check_output_paths({.output = job.output}, job.frames);
  output_format(job.output);
  job.name = job_name(options.scene.path());
  job.folder = fs::current_path().string();
  job.scene = absolute(options.scene.path());
  job.output = absolute(job.output);
  job.logs = job.logs.empty() ? fs::path(job.output).parent_path().string() : absolute(job.logs);
  job.job_file = is_stdout(job.job_file) ? "" : absolute(job.job_file);
  check_output_path("--job", job.job_file, {1});
  job.options = options.scene.words();
  job.options.insert(job.options.end(), options.also.begin(), options.also.end());
  const RenderSettings render = first_scene(document, job.frames).render;
  job.passes = render.passes.value_or(0);
  if (job.splits > 1 && (!render.passes || render.time || render.target_error))
    throw InputError("--splits: only a number of passes can be split, not a time or an error; add "
                     "e.g. --passes 64");
  check_clashes(job, document);
  check_job_file(job.job_file);
  note_missing(options, document, job.frames);
  if (render.threads > 0)
    job.threads = render.threads;
  if (!options.time_limit.empty())
    job.time_limit = read_duration("--time-limit", options.time_limit);
  job.memory_mib = job.merge_memory_mib = options.memory_mib;
  check_tasks(job, document, options.scene.words());
  if (options.memory_mib == 0)
    plan_memory(job, document, reference_count(options.also));
  if (const std::string note = still_note(document, options.scene.path(), job.frames);
      !note.empty())
    log("note: {}", note);
  return job;
}

int run_farm(const FarmOptions& options, const FarmEngine& engine) {
  const FarmJob job = make_job(options);
  const std::string text = engine.write(job);
  if (job.job_file.empty()) {
    print_output(text);
  } else {
    const bool replaces = is_there(job.job_file);
    AtomicFile file(job.job_file);
    file.write(text.data(), text.size());
    file.commit();
    if (replaces)
      log("note: {}: the existing job file is replaced", options.job.job_file);
  }
  const int tasks = task_count(job);
  const auto counted = [](auto count, const char* noun) {
    return count_text(static_cast<std::uint64_t>(count), noun);
  };
  log("{} in {}{}, each of {} and {} MiB; submit with: {}", counted(job.frames.size(), "frame"),
      counted(tasks * job.splits, "task"), job.splits > 1 ? " and " + counted(tasks, "merge") : "",
      counted(job.threads, "thread"), job.memory_mib, engine.how_to_submit(job));
  if (tasks > usual_array_limit)
    log("note: Slurm's default limit is {} tasks per array (MaxArraySize); --chunk {} stays below "
        "it",
        usual_array_limit,
        (static_cast<int>(job.frames.size()) + usual_array_limit - 1) / usual_array_limit);
  return 0;
}

void declare(CLI::App& app, FarmOptions& options) {
  options.scene.declare(app);
  FarmJob& job = options.job;
  app.add_option("-f,--frames", options.frames, "Frames: 7, 1-24, 1-100x2, 1,5,9-12")
      ->required()
      ->option_text("RANGE");
  app.add_option("-o,--output", job.output, "Images to write")->required()->option_text("FILE");
  app.add_option("--job", job.job_file, "Job file to write; default: standard output")
      ->option_text("FILE");
  app.add_option("--chunk", job.chunk, "Frames of one task; default 1")
      ->check(CLI::Range(1, 1'000'000))
      ->option_text("N");
  app.add_option("--splits", job.splits, "Split each frame into N parts by passes, and merge them")
      ->check(CLI::Range(1, 1000))
      ->option_text("N");
  app.add_option("--running", job.running,
                 "Greatest number of tasks running at once; default: no limit")
      ->check(CLI::Range(1, 1'000'000))
      ->option_text("N");
  app.add_option("--time-limit", options.time_limit, "Time limit of a task, e.g. 2h")
      ->option_text("T");
  app.add_option("--memory", options.memory_mib, "Memory of one task; default: from the plan")
      ->option_text("MIB");
  app.add_option("--checkpoint", options.checkpoint, "Time between checkpoints; default 300s")
      ->option_text("T");
  app.add_option("--logs", job.logs, "Folder of the tasks' logs; default: that of the images")
      ->check(CLI::ExistingDirectory)
      ->option_text("FOLDER");
  app.add_option("--also", options.also,
                 "Additional option of vdbeam render, e.g. --also=--missing=hold")
      ->take_all()
      ->allow_extra_args(false)
      ->option_text("OPTION");
  app.add_option("--program", job.program, "Path of vdbeam on the farm's machines; default: vdbeam")
      ->option_text("PATH");
  app.footer(examples);
}

} // namespace

CommandRun add_farm(CLI::App& app) {
  app.require_subcommand(1);
  struct Choice {
    const FarmEngine* engine;
    CLI::App* command;
    FarmOptions options;
  };
  const auto choices = std::make_shared<std::vector<std::unique_ptr<Choice>>>();
  for (const FarmEngine& engine : farm_engines()) {
    choices->push_back(std::make_unique<Choice>());
    Choice& choice = *choices->back();
    choice.engine = &engine;
    choice.command = app.add_subcommand(engine.name, engine.description);
    choice.command->group("Engines");
    declare(*choice.command, choice.options);
  }
  app.footer(examples);
  return [choices] {
    for (const auto& choice : *choices)
      if (choice->command->parsed())
        return run_farm(choice->options, *choice->engine);
    return static_cast<int>(ExitCode::internal_error);
  };
}

} // namespace vdbeam::cli
