# The interface goes down and comes back, is deleted and made anew: the recording goes on, and says when nothing came.
strainfinger record --can vcan0 -o "$TMPDIR/gaps.log" 2>"$TMPDIR/said" &
recorder=$!
until [ -e "$TMPDIR/gaps.toml" ]; do sleep 0.05; done

# said TEXT TIMES: so often, soon
said() {
  for _ in $(seq 50); do
    [ "$(grep -c "$1" "$TMPDIR/said" || true)" != "$2" ] || return 0
    sleep 0.1
  done
  fail "$1: $(cat "$TMPDIR/said")"
}
ip link set vcan0 down
said 'warning: 2.*Z: vcan0 is away: it is down, ' 1
ip link set vcan0 up
said 'Z: vcan0 is back' 1
ip link del vcan0
said 'vcan0 is away' 2
ip link add dev vcan0 type vcan
ip link set vcan0 up
said 'vcan0 is back' 2
cansend vcan0 123#11
sleep 0.3
kill -TERM $recorder
wait $recorder || true
expect "what was recorded" 123#11 "$(cut -d' ' -f3 "$TMPDIR/gaps.log")"
said 'vcan0 was away 2 times meanwhile' 1
expect "gaps that are over" 2 "$(grep -A2 '^..recording.gap' "$TMPDIR/gaps.toml" | grep -c '^end = 2')"
