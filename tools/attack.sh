#!/usr/bin/env bash
# Attacks vdbeam with damaged files, wild commands, kills and pipes: 10,000 mutants, or as the
# arguments say, e.g.
#   tools/attack.sh --hours 8
#   tools/attack.sh --mutants 1000 --kind volume --seed 5000
#   tools/attack.sh --one volume:5017
#   tools/attack.sh --kills 200
#   tools/attack.sh --pipes
# --help describes them. Files of breaches are kept in build/PRESET/attack_breaches. Exit status: 1 where something broke a rule.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/common.sh

preset=${PRESET:-release}
build "$preset" vdbeam_cli make_volumes vdbeam_failing_disk
if (($# == 0)); then
  set -- --mutants 10000
fi
export VDBEAM_BINARY="$PWD/build/$preset/vdbeam" VDBEAM_BUILD="$PWD/build/$preset"
exec python3 -B tools/attack --keep "build/$preset/attack_breaches" "$@"
