# `push` to a finger on vcan0. What reached the bus is candump's word.
cat >"$TMPDIR/finger.toml" <<'END'
schema = 1
[gauges]
radius_m = 9.5e-3
END
echo 'schema = 1' >"$TMPDIR/untouched.toml"
record
strainfinger run --can vcan0 --scenario "$TMPDIR/untouched.toml" 2>/dev/null &
finger=$!
until grep -q ' 701#' "$recording"; do sleep 0.1; done

strainfinger tables -c "$TMPDIR/finger.toml" -o "$TMPDIR/tables" 2>/dev/null
crc=$(strainfinger tables info "$TMPDIR/tables" | sed -n 's/^crc32,//p')
expect "what was sent" "interface,node,table_crc,bytes
vcan0,1,$crc,24568" "$(strainfinger push "$TMPDIR/tables" --can vcan0)"
strainfinger info --can vcan0 -c "$TMPDIR/finger.toml" >"$TMPDIR/info" || fail "other tables than the config's: $(cat "$TMPDIR/info")"
grep -q ',reset_cause,software,' "$TMPDIR/info" || fail "$(cat "$TMPDIR/info")"

kill -TERM $finger
wait $finger || true
stop_recording
# The words of the bus are the file.
printf "$(recorded_frames | sed -n 's/^601#0708....//p' | sed 's/../\\x&/g' | tr -d '\n')" | cmp - "$TMPDIR/tables" || fail "other words than the file's"
expect "answers" 6142 "$(recorded_frames | grep -c '^581#068800')"
expect "the rest that was asked and answered" "601#0107000000000000 581#0287000000000000 601#0209010000000000 581#0289000000000000" \
  "$(recorded_frames | grep -E '^(601|581)#' | grep -vE '^(601#0708|581#0688|601#0205|581#0685)' | xargs)"
