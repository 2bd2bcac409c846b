#!/usr/bin/env bash
# setup.sh [demo|test|bench]: installs the Debian packages that the workflow of that name needs; without an argument,
# those of all. Safe to run again: says nothing when there is nothing to do. Needs root, or sudo.
set -euo pipefail

demo=(
  cmake ninja-build g++ pkg-config                        # build
  libeigen3-dev libboost-dev libfmt-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev   # host tools
  gnuplot-nox                                             # pictures
)
firmware=(gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib)
whole=(libcpp-httplib-dev libceres-dev)                   # the whole program: the live page, calibration
emulator=(qemu-system-arm)                                # its boards
test=(
  "${demo[@]}" "${whole[@]}" "${firmware[@]}" "${emulator[@]}"
  libbenchmark-dev clang-format                           # what the tests build, and its format
  libcpputest-dev python3-canmatrix python3-can            # framework, DBC oracle, a user's plot
  tmux chromium python3-websockets curl                    # a terminal, a browser and its DevTools protocol
  can-utils iproute2                                      # candump, ip link
  openocd stlink-tools dfu-util                           # that the commands for flashing are ones they know
  clang libclang-rt-14-dev                                # a second compiler, fuzzing
  qemu-system-x86 busybox-static python3                  # a real vcan where this kernel has none
)
bench=("${demo[@]}" "${whole[@]}" "${firmware[@]}" "${emulator[@]}" libbenchmark-dev clang python3 python3-canmatrix)

case ${1-all} in
  demo) packages=("${demo[@]}") ;;
  test | all) packages=("${test[@]}") ;;  # the tests need all there is
  bench) packages=("${bench[@]}") ;;
  *)
    echo "setup.sh: no workflow $1: demo, test, bench, or nothing for all" >&2
    exit 2
    ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "setup.sh: needs root to install: ${missing[*]}. Run it as root, or install sudo." >&2
    exit 1
  }
  as_root=(sudo)
fi

echo "setup.sh: installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
echo "setup.sh: done"
