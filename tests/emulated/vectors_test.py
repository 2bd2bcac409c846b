#!/usr/bin/env python3
"""vectors_test.py finger_stm32g431.elf: its exceptions go through its own table, wherever they went when it began.

Its chip is not emulated; another with the same processor, flash and RAM at the same addresses is, whose table is at 0 after a
reset. Without the chip's clocks the image restarts at once: the machine stops there, and tells where the table was.
"""
import re
import subprocess
import sys
import time
import unittest

import emulator

ELF = sys.argv[1]
emulator.require(ELF)
VTOR = 0xE000ED08
FLASH = 0x08000000


def vector_table(*options, run_s=0.5):
    """VTOR, after the image has run so long."""
    command = ["qemu-system-arm", "-M", "netduinoplus2", "-kernel", ELF, "-display", "none", "-monitor", "stdio", *options]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as qemu:
        time.sleep(run_s)
        said, _ = qemu.communicate(f"x /1wx {VTOR:#x}\nquit\n", timeout=30)
    return int(re.search(rf"{VTOR:08x}: 0x([0-9a-f]{{8}})", said)[1], 16)


class Vectors(unittest.TestCase):
    def test_elsewhere_before_it_runs(self):
        self.assertEqual(0, vector_table("-S"))

    def test_its_own_once_it_runs(self):
        found = 0
        for run_s in (0.5, 1, 2, 4, 8):  # a busy machine takes its time to begin
            found = found or vector_table("-action", "reboot=shutdown,shutdown=pause", run_s=run_s)
        self.assertEqual(FLASH, found)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
