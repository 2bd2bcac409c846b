#!/usr/bin/env python3
"""timer_test.py FINGER.elf: an emulated finger whose time is its board's timer, and not the number of sample sets."""
import sys
import time
import unittest

import emulator

MIDDLE = [0x8000] * 16
HEARTBEAT = b"t7018"
SECONDS, HEARTBEATS_PER_S = 4, 10
SETS_PER_S = 50  # too few for two heartbeats, were time their number


class Timer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with emulator.Board(ELF, arguments=["time=timer"]) as board:
            board.wait_ready()
            board.bus.sendall(b"O\r")
            begin = time.monotonic()
            while (passed_s := time.monotonic() - begin) < SECONDS:
                board.samples(MIDDLE)
                time.sleep(1 / SETS_PER_S)
            cls.passed_s, cls.heard, cls.console = passed_s, bytes(board.heard), board.console()

    def test_heartbeats_come_by_the_clock(self):
        """A machine that is late may lose some, but has none too many."""
        due = self.passed_s * HEARTBEATS_PER_S
        self.assertLess(self.heard.count(HEARTBEAT), due + 3)
        self.assertGreater(self.heard.count(HEARTBEAT), due / 3)

    def test_the_uptime_is_that_of_the_clock(self):
        last = bytes.fromhex(self.heard.split(HEARTBEAT)[-1][:16].decode())
        self.assertAlmostEqual(int.from_bytes(last[3:5], "little"), self.passed_s, delta=1.5)

    def test_it_has_not_restarted(self):
        self.assertEqual(self.console.count("strainfinger on mps2"), 1)


if __name__ == "__main__":
    ELF = sys.argv[1]
    emulator.require(ELF)
    unittest.main(argv=sys.argv[:1], verbosity=2)
