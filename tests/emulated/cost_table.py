#!/usr/bin/env python3
"""cost_table.py PAGE M4.elf M0PLUS.elf [--check]: what an update costs, in instructions, counted exactly.

Writes firmware/cost.md (PAGE). --check: writes nothing, fails unless the page's figures are these within 3 %, the bars hold,
a second run counts the same and the call graph's stack is what was used.
"""
import argparse
import collections
import re
import statistics
import sys
from pathlib import Path

import emulator

COUNTING = ["-icount", "shift=10,sleep=off"]
MEGAHERTZ = 170
CYCLES_PER_INSTRUCTION = 1.4  # assumed, no measurement: multiplies and most loads take 1 to 2, branches 2 to 4
OF_ANY_KIND = {"m4": 100_000, "m0plus": 12_000}  # updates

SCENES = {
    "idle": "idle: untouched",
    "drift": "gauges that drift untouched: the most expensive set of each half second",
    "drift_depths": "the same, depths known",
    "held_line": "a line load held, the codes unchanged",
    "held_line_noise": "the same with noise",
    "held_wide": "a contact of 2 mm held, the codes unchanged",
    "held_wide_noise": "the same with noise",
    "known_line": "a line load that slides by 50 um a set, width known",
    "wide": "a contact of 2 mm that slides by 50 um a set, width fitted",
    "wide_depths": "the same, each gauge's depth known by a calibration",
    "new": "a new touch anywhere: its first set",
    "new_depths": "the same, depths known",
    "search": "the sets after it in which other answers are looked for",
    "search_depths": "the same, depths known",
    "look_back": "untouched after a tap on a dead gauge, while the search goes on",
    "look_back_depths": "the same, depths known",
}
KINDS = {
    "any_faint": "faint to firm, sliding",
    "any_pair": "two contacts, any loads and places",
    "any_pair_depths": "the same, depths known",
    "any_dead": "a gauge that reads nothing, under a touch that slides",
    "any_hum": "hum up to 300 microstrain, with and without a touch",
    "any_codes": "any codes",
    "any_wild": "another touch, or two, or any codes, with every set",
}
# The most that a Cortex-M4 may take: the median of some scenes, and any update at all.
MEDIAN_BARS = {"idle": 509, "held_line": 1000, "held_wide": 1000, "known_line": 2800, "wide": 4500}
DEAREST_BAR = 100_000
# Bars that are not reached yet: the page says so. One that is reached must leave this list.
MISSED = {"known_line", "wide"}

PAGE = """# What an update costs

Instructions of a whole update, from the converter's codes to all frames in the port, counted exactly on emulated processors
(`tests/emulated/target/cost_target.cpp`: 2,000 updates a scene, a sample set a millisecond, frames as often; the default finger,
30 N/m pulled by half as much and the tables' noise where nothing else is said). This page is written by the program that counts,
`cmake --build --preset test --target cost`, and a test compares it with what it counts then.

| instructions: least, median, 95 %, most | Cortex-M4 | limit for its median | Cortex-M0+ | M4 at 170 MHz, estimated |
|--|--|--|--|--|
{scenes}

{any_m4:,} updates of what a finger may be given besides one touch ({any_m0plus:,} on the M0+), each kind from a new start:

| instructions: median, 95 %, most | Cortex-M4 | Cortex-M0+ |
|--|--|--|
{kinds}

The most expensive of all these updates took {dearest:,} instructions on the Cortex-M4, {dearest_ms:.2f} ms at an assumed {cycles} cycles an
instruction, of the millisecond between two sets at 1 kHz; no bound is proved. The limit is {bar:,}.

Neither core's floating-point unit is used, and the M0+ has no products of 64 bits and no division. Instructions are counted, cycles
are not: times take {cycles} cycles an instruction, an assumption for a Cortex-M4 that runs from flash with its accelerator on, to be
replaced by a measurement on a board.
"""


def core_of(elf):
    return "m0plus" if "m0plus" in elf else "m4"


def counted(elf):
    counts = collections.defaultdict(list)
    arguments = [str(OF_ANY_KIND[core_of(elf)])]
    for line in emulator.output_of(elf, arguments, COUNTING, timeout_s=900).splitlines():
        what, number = line.split(",")
        counts[what].append(int(number))
    return counts


def spread(numbers):
    ordered = sorted(numbers)
    return [ordered[0], int(statistics.median(ordered)), ordered[len(ordered) * 95 // 100], ordered[-1]]


def cells(numbers):
    return " ".join(f"{number:,}" for number in numbers)


def microseconds(instructions):
    return instructions * CYCLES_PER_INSTRUCTION / MEGAHERTZ


def scene_rows(m4, m0plus):
    for key, name in SCENES.items():
        median, most = (microseconds(number) for number in spread(m4[key])[1::2])
        bar = f"{MEDIAN_BARS[key]:,}" if key in MEDIAN_BARS else ""
        if key in MISSED:
            bar += ", exceeded"
        yield (f"| {name} | {cells(spread(m4[key]))} | {bar} | {cells(spread(m0plus[key]))} | "
               f"{median:.0f} us, most {most:.0f} us |")


def kind_rows(m4, m0plus):
    for key, name in KINDS.items():
        yield f"| {name} | {cells(spread(m4[key])[1:])} | {cells(spread(m0plus[key])[1:])} |"


def dearest(m4):
    return max(max(m4[key]) for key in (*SCENES, *KINDS))


def page(m4, m0plus):
    return PAGE.format(scenes="\n".join(scene_rows(m4, m0plus)), kinds="\n".join(kind_rows(m4, m0plus)),
                       any_m4=OF_ANY_KIND["m4"], any_m0plus=OF_ANY_KIND["m0plus"], dearest=dearest(m4),
                       dearest_ms=microseconds(dearest(m4)) / 1000, bar=DEAREST_BAR, cycles=CYCLES_PER_INSTRUCTION)


def numbers_in(line):
    return [float(text.replace(",", "")) for text in re.findall(r"\d[\d,]*(?:\.\d+)?", line)]


def words_in(line):
    return re.sub(r"\d[\d,]*(?:\.\d+)?", "#", line)


def page_faults(known, now):
    """Lines whose words differ, or a figure by more than 3 %."""
    if len(known.splitlines()) != len(now.splitlines()):
        yield "the page has another number of lines than the program writes"
    for old, new in zip(known.splitlines(), now.splitlines()):
        differs = any(abs(a - b) > max(0.03 * b, 1) for a, b in zip(numbers_in(old), numbers_in(new)))
        if words_in(old) != words_in(new) or differs:
            yield f"the page says: {old}\n    it is now: {new}"


def bar_faults(m4):
    for key, bar in MEDIAN_BARS.items():
        median = spread(m4[key])[1]
        if key in MISSED and median <= bar:
            yield f"{SCENES[key]}: its bar holds now, take it off MISSED"
        if key not in MISSED and median > bar:
            yield f"{SCENES[key]}: {spread(m4[key])[1]:,} instructions, more than {bar:,}"
    if dearest(m4) > DEAREST_BAR:
        yield f"the dearest update takes {dearest(m4):,} instructions, more than {DEAREST_BAR:,}"


def stack_faults(elf, measured):
    """The call graph's bound, tried on a run: an image whose bound is too small or far too large is miscounted."""
    report = Path(elf).with_suffix(".txt").read_text()
    bound = int(re.search(r"stack (\d+)", report)[1])
    if not bound * 0.9 <= measured <= bound:
        yield f"{elf}: {measured} bytes of stack were used, the call graph says at most {bound}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("page", type=Path)
    parser.add_argument("images", nargs=2)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    emulator.require(*options.images)
    counts = [counted(elf) for elf in options.images]
    now = page(*counts)
    if not options.check:
        options.page.write_text(now)
        return 0
    faults = [*page_faults(options.page.read_text(), now), *bar_faults(counts[0])]
    for elf, figures in zip(options.images, counts):
        faults += stack_faults(elf, figures["stack_bytes"][0])
    if counted(options.images[0]) != counts[0]:
        faults.append(f"{options.images[0]}: a second run counts differently")
    print("\n".join(faults), file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
