#!/usr/bin/env python3
"""recompute_test.py FINGER.elf STRAINFINGER TOUCH_WORLD: what an emulated Cortex-M4 says of touches is, bit for
bit, what this machine computes from the RAW that it sends at the sampling rate."""
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import emulator
from touches import SLIDE_S, TouchedFinger

NODE = 1
RAW_1000, TARE = b"t60140306E803\r", b"t60120101\r"
SETS_BEFORE = 80  # a zero is taken at start, from 64 sets
FRAME = re.compile(r"t([0-9A-F]{3})([0-8])([0-9A-F]*)")


class Recompute(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.folder, tables = folder, folder / "tables"
        config = folder / "finger.toml"
        config.write_text(f"schema = 1\n[gauges]\nmodel_error = 0\n[can]\nnode = {NODE}\n")
        subprocess.run([STRAINFINGER, "tables", "-c", config, "-o", tables], check=True, capture_output=True)
        image = emulator.with_tables(ELF, tables, folder / "an386.elf")
        cls.log = cls.recorded(str(image), TouchedFinger(TOUCH_WORLD, config, tables, 1).records)

    @classmethod
    def recorded(cls, image, records):
        """candump's log of a finger that is told to send RAW and to take its zero anew, and is then touched: its world
        goes on untouched until it has done so."""
        untouched = records[:SETS_BEFORE]
        with emulator.Board(image, node=NODE) as board:
            board.wait_ready()
            board.bus.sendall(b"O\r")
            cls.tell(board, untouched)
            for request in (RAW_1000, TARE):
                board.bus.sendall(request)
                cls.tell(board, untouched)
            cls.tell(board, records)
            lines = board.end()
        frames = (FRAME.fullmatch(line.lstrip("z\r")) for line in lines)
        return "".join(f"({number / 1000:017.6f}) can0 {frame[1]}#{frame[3]}\n"
                       for number, frame in enumerate(filter(None, frames)))

    @staticmethod
    def tell(board, records):
        """Sends them, and waits until the board has done with them: it says the state of its bus then."""
        states = board.heard.count(b"sa")
        board.world.sendall(b"".join(records))
        board.record(b"B", bytes(3))
        end = time.monotonic() + 200
        while board.heard.count(b"sa") == states:
            if time.monotonic() > end:
                raise RuntimeError("the board takes no samples")
            time.sleep(0.005)

    def recomputed(self, log):
        path = self.folder / "touch.log"
        path.write_text(log)
        return subprocess.run([STRAINFINGER, "replay", "--recompute", "-c", self.folder / "finger.toml", path],
                              capture_output=True, text=True, check=False)

    def test_without_the_readings_there_is_nothing_to_compare(self):
        done = self.recomputed("".join(line + "\n" for line in self.log.splitlines() if "can0 401#" not in line))
        self.assertEqual(1, done.returncode)
        self.assertIn("the recording has no readings (RAW) of node 1", done.stderr)

    def test_the_readings_give_the_frames_bit_for_bit(self):
        done = self.recomputed(self.log)
        names, values = (line.split(",") for line in done.stdout.splitlines())
        tally = dict(zip(names, map(int, values)))
        print(tally)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual((0, 0, 0), (tally["gaps"], tally["different"], tally["absent"]))
        self.assertGreater(tally["sets"], 1000 * SLIDE_S)
        touches = sum(f"can0 {function + NODE:03X}#" in line for line in self.log.splitlines()
                      for function in (0x180, 0x280, 0x380, 0x200, 0x300))
        self.assertGreater(touches, 300)
        self.assertEqual(touches, tally["compared"])

    def test_a_wrong_bit_is_found(self):
        first = self.log.rindex("can0 181#")
        digit = self.log[first + 9]
        other = f"{int(digit, 16) ^ 1:X}"
        done = self.recomputed(self.log[:first + 9] + other + self.log[first + 10:])
        self.assertEqual(6, done.returncode)
        self.assertIn("1 of ", done.stderr)


if __name__ == "__main__":
    ELF, STRAINFINGER, TOUCH_WORLD = sys.argv[1:4]
    emulator.require(ELF)
    unittest.main(argv=sys.argv[:1], verbosity=2)
