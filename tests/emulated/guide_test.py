#!/usr/bin/env python3
"""guide_test.py README.md finger.txt tables.bin strainfinger: what firmware/bring_up.md says was captured comes out today."""
import re
import subprocess
import sys
import unittest
from pathlib import Path

import emulator

emulator.require(sys.argv[2])
GUIDE = Path(sys.argv[1]).read_text()
SIZES = Path(sys.argv[2])
TABLES, STRAINFINGER = sys.argv[3:5]


def printed(*arguments, text=None):
    done = subprocess.run([STRAINFINGER, *arguments], input=text, capture_output=True, text=True, check=True)
    return done.stdout + done.stderr


class Guide(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.crc = int(re.search(r"CRC-32 ([0-9A-F]{8})", printed("tables", "verify", TABLES))[1], 16)

    def test_the_images_size(self):
        self.assertIn(f"    {SIZES.stem}: {SIZES.read_text().strip()} bytes\n", GUIDE)

    def test_the_default_tables(self):
        self.assertEqual({f"{self.crc:08X}"}, set(re.findall(r"CRC-32 ([0-9A-F]{8})", GUIDE)))

    def test_heartbeats_have_the_tables_number(self):
        heartbeats = re.findall(r"can0  701   \[8\]  ((?:[0-9A-F]{2} ?){8})", GUIDE)
        self.assertEqual(2, len(heartbeats))
        self.assertEqual({f"{self.crc & 0xFF:02X}"}, {bytes.split()[7] for bytes in heartbeats})

    def test_a_frame_decoded(self):
        time, frame = re.findall(r"\((\S+)\)  can0  701   \[8\]  ((?:[0-9A-F]{2} ?){8})", GUIDE)[1]
        line = f"({float(time):.6f}) can0 701#{frame.replace(' ', '')}\n"
        self.assertIn(printed("decode", "--json", text=line).splitlines()[0], GUIDE)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
