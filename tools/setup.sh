#!/usr/bin/env bash
# Installs the Debian 12 packages that building vdbeam needs, where they are missing.
# Exit status: 0 everything is there, 2 it cannot be put there (one line says what to do).
set -euo pipefail

packages=(
  # compiler and build tools
  g++ cmake ninja-build pkg-config ccache dpkg-dev
  # OpenVDB; its development package does not pull in all that its headers and find module need
  libopenvdb-dev libboost-iostreams-dev libblosc-dev zlib1g-dev
  # the other libraries
  libtbb-dev libopenexr-dev libimath-dev libpng-dev libturbojpeg0-dev libfmt-dev libtomlplusplus-dev
  libcli11-dev nlohmann-json3-dev libhwy-dev libxxhash-dev libembree-dev libassimp-dev
  libopencolorio-dev
  # the Python module
  pybind11-dev python3-dev
  # tests and benchmarks
  libgtest-dev libboost-math-dev libbenchmark-dev openimageio-tools openexr
  # tools
  python3 python3-numpy python3-matplotlib
)
# Daemons, 13 MB, for the test of tests/farm that runs jobs on a real Slurm; without them it is
# skipped. Only where they are asked for: Debian starts munged when it is installed.
if [[ ${VDBEAM_SETUP_SLURM:-} == 1 ]]; then
  packages+=(munge slurmctld slurmd slurm-client)
fi
# A browser, 300 MB, for the test of the page that tools/error_vs_time.py writes; without it the test is
# skipped. Only where it is asked for.
if [[ ${VDBEAM_SETUP_BROWSER:-} == 1 ]]; then
  packages+=(chromium chromium-driver)
fi
# Blender, 264 MB, for the tests of its add-on (tests/blender), which are skipped without it. Only where it is asked for.
if [[ ${VDBEAM_SETUP_BLENDER:-} == 1 ]]; then
  packages+=(blender)
fi
# What tools/lint.sh --format runs, 60 MB. Only where it is asked for.
if [[ ${VDBEAM_SETUP_LINT:-} == 1 ]]; then
  packages+=(clang-format)
fi

if [[ ${1:-} == --list ]]; then
  echo "${packages[*]}"
  exit 0
fi
if [[ ${VDBEAM_SKIP_SETUP:-} == 1 ]]; then
  exit 0
fi

system=$(. /etc/os-release 2>/dev/null && echo "${ID:-unknown} ${VERSION_ID:-}" || echo unknown)
if [[ $system != "debian 12" ]]; then
  echo "setup.sh: installs packages on Debian 12 only, this is '$system': install your system's equivalents of ${packages[*]}, then run again with VDBEAM_SKIP_SETUP=1" >&2
  exit 2
fi

missing=()
installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null || true)
for package in "${packages[@]}"; do
  grep -qxF "$package installed" <<<"$installed" || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if command -v sudo >/dev/null && { [[ -t 0 ]] || sudo -n true 2>/dev/null; }; then
    as_root=(sudo)
  else
    echo "setup.sh: needs root or sudo: run as root: apt-get install ${missing[*]}" >&2
    exit 2
  fi
fi

echo "installing ${missing[*]}"
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -q -o DPkg::Lock::Timeout=300 "$@" </dev/null
}
if ! { apt_get update && apt_get install -y --no-install-recommends "${missing[@]}"; }; then
  echo "setup.sh: apt-get failed (its messages are above); to try by hand: apt-get install ${missing[*]}" >&2
  exit 2
fi
