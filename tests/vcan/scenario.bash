# What a scenario (scenarios/*.bash) has: vcan0, up and silent; $tests, this folder; `strainfinger` on the PATH; $TMPDIR to write to; and
# these. It passes if its last command does, and fails at the first command that fails (bash -eu -o pipefail).

fail() { echo "failed: $*"; exit 1; }

# expect WHAT EXPECTED ACTUAL
expect() { [ "$2" = "$3" ] || fail "$1: expected '$2', not '$3'"; }

# candump as the witness: everything on vcan0 from here on, as `candump -L` has it, in $recording.
record() {
  recording=$TMPDIR/recording
  candump -L vcan0 >"$recording" &
  candump_pid=$!
  for _ in $(seq 100); do   # until its socket is bound
    grep -q vcan0 /proc/net/can/rcvlist_all && return
    sleep 0.02
  done
  fail "candump does not listen"
}

# Ends the recording once nothing has come for a while.
stop_recording() {
  local size=-1
  while [ "$(stat -c %s "$recording")" != $size ]; do size=$(stat -c %s "$recording"); sleep 0.1; done
  kill $candump_pid
  wait $candump_pid || true
}

# The recorded frames without time and interface: 123#DEADBEEF
recorded_frames() { cut -d' ' -f3 "$recording"; }
