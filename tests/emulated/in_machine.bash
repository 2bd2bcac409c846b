# Runs in the small machine of tests/vcan: /dev/ttyS1 is an emulated finger's CAN line. Records what is heard of it, from
# $JOB/ready until the host has made $JOB/done and nothing has come for a second, and leaves that in $JOB/recording.
set -euo pipefail
slcand -o -c -s8 -S 115200 /dev/ttyS1 slcan0   # slower lines cost 4 ms a frame
until [ -e /sys/class/net/slcan0 ]; do sleep 0.05; done
ip link set slcan0 txqueuelen 1000
ip link set slcan0 up
recording=$TMPDIR/recording
candump -r 8388608 -L slcan0 >"$recording" &
until grep -q slcan0 /proc/net/can/rcvlist_all; do sleep 0.02; done
touch "$JOB/ready"
until [ -e "$JOB/done" ]; do sleep 0.1; done
size=-1
while [ "$(stat -c %s "$recording")" != $size ]; do size=$(stat -c %s "$recording"); sleep 1; done
kill %1
cp "$recording" "$JOB/recording"
