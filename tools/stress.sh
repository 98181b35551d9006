#!/usr/bin/env bash
# Renders random scenes and checks the laws of light: ten minutes from seed 1, or as the arguments
# say, e.g.
#   tools/stress.sh --seconds 3600 --first 100000
#   tools/stress.sh --seed 17
# PRESET=asan-ubsan tools/stress.sh runs it under the sanitizers. Exit status: 1 where a law broke.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/common.sh

preset=${PRESET:-release}
build "$preset" vdbeam_stress
if (($# == 0)); then
  set -- --seconds 600
fi
exec "build/$preset/tests/vdbeam_stress" "$@"
