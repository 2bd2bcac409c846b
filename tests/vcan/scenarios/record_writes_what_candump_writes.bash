# Frames of every format are in the log, and `doctor` and `monitor` have them in frames a second.
record
strainfinger record --can vcan0 -o "$TMPDIR/every_format.log" 2>"$TMPDIR/sum" &
recorder=$!
until [ -e "$TMPDIR/every_format.toml" ]; do sleep 0.05; done
sleep 0.3
for frame in 123#1122 1F334455#1122334455667788 123#R 00000123#R4 123##1112233 7FF#; do cansend vcan0 $frame; done
sleep 0.3
kill -TERM $recorder
wait $recorder || true
stop_recording
expect "what was recorded" "$(recorded_frames)" "$(cut -d' ' -f3 "$TMPDIR/every_format.log")"
grep -q '^record: 6 frames in .*, 0 missed' "$TMPDIR/sum" || fail "$(cat "$TMPDIR/sum")"

(while :; do cansend vcan0 1F334455#1122334455667788; sleep 0.02; done) &
strainfinger doctor --can vcan0 --duration 1 >"$TMPDIR/doctor" 2>/dev/null || true
kill $!
grep -q 'though others send' "$TMPDIR/doctor" || fail "$(cat "$TMPDIR/doctor")"
