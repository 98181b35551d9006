#include "farm/engines.h"
#include "farm/job_seal.h"
#include "text/frame_range.h"
#include "vdbeam/error.h"

#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

/// Slurm sends the signal up to a minute before it is due.
constexpr int signal_lead = 120, signal_slack = 60;

/// A value of an #SBATCH line.
std::string directive_value(const std::string& text) {
  if (text.find_first_of("\"\\\n") != std::string::npos)
    throw InputError(
        fmt::format("slurm: {}: a path with a quote, backslash or line break; rename it", text));
  return text.find_first_of(" #\t'$&;|<>()*?") == std::string::npos ? text : '"' + text + '"';
}

/// A folder in a pattern of a log's name, where % has a meaning.
std::string log_folder(const std::string& folder) {
  std::string result;
  for (const char c : folder)
    result += c == '%' ? std::string("%%") : std::string(1, c);
  return result;
}

std::string bash_array(const std::string& name, const std::vector<std::string>& words) {
  std::string text = name + "=(";
  std::size_t column = text.size();
  for (const std::string& word : words) {
    const std::string quoted = shell_word(word);
    const bool breaks = column + quoted.size() > 100 && column > 4;
    text += breaks ? "\n  " : text.back() == '(' ? "" : " ";
    column = (breaks ? 2 : column + 1) + quoted.size();
    text += quoted;
  }
  return text + ")\n";
}

std::string header(const FarmJob& job) {
  const auto directive = [](const std::string& option, const std::string& value = "") {
    return "#SBATCH --" + option + (value.empty() ? "" : "=" + value) + "\n";
  };
  const int tasks = task_count(job);
  std::string text = directive("job-name", job.name);
  text += directive("array",
                    fmt::format("0-{}{}", tasks - 1,
                                job.running > 0 ? fmt::format("%{}", job.running) : std::string()));
  text += directive("cpus-per-task", std::to_string(job.threads));
  text += directive("mem", fmt::format("{}M", job.memory_mib));
  if (job.time_limit > 0)
    text += directive("time", fmt::format("{:.0f}", std::ceil(job.time_limit / 60)));
  text += directive("requeue");
  text += directive("open-mode", "append");
  text += directive("signal", fmt::format("B:TERM@{}", signal_lead));
  text += directive("chdir", directive_value(job.folder));
  text += directive("output", directive_value(log_folder(job.logs) + "/%x_%A_%a.log"));
  return text;
}

std::string settings(const FarmJob& job) {
  std::string text = "vdbeam=" + shell_word(job.program) + "\n";
  text += "scene=" + shell_word(job.scene) + "\n";
  text += bash_array("options", job.options);
  std::vector<std::string> frames;
  for (const int frame : job.frames)
    frames.push_back(std::to_string(frame));
  text += bash_array("frames", frames);
  text += fmt::format("chunk={}          # frames of one task\n", job.chunk);
  text += fmt::format("checkpoint={}\n", seconds_text(job.checkpoint));
  text += fmt::format("time_limit={:.0f}     # seconds of one task, 0: the partition's\n",
                      60 * std::ceil(job.time_limit / 60));
  text += "output=" + shell_word(job.output) + "\n";
  if (job.splits == 1)
    return text;
  const std::vector<std::string> ranges = pass_ranges(job);
  std::vector<std::string> partials;
  for (const std::string& range : ranges)
    partials.push_back(partial_path(job.output, range));
  text += bash_array("pass_ranges", ranges);
  text += bash_array("partials", partials);
  return text + fmt::format("merge_memory={}M\n", job.merge_memory_mib);
}

const char* const run_function = R"sh(
# Runs a command so that a SIGTERM which Slurm sends to this script alone reaches it.
child='' interrupted=0
forward() {
  interrupted=1
  [[ -n $child ]] && kill -TERM "$child" 2>/dev/null
}
trap forward TERM
run() {
  "$@" &
  child=$!
  local status
  wait "$child"
  status=$?
  while ((interrupted)); do
    interrupted=0
    wait "$child"
    status=$?
  done
  child=''
  return "$status"
}
)sh";

/// Near the time limit a task goes back to the queue; after scancel it must not.
std::string end_function() {
  return fmt::format(R"sh(
# Near the time limit the checkpoint is on the disk: the task goes on where it was, in a new turn.
finish() {{
  if (($1 == 143 && time_limit > 0 && SECONDS + {} > time_limit)); then
    echo "time limit: back to the queue"
    scontrol requeue "$SLURM_JOB_ID"
  fi
  exit "$1"
}}
)sh",
                     signal_lead + signal_slack);
}

const char* const choose_frames = R"sh(
first=$((SLURM_ARRAY_TASK_ID * chunk))
chosen=("${frames[@]:first:chunk}")
join() {
  local IFS=,
  echo "$*"
}
turn="turn $((${SLURM_RESTART_COUNT:-0} + 1)) on ${SLURMD_NODENAME:-$HOSTNAME}"
)sh";

const char* const render_whole = R"sh(
list=$(join "${chosen[@]}")
echo "frames $list, $turn"
run "$vdbeam" render "$scene" "${options[@]}" "--frames=$list" -o "$output" \
  --skip-existing --checkpoint "$checkpoint" --progress plain
finish $?
)sh";

const char* const submit_splits = R"sh(
# Outside of a task: submits an array for each range of passes, and one that merges them, where
# each task starts when those of the same number are done.
if [[ -z ${SLURM_ARRAY_TASK_ID:-} ]]; then
  jobs=()
  give_up() {
    [[ ${#jobs[@]} -gt 0 ]] && scancel "${jobs[@]}"
    echo "sbatch failed; nothing is left in the queue" >&2
    exit 1
  }
  for part in "${!pass_ranges[@]}"; do
    job=$(sbatch --parsable --export="ALL,VDBEAM_PART=$part" "$@" "$0") || give_up
    jobs+=("${job%%;*}")
  done
  job=$(sbatch --parsable --export=ALL,VDBEAM_PART=merge --kill-on-invalid-dep=yes \
    --dependency="aftercorr$(printf ':%s' "${jobs[@]}")" --cpus-per-task=1 \
    --mem="$merge_memory" "$@" "$0") || give_up
  echo "rendering: ${jobs[*]}, merging: ${job%%;*}"
  exit 0
fi
)sh";

const char* const render_splits = R"sh(
list=$(join "${chosen[@]}")
if [[ $VDBEAM_PART == merge ]]; then
  # Parts of another scene, or of volumes that were replaced meanwhile, are refused.
  echo "frames $list, merging, $turn"
  run "$vdbeam" render "$scene" "${options[@]}" "--frames=$list" -o "$output" --skip-existing \
    "${partials[@]/#/--from-parts=}" --progress plain
  exit $?
fi
range=${pass_ranges[VDBEAM_PART]}
echo "frames $list, passes $range, $turn"
run "$vdbeam" render "$scene" "${options[@]}" "--frames=$list" -o "${partials[VDBEAM_PART]}" \
  --pass-range "$range" --skip-existing --skip-merged "$output" --checkpoint "$checkpoint" \
  --progress plain
finish $?
)sh";

} // namespace

std::string slurm_submission(const FarmJob& job) {
  return (job.splits > 1 ? "bash " : "sbatch ") +
         (job.job_file.empty() ? "FILE" : shell_word(job.job_file));
}

std::string slurm_script(const FarmJob& job) {
  if (job.time_limit > 0 && job.time_limit < 300)
    throw InputError("slurm: --time-limit must be at least 5m: the signal comes 2 to 3 minutes "
                     "before the end");
  std::string text = "#!/bin/bash\n";
  text += fmt::format("# {} frames ({}) of {}, {} a task{}.\n", job.frames.size(),
                      format_frame_range(job.frames), job.name, job.chunk,
                      job.splits > 1 ? fmt::format(", each in {} parts", job.splits) : "");
  text +=
      fmt::format("# Submit with `{}`; options of sbatch may be added. Submitting again renders "
                  "what is missing.\n",
                  slurm_submission(job));
  text += fmt::format("# {}\n", job_mark("slurm"));
  text += header(job);
  text += "set -uo pipefail\n\n" + settings(job);
  if (job.splits > 1)
    text += submit_splits;
  text += run_function;
  text += end_function();
  text += choose_frames;
  return sealed_job(text + (job.splits > 1 ? render_splits : render_whole));
}

} // namespace vdbeam
