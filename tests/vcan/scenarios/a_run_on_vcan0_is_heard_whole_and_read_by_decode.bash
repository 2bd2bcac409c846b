# Firmware, SocketCAN, kernel, candump, decode: what was sent is what was heard.
for duration_s in 2 20; do   # a late machine loses most of its sample sets
  record
  strainfinger run --can vcan0 --duration $duration_s --json >"$TMPDIR/out" 2>"$TMPDIR/summary"
  stop_recording
  cat "$TMPDIR/summary"
  expect "stdout" "" "$(cat "$TMPDIR/out")"
  expect_heartbeats
  [ "$(summed_up fits)" -lt 100 ] || break
done
touches=$(summed_up touches)
strainfinger decode <"$recording" >"$TMPDIR/frames" 2>"$TMPDIR/decode"
cat "$TMPDIR/decode"
# rows FRAME COLUMN: that column of that frame's rows
rows() { awk -F, -v frame="$1" '$4 == frame' "$TMPDIR/frames" | cut -d, -f"$2"; }
[ "$touches" -gt 20 ] && [ "$touches" -ge $(($(summed_up fits) / 4)) ] || fail "only $touches touches were sent"
expect "CONTACT heard" "$touches" "$(rows CONTACT 10 | wc -l)"
expect "sequence numbers of FORCE" "$(rows CONTACT 10)" "$(rows FORCE 10)"
expect "sequence numbers of PATCH" "$(rows CONTACT 10)" "$(rows PATCH 10)"
expect "what is no finger's" "" "$(grep -v ',vcan0,1,' "$TMPDIR/frames" | sed 1d)"
grep -q " 0 lost, 0 repeated, 0 restarts" "$TMPDIR/decode"
