#!/usr/bin/env bash
# From a bare Debian 12 to a picture: sets up, builds, renders the sample cloud.
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/common.sh

build release vdbeam_cli
mkdir -p out
stage render build/release/vdbeam render data/sunlit_cloud.toml -o out/cloud.exr --preview out/cloud.png

echo
printf '%s' "$stage_lines"
echo "image    $PWD/out/cloud.exr"
echo "preview  $PWD/out/cloud.png"
