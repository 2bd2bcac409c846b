#!/usr/bin/env python3
"""commands_test.py FINGER.elf: an emulated finger is told to take its zero and to change its contact rate, over its
CAN line (SLCAN), and does what it answers. common/BUS_REQUESTS.md has the bytes."""
import sys
import time
import unittest

import emulator

MIDDLE = [0x8000] * 16
# Codes of a touch over a gauge, by the pitches between the two: `strainfinger strain --radius-m 9.4e-3 --normal-n-per-m 30
# --tangential-n-per-m 0 --contact-deg 0 --width-m 0.002 --points 16`, column err, in steps of 2 * 0.03 / 2^16.
TOUCH = (-13624, 3844, 614, 239, 113, 50, 23, 12, 8)
CONTACT, RESPONSE = "t1818", "t5818"
TARE, FORCED_TARE, TARE_OF_ANOTHER = "t60120101", "t6013020101", "t60220101"
ZERO_SETS = 64
DONE, BAD_ARGUMENT, TOUCHED, DONE_TOUCHED, NOT_KEPT = 0, 3, 4, 5, 6  # CommandStatus, common/commands.hpp

TARE_COMMAND, RATE_COMMAND, LOAD_COMMAND, RESTART_COMMAND = 1, 2, 7, 9
LOAD, RESTART, INFO = "t60120107", "t60120109", "t4818"
SOFTWARE = 3  # ResetCause, common/frames.hpp


def response(command, status):
    return bytes((2, 0x80 | command, status, 0, 0, 0, 0, 0))


def touched_at(gauge, load=1):
    return [0x8000 + round(load * TOUCH[min((i - gauge) % 16, (gauge - i) % 16)]) for i in range(16)]


class Commands(unittest.TestCase):
    def setUp(self):
        self.board = self.enterContext(emulator.Board(ELF))
        self.board.wait_ready()
        self.board.bus.sendall(b"O\r")
        self.run_for(ZERO_SETS + 1, MIDDLE)

    def lines(self):
        return self.board.heard.decode("latin1").split("\r")[:-1]

    def wait_until(self, holds, what):
        end = time.monotonic() + 30
        while not holds():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.002)

    def run_for(self, periods, *sets):
        """Sample sets in turn; returns the CAN lines they led to. The bus state that the board passes on in between
        shows that it is done with them."""
        before = len(self.lines())
        states = self.board.heard.count(b"sa")
        for period in range(periods):
            self.board.samples(sets[period % len(sets)])
        self.board.record(b"B", bytes(3))
        self.wait_until(lambda: self.board.heard.count(b"sa") > states, "the board takes no samples")
        return self.lines()[before:]

    def ask(self, request):
        """Sends a line; its acknowledgement is the finger's turn to look at it."""
        acknowledged = self.board.heard.count(b"z\r")
        self.board.bus.sendall(request.encode() + b"\r")
        self.wait_until(lambda: self.board.heard.count(b"z\r") > acknowledged, f"{request} was not taken")

    def responses(self):
        return [bytes.fromhex(line[5:]) for line in self.lines() if line.startswith(RESPONSE)]

    def answer(self, request):
        known = len(self.responses())
        self.ask(request)
        self.wait_until(lambda: len(self.responses()) > known, f"no answer to {request}")
        return self.responses()[-1]

    def contacts(self, periods, *sets):
        return [line for line in self.run_for(periods, *sets) if line.startswith(CONTACT)]

    def check_tare(self, request, codes, status):
        """It is answered when its sample sets are in, give or take the one on its way."""
        self.ask(request)
        self.run_for(ZERO_SETS - 1, codes)
        self.assertEqual([], self.responses())
        self.run_for(2, codes)
        self.assertEqual([response(TARE_COMMAND, status)], self.responses())

    def test_a_rate_holds_at_once(self):
        moving = [touched_at(3, load) for load in (0.5, 0.75, 1)]  # news at every rate
        self.assertAlmostEqual(500, len(self.contacts(1000, *moving)), delta=1)
        for rate_hz in (100, 1000, 20):
            request = f"t60140302{rate_hz & 255:02X}{rate_hz >> 8:02X}"
            self.assertEqual(response(RATE_COMMAND, DONE), self.answer(request))
            self.assertAlmostEqual(rate_hz, len(self.contacts(1000, *moving)), delta=1)

    def test_a_rate_it_cannot_have_is_refused(self):
        self.assertEqual(response(RATE_COMMAND, BAD_ARGUMENT), self.answer("t60140302E903"))

    def test_a_tare_untouched(self):
        self.check_tare(TARE, MIDDLE, DONE)
        self.assertEqual([], self.contacts(100, MIDDLE))

    def test_a_tare_is_refused_while_touched(self):
        self.run_for(1, touched_at(3))
        self.assertEqual(response(TARE_COMMAND, TOUCHED), self.answer(TARE))
        self.assertEqual(1, len(self.contacts(50, touched_at(3))), "it goes on saying that it is touched")

    def test_a_forced_tare_makes_what_is_there_the_zero(self):
        drifted = touched_at(3)
        self.run_for(1, drifted)
        self.check_tare(FORCED_TARE, drifted, DONE_TOUCHED)
        self.run_for(1, drifted)  # says that the touch is over
        self.assertEqual([], self.contacts(100, drifted))
        self.assertTrue(self.contacts(1, MIDDLE))

    def test_without_memory_for_tables_it_goes_on(self):
        self.assertEqual(response(LOAD_COMMAND, NOT_KEPT), self.answer(LOAD))
        self.assertTrue(self.contacts(1, touched_at(3)))

    def test_it_starts_anew_and_goes_on_on_the_same_line(self):
        self.assertEqual(response(RESTART_COMMAND, DONE), self.answer(RESTART))
        before = len(self.lines())
        for _ in range(50):  # its time is that of its samples
            self.board.samples(MIDDLE)
        self.board.wait_ready()
        self.assertEqual(1, len(self.contacts(ZERO_SETS + 3, MIDDLE)), "a touch of the run before has ended")
        infos = [bytes.fromhex(line[5:]) for line in self.lines()[before:] if line.startswith(INFO)]
        self.assertEqual([SOFTWARE], [info[0] for info in infos])
        self.assertTrue(self.contacts(1, touched_at(3)), "it measures again")

    def test_another_fingers_tare_is_not_its_business(self):
        self.ask(TARE_OF_ANOTHER)
        self.assertTrue(self.contacts(100, touched_at(3)))
        self.assertEqual([], self.responses())


if __name__ == "__main__":
    ELF = sys.argv.pop(1)
    emulator.require(ELF)
    unittest.main(verbosity=2)
