# Functions shared by the scripts of this folder; read with `source`, from the repository root.

# stage NAME COMMAND...: runs the command and adds how long it took to stage_lines.
stage() {
  local name=$1 begin=$EPOCHREALTIME status=0
  shift
  "$@" || status=$?
  local microseconds=$((${EPOCHREALTIME//[!0-9]/} - ${begin//[!0-9]/}))
  stage_lines+="$(printf '  %-10s %4d.%d s' "$name" $((microseconds / 1000000)) $((microseconds % 1000000 / 100000)))"$'\n'
  return "$status"
}
stage_lines=""

# build PRESET [TARGET...]: sets up, configures and builds; later runs only redo what changed.
build() {
  local preset=$1 jobs memory_gb
  shift
  # A compiler process that reads OpenVDB's headers needs up to 2 GB.
  jobs=$(nproc)
  memory_gb=$(awk '/^MemAvailable:/ {print int($2 / 1048576)}' /proc/meminfo 2>/dev/null || true)
  memory_gb=${memory_gb:-64}
  if ((jobs > memory_gb / 2)); then
    jobs=$((memory_gb / 2 > 1 ? memory_gb / 2 : 1))
  fi
  stage setup bash tools/setup.sh
  stage configure cmake --preset "$preset" --log-level=WARNING
  stage build cmake --build --preset "$preset" -j "$jobs" ${1:+--target "$@"}
}
