#!/usr/bin/env bash
# Installs the Debian packages that building, testing and the demo need. Safe to run again: says nothing
# when there is nothing to do. Needs root, or sudo.
set -euo pipefail

packages=(
  cmake ninja-build g++ pkg-config clang-format           # build
  libeigen3-dev libboost-dev libfmt-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev   # host tools
  gnuplot-nox                                             # pictures
  libcpp-httplib-dev                                      # the live page
  libbenchmark-dev                                        # benchmarks
  gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib   # firmware
  libcpputest-dev python3-canmatrix python3-can            # tests: framework, DBC oracle, a user's plot
  tmux chromium python3-websockets                        # tests: a terminal, a browser and its DevTools protocol
  can-utils iproute2                                      # candump, ip link
  qemu-system-arm clang                                   # tests: emulated boards, a second compiler
  libclang-rt-14-dev                                      # tests: fuzzing
  qemu-system-x86 busybox-static python3                  # tests: a real vcan where this kernel has none
)

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
