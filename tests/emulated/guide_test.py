#!/usr/bin/env python3
"""guide_test.py FIRMWARE finger.txt tables.bin strainfinger: what the pages of that folder say was captured comes out today."""
import re
import subprocess
import sys
import unittest
from pathlib import Path

import emulator

emulator.require(sys.argv[2])
FIRMWARE = Path(sys.argv[1])
GUIDE = "".join((FIRMWARE / page).read_text() for page in ("bring_up.md", "settings_and_tables.md"))
SIZES = Path(sys.argv[2])
TABLES, STRAINFINGER = sys.argv[3:5]


def printed(*arguments, text=None):
    done = subprocess.run([STRAINFINGER, *arguments], input=text, capture_output=True, text=True, check=True)
    return done.stdout + done.stderr


HEARTBEATS = re.findall(r"\((\S+)\)  can0  701   \[8\]  ((?:[0-9A-F]{2} ?){8})", GUIDE)


class Guide(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.crc = int(re.search(r"CRC-32 ([0-9A-F]{8})", printed("tables", "verify", TABLES))[1], 16)

    def check_captured(self, lines, pattern):
        """The pages' lines of this pattern are these and no others."""
        self.assertEqual(lines, re.findall(pattern, GUIDE, re.MULTILINE), "paste into the page:\n" + "\n".join(lines))

    def test_the_images_size(self):
        self.check_captured([f"    {SIZES.stem}: {SIZES.read_text().strip()} bytes"], rf"^    {SIZES.stem}: .*")

    def test_the_largest_image(self):
        """By its flash, RAM and stack, as the boards' page has them in KiB."""
        sizes = [[int(size) for size in re.findall(r"\w+ (\d+) of", image.read_text())]
                 for image in SIZES.parents[1].glob("*/*.txt") if "flash" in image.read_text()]
        largest = [f"{max(size) / 1024:.1f} KiB" for size in zip(*sizes, strict=True)]
        page = (FIRMWARE / "board/README.md").read_text()
        self.assertEqual(largest, re.findall(r"^\| (?:flash|RAM|worst-case stack).*\| ([\d.]+ KiB) \|$", page, re.MULTILINE))

    def test_the_default_tables(self):
        said = printed("tables", "-o", "/dev/null").splitlines()
        self.assertIn(f"CRC-32 {self.crc:08X}", said[0])
        self.check_captured([f"    {line}" for line in said], r"^    tables: .*")

    def test_no_page_tells_another_number_of_the_tables(self):
        for page in FIRMWARE.glob("board/**/*.md"):
            for told in re.findall(r"CRC-32 ([0-9A-F]{8})|erased again: ([0-9A-F]{2})", page.read_text()):
                self.assertTrue(f"{self.crc:08X}".endswith("".join(told)), f"{page}: {''.join(told)} is now {self.crc:08X}")

    def test_heartbeats_have_the_tables_number(self):
        beats = [bytes.fromhex(beat) for _, beat in HEARTBEATS]
        self.assertEqual(2, len(beats))
        self.assertEqual({self.crc & 0xFF}, {beat[7] for beat in beats}, f"make it {self.crc & 0xFF:02X}")

    def test_a_frame_decoded(self):
        time, frame = HEARTBEATS[1]
        line = f"({float(time):.6f}) can0 701#{frame.replace(' ', '')}\n"
        self.check_captured([f"    {printed('decode', '--json', text=line).splitlines()[0]}"], r"^    \{.*")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
