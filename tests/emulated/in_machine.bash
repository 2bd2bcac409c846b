# Runs in the small machine of tests/vcan and does what machine.py says: runs the scripts $JOB/1, $JOB/2 .. as they
# appear, each ended by .status, its exit status; an empty one is the end.
set -euo pipefail
mkfifo "$TMPDIR/nothing"
exec 8<>"$TMPDIR/nothing"   # to wait on without a process
for ((number = 1; ; ++number)); do
  step=$JOB/$number
  until [ -e "$step" ]; do read -rt 0.05 -u 8 || true; done
  [ -s "$step" ] || exit 0
  status=0
  bash -eu -o pipefail "$step" >"$step.said" 2>&1 8<&- || status=$?
  echo $status >"$step.part"
  mv "$step.part" "$step.status"
done
