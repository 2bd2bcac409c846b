#!/usr/bin/env python3
"""flashing_commands_test.py GUIDE.md...: the commands that they quote for flashing are ones that Debian's programs know.

They are run without a board: a program that knows its command line gets as far as looking for one. A program that is not
installed is skipped; with an ST-Link or a bootloader attached nothing is run at all, for it would be flashed.
"""
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

SKIP = 77
NO_BOARD = {
    "openocd": "Error: open failed",
    "st-flash": "Couldn't find any ST-Link devices",
    "dfu-util": "No DFU capable USB device available",
}
GUIDE = "\n".join(pathlib.Path(path).read_text(encoding="utf-8") for path in sys.argv[1:])


def is_board_attached():
    vendors = pathlib.Path("/sys/bus/usb/devices").glob("*/idVendor")
    return any(vendor.read_text().strip() == "0483" for vendor in vendors)


def quoted(program):
    """Command lines of the guides: indented, or between backticks."""
    return [line.strip("` ") for line in re.findall(rf"^    {program} .*$|`{program} [^`]*`", GUIDE, flags=re.M)]


class Commands(unittest.TestCase):
    def check(self, program):
        commands = quoted(program)
        self.assertTrue(commands, f"the guides quote no {program}")
        if not shutil.which(program):
            self.skipTest(f"{program} is not installed")
        with tempfile.TemporaryDirectory() as folder:
            for command in commands:
                arguments = [self.existing(word, folder) for word in shlex.split(command)]
                done = subprocess.run(arguments, capture_output=True, text=True, timeout=60)
                self.assertIn(NO_BOARD[program], done.stdout + done.stderr, command)

    @staticmethod
    def existing(word, folder):
        """A file to flash need not be there."""
        if not word.endswith((".bin", ".tables", ".elf")):
            return word
        file = pathlib.Path(folder) / "image"
        file.write_bytes(bytes(4096))
        return str(file)

    def test_openocd(self):
        self.check("openocd")

    def test_st_flash(self):
        self.check("st-flash")

    def test_dfu_util(self):
        self.check("dfu-util")


if __name__ == "__main__":
    if is_board_attached():
        print("skipped: an ST device is attached, and would be flashed")
        sys.exit(SKIP)
    result = unittest.main(argv=sys.argv[:1], exit=False).result
    skipped = len(result.skipped) == result.testsRun
    sys.exit(SKIP if skipped else not result.wasSuccessful())
