#!/usr/bin/env bash
# Sets up, builds and runs every test, on a bare Debian 12 too. Arguments go to ctest, e.g. -L volume.
# Exit status: ctest's.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/common.sh

build release
log=build/release/ctest.log
status=0
stage test ctest --test-dir build/release --output-on-failure --no-tests=error -j "$(nproc)" \
  --output-log "$log" "$@" || status=$?

echo
printf '%s' "$stage_lines"
# The runner's closing line, last.
grep -E '^[0-9]+% tests passed' "$log" | tail -1 || true
exit "$status"
