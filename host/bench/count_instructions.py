#!/usr/bin/env python3
"""count_instructions.py OUT.json CORE=IMAGE.elf...: instructions a fit, exact, on emulated processors.

Writes {core: {method: {level: [median, 95 % are below, most]}}}, levels by their place in make_bundle.hpp's
kLevelSettings. Without the emulator or an image it says so, writes {} and succeeds: the benchmark then goes without
these columns.
"""
import collections
import json
import os
import shutil
import statistics
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests/emulated"))
import emulator  # noqa: E402

COUNTING = ["-icount", "shift=10,sleep=off"]
TIMEOUT_S = 1800


def summary(counts):
    counts = sorted(counts)
    return [statistics.median(counts), counts[len(counts) * 95 // 100], counts[-1]]


def counted(elf):
    counts = collections.defaultdict(lambda: collections.defaultdict(list))
    for line in emulator.output_of(elf, options=COUNTING, timeout_s=TIMEOUT_S).splitlines():
        method, level, instructions = line.split(";")
        counts[method][level].append(int(instructions))
    return {method: {level: summary(numbers) for level, numbers in levels.items()} for method, levels in counts.items()}


def main():
    images = dict(argument.split("=", 1) for argument in sys.argv[2:])
    missing = [] if shutil.which(emulator.QEMU) else [f"{emulator.QEMU} is not installed"]
    missing += [f"{elf} was not built: arm-none-eabi-g++ is missing" for elf in images.values() if not os.path.exists(elf)]
    if missing:
        print("instructions are not counted:", "; ".join(missing), "(cmake/setup.sh installs both)", file=sys.stderr)
        images = {}
    with ThreadPoolExecutor(2) as pool:
        counts = dict(zip(images, pool.map(counted, images.values())))
    Path(sys.argv[1]).write_text(json.dumps(counts, indent=1))


if __name__ == "__main__":
    main()
