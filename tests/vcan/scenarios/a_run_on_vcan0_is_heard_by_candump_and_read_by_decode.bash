# The finger on a bus: what it says it sent is what candump hears, CONTACT and FORCE in pairs, and decode reads it all.
record
strainfinger run --can vcan0 --duration 3
stop_recording
contacts=$(recorded_frames | grep -c '^181#')
[ "$contacts" -gt 10 ] || fail "$contacts CONTACT frames in 3 s of touch"
expect "FORCE frames" "$contacts" "$(recorded_frames | grep -c '^281#')"
[ "$(recorded_frames | grep -c '^701#')" -ge 10 ] || fail "fewer than 10 heartbeats in 3 s"
expect "rows of decode" "$(recorded_frames | wc -l)" "$(strainfinger decode <"$recording" | tail -n +2 | wc -l)"
