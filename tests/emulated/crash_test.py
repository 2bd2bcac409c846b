#!/usr/bin/env python3
"""crash_test.py FINGER.elf [unittest arguments]: faults on an emulated board. Each must end in a safe restart, a
recorded cause, and frames that name it."""
import sys
import time
import unittest

import emulator

MIDDLE = [0x8000] * 16
HARD_FAULT, ASSERTION, STACK_OVERFLOW, HANG = 1, 2, 3, 4  # Harm, world_record.hpp
STARVED = 5  # Crash, common/frames.hpp
SOFTWARE, WATCHDOG = 3, 4  # ResetCause
INFO, HEARTBEAT = "t4818", "t7018"
RUN = 2  # FingerState


class Crash(unittest.TestCase):
    def setUp(self):
        self.board = self.enterContext(emulator.Board(ELF))
        self.board.wait_ready()
        self.board.bus.sendall(b"O\r")
        self.run_for(200)

    def run_for(self, periods):
        for _ in range(periods):
            self.board.samples(MIDDLE)

    def harm(self, kind):
        self.board.record(b"X", bytes([kind]))
        self.board.wait_ready()

    def told_afterwards(self):
        """INFO frames and heartbeats of the run after the last restart, as bytes."""
        self.run_for(200)
        lines = self.board.end()
        frames = lambda head, since: [bytes.fromhex(line[5:]) for line in lines[since:] if line.startswith(head)]
        last_start = max(i for i, line in enumerate(lines) if line.startswith(INFO))
        return frames(INFO, last_start), frames(HEARTBEAT, last_start)

    def check_told(self, crash, reset_cause, restarts, has_address):
        infos, heartbeats = self.told_afterwards()
        self.assertEqual(infos[-1][0], reset_cause | crash << 4)
        self.assertEqual(infos[-1][1], restarts)
        address = int.from_bytes(infos[-1][4:8], "little")
        self.assertEqual(address != 0, has_address)
        self.assertEqual(heartbeats[-1][0] & 15, RUN, "it measures again")
        self.assertEqual(heartbeats[-1][1] >> 5 & 1, reset_cause == WATCHDOG)
        self.assertIn(f"restarts {restarts}, crash {crash} at 0x{address:08x}", self.board.console())

    def test_a_first_start_has_nothing_to_tell(self):
        infos, heartbeats = self.told_afterwards()
        self.assertEqual(infos[0], bytes([1, 0, 0, 1, 0, 0, 0, 0]))  # power-on, no crash, version 0.1
        self.assertEqual(heartbeats[-1][0] & 15, RUN)

    def test_a_hard_fault(self):
        self.harm(HARD_FAULT)
        self.check_told(HARD_FAULT, SOFTWARE, 1, True)

    def test_a_failed_assertion(self):
        self.harm(ASSERTION)
        self.check_told(ASSERTION, SOFTWARE, 1, True)

    def test_a_stack_overflow(self):
        self.harm(STACK_OVERFLOW)
        self.check_told(STACK_OVERFLOW, SOFTWARE, 1, False)

    def test_a_hang_is_ended_by_the_watchdog(self):
        self.harm(HANG)
        self.check_told(HANG, WATCHDOG, 1, True)

    def test_a_converter_that_is_stuck_is_told_and_then_restarted(self):
        for _ in range(1000):
            self.board.record(b"T")
        self.board.wait_ready()
        self.check_told(STARVED, WATCHDOG, 1, False)
        before = [line for line in self.board.heard.decode("latin1").split("\r") if line.startswith(HEARTBEAT)]
        self.assertTrue(any(int(line[7:9], 16) & 4 for line in before), "the fault bit of the converter")

    def test_a_board_left_alone_does_not_restart(self):
        time.sleep(6.5)  # two periods of its watchdog, which the emulator counts while it is off
        self.check_told(0, 1, 0, False)

    def test_every_restart_is_counted(self):
        for kind in (ASSERTION, HARD_FAULT, STACK_OVERFLOW, ASSERTION):
            self.harm(kind)
            self.run_for(5)
        self.check_told(ASSERTION, SOFTWARE, 4, True)


if __name__ == "__main__":
    ELF = sys.argv.pop(1)
    emulator.require(ELF)
    unittest.main(verbosity=2)
