"""A finger that slide.toml touches: what its emulated board is told, and what it must then say."""
import csv
import io
import itertools
import subprocess
from pathlib import Path
from typing import NamedTuple

SLIDE = Path(__file__).with_name("slide.toml")
SLIDE_S = 2.8
# Against the truth, where decode reports no doubt: four reported standard deviations, one contact in 16,000, beside what
# frames are rounded to; and the finger moves on by 0.3 degrees while a sample set is fitted.
SIGMAS = 4.5
# Weaker touches are felt only where noise lifts them over the gate, so that theirs is not the noise of the others.
WEAKEST_N = 0.02
ANGLE_ROUNDING_DEG, FORCE_ROUNDING_N = 0.05, 0.002
TOUCH_FRAMES = ("CONTACT", "FORCE", "PATCH", "CONTACT2", "FORCE2")


class Expected(NamedTuple):
    frame: str  # as candump -L has it
    time_s: float
    truth: dict  # by decode's columns; empty without one contact

    @classmethod
    def of(cls, line):
        frame, time_s, *numbers = line.split(",")
        truth = dict(zip(("angle_deg", "normal_n", "tangential_n"), map(float, numbers))) if all(numbers) else {}
        return cls(frame, float(time_s), truth)


class TouchedFinger:
    """Some slides, one after the other. Those already asked for are over: the next one goes on from there."""

    def __init__(self, touch_world, config, tables, slides):
        base = Path(config).with_suffix("")
        records, expected = base.with_suffix(".records"), base.with_suffix(".expected")
        subprocess.run([touch_world, config, SLIDE, str(slides * SLIDE_S), tables, records, expected], check=True)
        self.records = split_records(records.read_bytes())
        self.expected = [Expected.of(line) for line in expected.read_text().splitlines()]
        self.period_s = slides * SLIDE_S / len(self.records)
        self.slide = 0

    def next_slide(self):
        """(records, what must be heard of them)"""
        begin_s, end_s = self.slide * SLIDE_S, (self.slide + 1) * SLIDE_S
        self.slide += 1
        at = lambda time_s: round(time_s / self.period_s)
        return (self.records[at(begin_s):at(end_s)],
                [line for line in self.expected if at(begin_s) < at(line.time_s) <= at(end_s)])


def split_records(data):
    """Kind, size, payload: firmware/board/mps2/world_record.hpp."""
    records, begin = [], 0
    while begin < len(data):
        end = begin + 2 + data[begin + 1]
        records.append(data[begin:end])
        begin = end
    return records


def touch_frames(frames):
    """CONTACT, CONTACT2, FORCE, FORCE2 and PATCH, of whichever node."""
    return [frame for frame in frames if int(frame[:3], 16) & 0x7C0 in (0x180, 0x200, 0x280, 0x300, 0x380)]


def check_arrived(test, frames, expected):
    """Each once, in order. (assertEqual would compare thousands of frames with each other, for minutes.)"""
    pairs = itertools.zip_longest(touch_frames(frames), (line.frame for line in expected))
    for number, (heard, computed) in enumerate(pairs):
        if heard != computed:
            test.fail(f"frame {number} of {len(expected)}: heard {heard}, computed here {computed}")


def decoded(program, log):
    """(rows of the frames of touches, what it says of losses) of a candump log."""
    done = subprocess.run([program, "decode"], input=log, capture_output=True, text=True, check=True)
    rows = csv.DictReader(io.StringIO(done.stdout))
    return [row for row in rows if row["frame"] in TOUCH_FRAMES], done.stderr


def check_truth(test, rows, expected):
    """Every row that is sure of itself is right, and nine in ten are."""
    for frame, column, rounding in (("CONTACT", "angle_deg", ANGLE_ROUNDING_DEG), ("FORCE", "normal_n", FORCE_ROUNDING_N),
                                    ("FORCE", "tangential_n", FORCE_ROUNDING_N)):
        errors = list(errors_of(rows, expected, frame, column))
        test.assertGreater(len(errors), 0.9 * sum(row["frame"] == frame for row in rows), column)
        test.assertLessEqual(max(error - SIGMAS * sigma for error, sigma in errors), rounding, column)


def errors_of(rows, expected, frame, column):
    """(error, sigma) of each row that is sure of itself."""
    for row, line in zip(rows, expected):
        is_sure = row["sigma_" + column] and "uncertain" not in row["flags"]
        if row["frame"] != frame or not is_sure or line.truth.get("normal_n", 0) < WEAKEST_N:
            continue
        error = float(row[column]) - line.truth[column]
        if column == "angle_deg":
            error = (error + 180) % 360 - 180
        yield abs(error), float(row["sigma_" + column])
