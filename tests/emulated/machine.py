"""The small machine of tests/vcan with emulated fingers on its serial lines: Linux's side of a bus."""
import os
import subprocess
import sys
import time
from pathlib import Path

import emulator

TIMEOUT_S, ALL_TIMEOUT_S = 60, 500  # of a step, of all of them
# Finger n is slcan<n>, and all of them are on vcan0, as on one bus: what they send is heard there, and requests that are
# sent there (600 + node) reach them.
JOIN = """
for n in $(seq {fingers}); do
  slcand -o -c -s8 -S 115200 /dev/ttyS$n slcan$n   # slower lines cost 4 ms a frame
  until [ -e /sys/class/net/slcan$n ]; do sleep 0.05; done
  ip link set slcan$n txqueuelen 1000 up
  cangw -A -s slcan$n -d vcan0 -e                  # -e: else nobody on vcan0 sees them
  cangw -A -s vcan0 -d slcan$n -e -f 600:C00007C0
done
"""
RECORD = """
candump -r 8388608 -L {interface} >$TMPDIR/recording &
echo $! >$TMPDIR/recorder
until grep -q {interface} /proc/net/can/rcvlist_all; do sleep 0.02; done
"""
# Until so many frames of touches are there, and then a little longer, for those that should not come.
STOP = """
for _ in $(seq 100); do
  [ $(grep -cE ' (1[89AB]|2[0-389AB]|3[0-389AB]).#' $TMPDIR/recording) -lt {touches} ] || break
  sleep 0.1
done
sleep 0.3
kill $(cat $TMPDIR/recorder)
cat $TMPDIR/recording
"""


class Machine:
    def __init__(self, in_vcan, job, boards):
        self.job, self.steps = Path(job), 0
        environment = {**os.environ, "IN_VCAN_JOB": str(job), "IN_VCAN_SERIAL": " ".join(b.bus_path for b in boards),
                       "STRAINFINGER_VCAN_TIMEOUT_s": str(ALL_TIMEOUT_S)}
        self.process = subprocess.Popen([in_vcan, "bash", str(Path(__file__).with_name("in_machine.bash"))],
                                        env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.boards = boards

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.end()

    def join(self):
        """The boards' fingers to the bus. They start once the machine has."""
        for board in self.boards:
            while not os.path.exists(board.world_path):
                self.check_alive()
                time.sleep(0.02)
            board.world = board.connected(board.world_path)
            board.wait_ready()
        self.run(JOIN.format(fingers=len(self.boards)))

    def run(self, script):
        """What it says; an exception when it fails."""
        step = self.write(script)
        status = step.with_suffix(".status")
        end = time.monotonic() + TIMEOUT_S
        while not status.exists():
            self.check_alive()
            if time.monotonic() > end:
                raise RuntimeError(f"no end of: {script}")
            time.sleep(0.02)
        said = step.with_suffix(".said").read_text()
        if status.read_text() != "0\n":
            raise RuntimeError(f"{script}: {status.read_text()}{said}")
        return said

    def write(self, script):
        self.steps += 1
        step = self.job / str(self.steps)
        part = self.job / "part"
        part.write_text(script)
        return part.rename(step)

    def check_alive(self):
        """Without a machine the test is skipped, or fails, as in_vcan says."""
        if self.process.poll() is None:
            return
        print(self.process.communicate()[0], file=sys.stderr)
        sys.exit(self.process.returncode if self.process.returncode == emulator.SKIPPED else 1)

    def record(self, interface="vcan0"):
        self.run(RECORD.format(interface=interface))

    def recorded(self, touches):
        """The log of candump -L, which must have so many frames of touches."""
        return self.run(STOP.format(touches=touches))

    def end(self):
        self.write("")
        said = self.process.communicate(timeout=TIMEOUT_S)[0]
        if self.process.returncode != 0:
            raise RuntimeError(f"in_vcan: {self.process.returncode}: {said}")
