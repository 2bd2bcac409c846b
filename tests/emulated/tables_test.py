#!/usr/bin/env python3
"""tables_test.py FINGER.elf STRAINFINGER TOUCH_WORLD: an image's tables replaced by another finger's, and damaged.

As firmware/README.md says: `strainfinger tables -o`, then `arm-none-eabi-objcopy --update-section`. The finger must work
with them as the same logic does on this machine, and as truly; with one bit wrong anywhere it must refuse to.
"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import emulator
from touches import TouchedFinger, check_arrived, check_truth, decoded, touch_frames

STEEP = "[finger]\nouter_radius_m = 0.0117\nshear_modulus_pa = 120e3\n"  # thinner and stiffer rubber
TWELVE = "[gauges]\ncount = 12\n"
CRC_AT = 12
# One bit each: header, parameters, constants, angles, gains, first and last patches (common/TABLES.md).
FLIPS = {"magic": 0, "format": 4, "reserved": 6, "image_bytes": 9, "crc32": CRC_AT + 3, "core_radius_m": 16,
         "gauge_count": 128, "gate_on": 141, "cell_edge_q15": 200, "an angle": 248, "a gain": 371, "the first patch": 410,
         "a patch in the middle": 9000, "the end": 24407}
ANOTHER_FORMAT, NOT_WHOLE = 5, 6  # exit statuses of `tables verify`
RUN, FAULT = 2, 3  # FingerState
TABLES_FAULT = 1  # bit of FingerFault


class Image:
    """The finger's image, with the tables of a config."""

    def __init__(self, folder, config):
        self.elf, self.config, self.tables = folder / "an386.elf", folder / "finger.toml", folder / "tables"
        self.config.write_text("schema = 1\n" + config)
        subprocess.run([STRAINFINGER, "tables", "-c", self.config, "-o", self.tables], check=True,
                       capture_output=True)
        self.put(self.tables)

    def put(self, tables):
        emulator.with_tables(ELF, tables, self.elf)

    def damage(self, at):
        """Flips a bit of the tables."""
        data = bytearray(self.tables.read_bytes())
        data[at] ^= 1 << at % 8
        damaged = self.tables.with_suffix(".damaged")
        damaged.write_bytes(data)
        self.put(damaged)

    def verify(self):
        """Exit status of `tables verify` on what the image holds."""
        held = self.elf.with_suffix(".tables")
        subprocess.run(["arm-none-eabi-objcopy", "-O", "binary", "-j", ".tables", self.elf, held], check=True)
        done = subprocess.run([STRAINFINGER, "tables", "verify", "-c", self.config, held], capture_output=True)
        return done.returncode

    def says(self, records):
        """Its frames, as candump -L has them."""
        with emulator.Board(str(self.elf)) as board:
            board.wait_ready()
            board.bus.sendall(b"O\r")
            for record in records:
                board.world.sendall(record)
            lines = board.end()
        return [f"{line[1:4]}#{line[5:]}" for line in lines if re.fullmatch("t[0-9A-F]{3}8[0-9A-F]{16}", line)]


def faults(beat):
    return int.from_bytes(beat[1:3], "little")


class Tables(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def heartbeat(self, frames):
        return bytes.fromhex([frame for frame in frames if frame.startswith("701#")][-1][4:])

    def check_works(self, config):
        image = Image(self.folder, config)
        finger = TouchedFinger(TOUCH_WORLD, image.config, image.tables, 1)
        frames = image.says(finger.records)
        check_arrived(self, frames, finger.expected)
        rows, _ = decoded(STRAINFINGER, "".join(f"(1.000000) can0 {frame}\n" for frame in frames))
        check_truth(self, rows, finger.expected)
        beat = self.heartbeat(frames)
        self.assertEqual((beat[0] & 15, faults(beat)), (RUN, 0))
        self.assertEqual(beat[7], image.tables.read_bytes()[CRC_AT])
        self.assertEqual(image.verify(), 0)

    def test_tables_of_thinner_and_stiffer_rubber(self):
        self.check_works(STEEP)

    def test_tables_of_twelve_gauges(self):
        self.check_works(TWELVE)

    def test_one_wrong_bit_anywhere_is_refused(self):
        image = Image(self.folder, "")
        records = TouchedFinger(TOUCH_WORLD, image.config, image.tables, 1).records[:500]
        for name, at in FLIPS.items():
            with self.subTest(name):
                image.damage(at)
                frames = image.says(records)
                beat = self.heartbeat(frames)
                self.assertEqual((beat[0] & 15, faults(beat)), (FAULT, TABLES_FAULT))
                self.assertEqual(touch_frames(frames), [])
                self.assertIn("481#0100000100000000", frames)
                self.assertEqual(image.verify(), ANOTHER_FORMAT if name in ("format", "reserved") else NOT_WHOLE)


if __name__ == "__main__":
    ELF, STRAINFINGER, TOUCH_WORLD = sys.argv[1:4]
    emulator.require(ELF)
    unittest.main(argv=sys.argv[:1], verbosity=2)
