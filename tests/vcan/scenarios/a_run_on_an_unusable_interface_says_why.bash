# expect_refusal INTERFACE TEXT...: exit status 3, what is wrong and what helps
expect_refusal() {
  local status=0 text
  strainfinger run --can "$1" --duration 1 2>"$TMPDIR/message" || status=$?
  expect "exit status for $1" 3 $status
  shift
  for text in "$@"; do grep -qF "$text" "$TMPDIR/message" || fail "'$text' is not in: $(cat "$TMPDIR/message")"; done
}
ip link set vcan0 down
expect_refusal vcan0 'CAN interface vcan0 is down' 'sudo ip link set vcan0 up'
expect_refusal lo 'lo is not a CAN interface'
