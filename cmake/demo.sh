#!/usr/bin/env bash
# demo.sh PROGRAM FOLDER: builds the tables of the default finger, touches a simulated one, and shows truth beside
# estimate. What it makes stays in FOLDER.
set -euo pipefail
program=$1 folder=$2
mkdir -p "$folder"
cd "$folder"

step() { printf '\n\033[1m%s\033[0m\n' "$*"; }

cat <<'TEXT'

A finger: a rigid core, a layer of rubber, and in the rubber a ring of strain gauges. From the gauges alone its firmware says
where it is touched (angle), how hard (normal load) and which way it is rubbed (tangential load, N per metre of finger).
TEXT

# What calibration leaves of the build's errors; 0 is a perfect finger, and the default, 0.05, one that nobody calibrated.
printf 'schema = 1\n[gauges]\nmodel_error = 0.003\n' >calibrated.toml
printf 'schema = 1\n[gauges]\nmodel_error = 0\n' >perfect.toml
printf 'schema = 1\n[as_built]\nseed = 1\nangle_deg = 0.5\ndepth_m = 5e-5\ngain = 0.03\n' >as_built.toml

step "1. The lookup tables of a calibrated finger, from the elastic model"
"$program" tables -c calibrated.toml -o finger.tables
"$program" tables verify -c calibrated.toml finger.tables

step "2. A simulated finger, touched: 16 gauges with noise, a 12-bit converter, the firmware's own code"
echo "Press and rub, slide around, tap, hold something that slips; what is reported, with its own sigma, beside the truth:"
"$program" run -c calibrated.toml --can loopback --tables finger.tables --truth --picture touch.png --picture touch.svg >candump.log
echo "The same touches on a perfect finger, and on one as built (gauges 0.5 deg, 0.05 mm and 3 % off) that nobody calibrated:"
"$program" run -c perfect.toml --can loopback >/dev/null
"$program" run -c as_built.toml --can loopback >/dev/null

step "3. What it sent, as candump -L prints it, and what that says (CONTACT, FORCE and PATCH of one moment)"
grep -m1 -A2 '(0000000003\.5.* 181#' candump.log | tee moment.log
"$program" decode <moment.log 2>/dev/null | cut -d, -f1-18

if [ "$(cat /sys/class/net/vcan0/operstate 2>/dev/null || echo none)" = unknown ]; then   # there, and up
  step "4. The same on vcan0, in real time, for 3 s"
  "$program" run -c calibrated.toml --can vcan0 --tables finger.tables --duration 3 --truth
else
  step "4. This machine has no vcan0, so the bus above was a loopback. Where the kernel has CAN:"
  echo "     sudo ip link add dev vcan0 type vcan && sudo ip link set vcan0 up"
  echo "     $program run --can vcan0 & candump vcan0 | $program decode"
fi

step "In $folder:"
echo "  touch.png, touch.svg   the strains with the fit, and the track of the contact (look at one)"
echo "  candump.log            every frame it sent; finger.tables: the flash image of the tables"
step "Next"
echo "  $program run --seed 7 --truth >/dev/null                  other noise, another ring of gauges"
echo "  $program run --scenario mine.toml --truth >/dev/null      your own touches: host/simulation/scenarios/touches.toml says how"
echo "  cmake --preset host && cmake --build --preset host        all the commands: build/host/strainfinger (this program has those of a finger, its tables and its logs)"
