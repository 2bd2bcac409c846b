#!/usr/bin/env python3
"""cost_table.py [--check README] M4.elf M0PLUS.elf: what a sample set costs, in instructions, counted exactly.

Prints the table of firmware/README.md. --check: fails unless README has it, within 3 %, and unless the bars hold.
"""
import collections
import re
import statistics
import sys
from pathlib import Path

import emulator

sys.path.insert(0, str(Path(__file__).parents[2] / "cmake"))
import check_image  # noqa: E402

COUNTING = ["-icount", "shift=10,sleep=off"]
MEGAHERTZ = 170
CYCLES_PER_INSTRUCTION = 1.4  # assumed, no measurement: multiplies and most loads take 1 to 2, branches 2 to 4
ROWS = {
    "condition": "condition: codes to strains",
    "gate": "gate: is it touched?",
    "locate": "locate, all seven gauges",
    "locate_three_point": "locate, three points",
    "locate_any": "locate, all seven gauges, any load",
    "locate_three_point_any": "locate, three points, any load",
    "report": "report: quantities, errors, frames",
    "update_idle": "**update, idle**: converter to nothing to say",
    "update_sent": "**update, contact**: converter to all frames in the port",
}


def counted(elf):
    counts = collections.defaultdict(list)
    for line in emulator.output_of(elf, options=COUNTING).splitlines():
        what, number = line.split(",")
        counts[what].append(int(number))
    return counts


def spread(numbers):
    ordered = sorted(numbers)
    return [ordered[0], int(statistics.median(ordered)), ordered[len(ordered) * 95 // 100], ordered[-1]]


def table(m4, m0plus):
    yield "| instructions: least, median, 95 %, most | Cortex-M4 | Cortex-M0+ | M4 at 170 MHz, estimated |"
    yield "|--|--|--|--|"
    for key, name in ROWS.items():
        cells = [" ".join(f"{n:,}" for n in spread(counts[key])) for counts in (m4, m0plus)]
        times = [n * CYCLES_PER_INSTRUCTION / MEGAHERTZ for n in spread(m4[key])[1::2]]
        yield f"| {name} | {cells[0]} | {cells[1]} | {times[0]:.0f} us, at most {times[1]:.0f} us |"


SHARES = [500, 800, 900, 950, 990, 999, 1000]  # of 1000 firm contacts


def rare_paths(m4):
    """What most contacts don't pay."""
    yield "| Cortex-M4: so many firm contacts take at most | " + " | ".join(f"{s / 10:g} %" for s in SHARES) + " |"
    yield "|--" * (len(SHARES) + 1) + "|"
    for key in ("locate", "locate_three_point"):
        ordered = sorted(m4[key])
        most = [ordered[min(len(ordered) * share // 1000, len(ordered) - 1)] for share in SHARES]
        yield f"| {ROWS[key]}: instructions | " + " | ".join(f"{n:,}" for n in most) + " |"


def numbers_in(line):
    return [float(text.replace(",", "")) for text in re.findall(r"\d[\d,]*", line.split("|", 2)[2])]


def faults(lines, readme, images):
    for line in lines:
        known = next((row for row in readme.splitlines() if row.startswith(line.split(" | ")[0] + " ")), None)
        if not known:
            yield f"README has no row for: {line}"
        elif any(abs(a - b) > max(0.03 * b, 1) for a, b in zip(numbers_in(known), numbers_in(line))):
            yield f"README says: {known}\n   it is now: {line}"
    for elf, counts in images.items():
        part = 5 if "m4" in elf else 3  # a Cortex-M0+ has no long products, of which an idle update consists
        idle, contact = spread(counts["update_idle"]), spread(counts["update_sent"])
        if idle[2] * part > contact[0] or idle[3] * part > contact[2]:
            yield f"{elf}: idle updates take {idle}, more than 1/{part} of a contact's {contact}"
        if "m4" in elf and counted(elf) != counts:
            yield f"{elf}: a second run counts differently"
        yield from locator_faults(elf, counts)
        yield from stack_faults(elf, counts["stack_bytes"][0])
        if "m4" in elf and locator_stack(elf) > LOCATOR_STACK:
            yield f"{elf}: locate needs {locator_stack(elf)} bytes of stack, more than {LOCATOR_STACK}"


# Most that the stages may take: median, 95 %, worst of firm contacts. The locator's purpose is to stay below these.
BARS = {
    "m4": {"condition": 128, "gate": 60, "locate": [700, 900, 2000], "locate_three_point": [500]},
    "m0plus": {"locate": [2300]},
}
LOCATOR_STACK = 512  # bytes on a Cortex-M4, in either mode


def locator_faults(elf, counts):
    for stage, bar in BARS["m4" if "m4" in elf else "m0plus"].items():
        bars = bar if isinstance(bar, list) else [bar, bar, bar]
        if any(found > most for found, most in zip(spread(counts[stage])[1:], bars)):
            yield f"{elf}: {stage} takes {spread(counts[stage])[1:]}, more than {bars}"


def locator_stack(elf):
    """Deepest that either mode gets, by the image's instructions."""
    functions = check_image.disassembled(elf)
    for function in functions.values():
        function.frame = check_image.pushed(function)
    stack = check_image.Stack(functions, lambda complaint: None)
    return max(stack.of(at)[0] for at, function in functions.items() if re.search("locateBy(Seven|Three)", function.name))


def stack_faults(elf, measured):
    """The call graph's bound, tried on a run: an image whose bound is too small or far too large is miscounted."""
    report = Path(elf).with_suffix(".txt").read_text()
    bound = int(re.search(r"stack (\d+)", report)[1])
    if not bound * 0.9 <= measured <= bound:
        yield f"{elf}: {measured} bytes of stack were used, the call graph says at most {bound}"


def main():
    check = sys.argv[1] == "--check"
    images = sys.argv[3:] if check else sys.argv[1:]
    emulator.require(*images)
    counts = {elf: counted(elf) for elf in images}
    costs, shares = list(table(*counts.values())), list(rare_paths(next(iter(counts.values()))))
    print("\n".join([*costs, "", *shares]))
    for elf, figures in counts.items():
        print(f"{Path(elf).stem}: {figures['stack_bytes'][0]} bytes of stack used, {locator_stack(elf)} by locate")
    found = list(faults(costs[2:] + shares[2:], Path(sys.argv[2]).read_text(), counts)) if check else []
    print("\n".join(found), file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
