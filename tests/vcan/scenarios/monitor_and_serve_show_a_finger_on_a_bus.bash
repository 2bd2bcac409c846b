# `monitor` and `serve` beside a running finger that is touched all the time, and a tare through the page's server.
ip link set lo up
strainfinger serve --can vcan0 --port 0 2>"$TMPDIR/address" &
server=$!
start_stroked_finger

strainfinger monitor --can vcan0 --every 1 >"$TMPDIR/lines" &
monitor=$!
until grep -q 'vcan0 node 1  run  angle .* deg  normal 0\.[34]' "$TMPDIR/lines"; do
  kill -0 $monitor || fail "$(cat "$TMPDIR/lines")"
  sleep 0.1
done
kill -TERM $monitor
status=0
wait $monitor || status=$?
expect "exit status of monitor" 130 $status

# request METHOD PATH: what the server answers
port=$(sed -n 's|.*http://127.0.0.1:\([0-9]*\)/.*|\1|p' "$TMPDIR/address")
request() {
  exec 3<>"/dev/tcp/127.0.0.1/$port"
  printf '%s %s HTTP/1.1\r\nHost: localhost\r\nX-Strainfinger: -\r\nContent-Length: 0\r\n\r\n' "$1" "$2" >&3
  cat <&3
  exec 3>&-
}
state=$(request GET /state)
grep -q '"bus":"vcan0".*"node":1.*"touched":true' <<<"$state" || fail "$state"
answer=$(request POST /fingers/1/tare)
grep -q '409' <<<"$answer" || fail "$answer"
grep -q 'node 1: tare: Refused: something touches' <<<"$answer" || fail "$answer"

kill -TERM $server $finger
status=0
wait $server || status=$?
expect "exit status of serve" 130 $status
wait $finger || true
stop_recording
expect "what was asked" "601#0201000000000000" "$(recorded_frames | grep '^60' | xargs)"
