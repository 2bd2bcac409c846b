# What a scenario (scenarios/*.bash) has: vcan0, up and silent; $tests, this folder; `strainfinger` on the PATH; $TMPDIR to write to; and
# these. It passes if its last command does, and fails at the first command that fails (bash -eu -o pipefail).

trap 'kill $(jobs -p) 2>/dev/null || true; wait' EXIT   # a scenario that fails leaves nobody on the bus of the next

fail() { echo "failed: $*"; exit 1; }

# expect WHAT EXPECTED ACTUAL
expect() { [ "$2" = "$3" ] || fail "$1: expected '$2', not '$3'"; }

# candump as the witness: everything on vcan0 from here on, as `candump -L` has it, in $recording.
record() {
  recording=$TMPDIR/recording
  candump -r 8388608 -L vcan0 >"$recording" &
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
  while [ "$(stat -c %s "$recording")" != $size ]; do size=$(stat -c %s "$recording"); sleep 0.3; done
  kill $candump_pid
  wait $candump_pid || true
}

# The recorded frames without time and interface: 123#DEADBEEF
recorded_frames() { cut -d' ' -f3 "$recording"; }

# summed_up NAME: that number of the summary of `run --json` in $TMPDIR/summary
summed_up() { sed -n 's/.*"'"$1"'":\([0-9.]*\).*/\1/p' "$TMPDIR/summary"; }

# What is recorded has the heartbeats of the run that $TMPDIR/summary sums up: all that were sent, and one for each 100 ms but
# for what a late machine loses: a heartbeat waits for a step, of at most two sample sets beside the lost ones.
expect_heartbeats() {
  local heard lost duration_ms
  heard=$(recorded_frames | grep -c '^701#' || true)
  lost=$(summed_up overruns)
  duration_ms=$(awk "BEGIN { print int(1000 * $(summed_up duration_s)) }")
  expect "heartbeats heard" "$(summed_up heartbeats)" "$heard"
  [ $((heard * 102 + lost)) -ge "$duration_ms" ] || fail "$heard heartbeats in $duration_ms ms, of which $lost are lost"
}

# Starts a finger ($finger) on vcan0 that is stroked all the time, and waits until a recording hears of the first touch.
start_stroked_finger() {
  cat >"$TMPDIR/stroke.toml" <<END
schema = 1
[[touch]]
start_s = 0.2
end_s = 72
angle_deg = [-3600, 3600]
normal_n_per_m = 20
END
  record
  strainfinger run --can vcan0 --scenario "$TMPDIR/stroke.toml" 2>"$TMPDIR/summary" &
  finger=$!
  until grep -q ' 181#' "$recording"; do
    kill -0 $finger || fail "$(cat "$TMPDIR/summary")"
    sleep 0.1
  done
}
