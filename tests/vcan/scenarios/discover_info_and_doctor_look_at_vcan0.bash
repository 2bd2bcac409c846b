# A finger on a real interface, found without being told where; then with the interface down.
start_stroked_finger

found=$(strainfinger discover --duration 1.2)
echo "$found"
expect "fingers found" 1 "$(grep -c '^vcan0,1,run,.*,2,0\.1,.*,power_on,' <<<"$found")"

strainfinger info --can vcan0 >"$TMPDIR/info"
for row in 'HEARTBEAT,protocol,2' 'INFO,reset_cause,power_on' 'GAUGES,zero_age_s,' 'RESPONSE,erases,0'; do
  grep -q "^vcan0,1,$row" "$TMPDIR/info" || fail "no $row in $(cat "$TMPDIR/info")"
done

strainfinger doctor >"$TMPDIR/doctor" 2>"$TMPDIR/sum" || fail "$(cat "$TMPDIR/doctor" "$TMPDIR/sum")"
cat "$TMPDIR/doctor"
grep -q '^ok  *vcan0: up; a virtual interface' "$TMPDIR/doctor" || fail "the interface is not described"
grep -q '^ok  *vcan0: fingers: 1, ' "$TMPDIR/doctor" || fail "the bus is not described"
# A machine that is late loses sample sets.
grep -qE '^(ok +vcan0 node 1: answers requests|warning +vcan0 node 1: [0-9]+ counted lost sets)' "$TMPDIR/doctor" || fail "the finger is not asked"

# One of several interfaces that can't be opened doesn't keep the others from being listened to.
mkdir "$TMPDIR/tools"
cat >"$TMPDIR/tools/ip" <<'END'
#!/bin/sh
echo '[{"ifname":"vcan7","flags":["UP"],"link_type":"can"},{"ifname":"vcan0","flags":["UP"],"link_type":"can"}]'
END
chmod +x "$TMPDIR/tools/ip"
found=$(PATH=$TMPDIR/tools:$PATH strainfinger discover --duration 1.2 2>"$TMPDIR/message")
expect "fingers found beside an interface that is none" 1 "$(grep -c '^vcan0,1,run,' <<<"$found")"
grep -q 'no CAN interface vcan7' "$TMPDIR/message" || fail "$(cat "$TMPDIR/message")"

# expect_down COMMAND...: the interface goes down meanwhile, which is not the finger's fault
expect_down() {
  local status=0
  (sleep 1; ip link set vcan0 down) &
  "$@" >"$TMPDIR/out" 2>"$TMPDIR/message" || status=$?
  wait $!
  ip link set vcan0 up
  expect "exit status of $2 while the interface goes down" 3 $status
  grep -q 'vcan0:\? went down meanwhile' "$TMPDIR/out" "$TMPDIR/message" || fail "$(cat "$TMPDIR/out" "$TMPDIR/message")"
}
kill $candump_pid   # it does not outlive its interface
wait $candump_pid || true
expect_down strainfinger doctor --can vcan0 --duration 2
expect_down strainfinger discover --can vcan0 --duration 2

# One of several that goes down hides no finger of the others.
ip link add dev vcan1 type vcan
ip link set vcan1 up
(sleep 1; ip link set vcan1 down) &
found=$(strainfinger discover --duration 2 2>"$TMPDIR/message")
wait $!
ip link del vcan1
expect "fingers found beside an interface that goes down" 1 "$(grep -c '^vcan0,1,run,' <<<"$found")"
grep -q 'vcan1 went down meanwhile' "$TMPDIR/message" || fail "$(cat "$TMPDIR/message")"

kill -TERM $finger
wait $finger || true
ip link set vcan0 down
status=0
strainfinger doctor >"$TMPDIR/doctor" 2>/dev/null || status=$?
ip link set vcan0 up
expect "exit status of an interface that is down" 3 $status
grep -q '^error  *vcan0: down' "$TMPDIR/doctor" || fail "$(cat "$TMPDIR/doctor")"
grep -qF 'what to do: `sudo ip link set vcan0 up`' "$TMPDIR/doctor" || fail "$(cat "$TMPDIR/doctor")"
