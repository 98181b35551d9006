#!/usr/bin/env bash
# Sets up, builds and runs every test, on a bare Debian 12 too. Arguments go to ctest, e.g. -L volume.
# With VDBEAM_TEST_SANITIZERS=1 random scenes are rendered under the sanitizers as well, which
# compiles the library once more; with VDBEAM_TEST_LINT=1 tools/lint.sh checks their format. A test whose
# part of the machine is missing (Slurm, a browser, ...) is skipped, and fails where VDBEAM_REQUIRE
# names that part (tests/support/requirements.py). Exit status: ctest's, or 1 where only the others
# complain.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/common.sh

build release
log=build/release/ctest.log
status=0
stage test ctest --test-dir build/release --output-on-failure --no-tests=error -j "$(nproc)" \
  --output-log "$log" "$@" || status=$?
if [[ ${VDBEAM_TEST_LINT:-} == 1 ]]; then
  stage lint tools/lint.sh --format || status=$((status ? status : 1))
fi
if [[ ${VDBEAM_TEST_SANITIZERS:-} == 1 ]]; then
  PRESET=asan-ubsan stage sanitizers tools/stress.sh --seconds 30 || status=$((status ? status : 1))
fi

echo
printf '%s' "$stage_lines"
# The runner's closing line, last.
grep -E '^[0-9]+% tests passed' "$log" | tail -1 || true
exit "$status"
