# Here the kernel has vcan, so in_vcan needs no machine: it runs the command in a network of its own.
cansend vcan0 100#01
ip link set vcan0 down
output=$(STRAINFINGER_VCAN_TIMEOUT_s=10 "$tests/in_vcan" ip -br link show vcan0)
[[ $output == vcan0*UP* ]] || fail "no vcan0 of its own: '$output'"
status=0
"$tests/in_vcan" bash -c 'exit 9' || status=$?
expect "exit status" 9 $status
