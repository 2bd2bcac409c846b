# Firmware, SocketCAN, kernel, candump, decode: what was sent is what was heard.
record
strainfinger run --can vcan0 --duration 2 --json >"$TMPDIR/out" 2>"$TMPDIR/summary"
stop_recording
cat "$TMPDIR/summary"
expect "stdout" "" "$(cat "$TMPDIR/out")"
touches=$(sed -n 's/.*"touches":\([0-9]*\).*/\1/p' "$TMPDIR/summary")
strainfinger decode <"$recording" >"$TMPDIR/frames" 2>"$TMPDIR/decode"
cat "$TMPDIR/decode"
# rows FRAME COLUMN: that column of that frame's rows
rows() { awk -F, -v frame="$1" '$4 == frame' "$TMPDIR/frames" | cut -d, -f"$2"; }
[ "$(recorded_frames | grep -c '^701#')" -ge 10 ] || fail "fewer than 10 heartbeats in 2 s"
[ "$touches" -gt 20 ] || fail "only $touches touches were sent"
expect "CONTACT heard" "$touches" "$(rows CONTACT 10 | wc -l)"
expect "sequence numbers of FORCE" "$(rows CONTACT 10)" "$(rows FORCE 10)"
expect "what is no finger's" "" "$(grep -v ',vcan0,1,' "$TMPDIR/frames" | sed 1d)"
grep -q " 0 lost, 0 repeated, 0 restarts" "$TMPDIR/decode"
