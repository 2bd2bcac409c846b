# The recording helpers themselves: nothing is missing, nothing is added.
record
cansend vcan0 123#DEADBEEF
cansend vcan0 7FF#
stop_recording
expect "frames" "123#DEADBEEF 7FF#" "$(recorded_frames | xargs)"
