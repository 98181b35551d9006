#!/usr/bin/env bash
# Checks the sources: tools/lint.sh [--format | --tidy] [FILE...]; both and all files by default.
# --format checks layout, the style of the text and the format of C++ files.
# Needs clang-format and clang-tidy 14 (apt-get install clang-format clang-tidy); --tidy also needs what
# tools/setup.sh installs. Changes no source.
set -euo pipefail
cd "$(dirname "$0")/.."

format=1 tidy=1
case ${1:-} in
  --format) tidy=0; shift ;;
  --tidy) format=0; shift ;;
esac
if [[ $# -gt 0 ]]; then
  files=("$@")
else
  mapfile -t files < <(find include src tests benchmarks -name '*.h' -o -name '*.cpp' | sort)
fi

status=0
if ((format)); then
  python3 tools/check_layout.py || status=1
  python3 tools/check_style.py || status=1
  "$(command -v clang-format-14 || echo clang-format)" --dry-run -Werror "${files[@]}" || status=1
fi
if ((tidy)); then
  mapfile -t sources < <(printf '%s\n' "${files[@]}" | grep '^src/.*\.cpp$')
  # g++ alone can read the header that it precompiled, and knows some of the flags that the build uses.
  cmake --preset release -B build/tidy -DCMAKE_UNITY_BUILD=OFF --log-level=WARNING
  sed -E -i 's/-Winvalid-pch -include [^ ]*cmake_pch\.hxx//g' build/tidy/compile_commands.json
  printf '%s\0' "${sources[@]}" | xargs -0 -n 1 -P "$(nproc)" \
    "$(command -v clang-tidy-14 || echo clang-tidy)" -p build/tidy --quiet \
    --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-ignored-optimization-argument || status=1
fi
exit "$status"
