# Without --duration it runs until a signal; then it sums up.
record
strainfinger run --can vcan0 --json 2>"$TMPDIR/summary" &
finger=$!
for _ in $(seq 300); do   # until it is heard, however slow the machine
  grep -q ' 701#' "$recording" && break
  sleep 0.1
done
sleep 0.5
kill -TERM $finger
status=0
wait $finger || status=$?
stop_recording
cat "$TMPDIR/summary"
expect "exit status" 130 $status
grep -q "run: interrupted after " "$TMPDIR/summary"
expect_heartbeats
