# Exit status 3, the interface and the command.
status=0
message=$(strainfinger run --can vcan7 --duration 1 2>&1) || status=$?
expect "exit status" 3 $status
expect "message" "strainfinger: no CAN interface vcan7: make it with \`sudo ip link add dev vcan7 type vcan && sudo ip link set vcan7 up\`" "$message"
