"""What the README shows as printed, against what the demo prints.

usage: readme_test.py STRAINFINGER README.md
Its lines of truth beside estimate and its frames must be among those of the demo's run; the words beside a frame are
those of what `decode` says of it.
"""
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path


def shown(pattern):
    """The README's indented lines that have `pattern` in them."""
    text = Path(README).read_text(encoding="utf-8")
    return [line.removeprefix("    ").rstrip() for line in text.splitlines() if line.startswith("    ") and pattern in line]


def in_words(frame):
    """As the README describes a frame."""
    if frame["frame"] == "CONTACT":
        return f'{frame["angle_deg"]:.2f} deg, sigma {frame["sigma_angle_deg"]:.2f} deg, quality {frame["quality_percent"]} %'
    if frame["frame"] == "FORCE":
        return f'{frame["normal_n"]:.3f} N normal, {frame["tangential_n"]:.3f} N tangential'
    contacts = "one contact" if frame["contacts"] == 1 else f'{frame["contacts"]} contacts'
    return f'{contacts}, {frame["width_m"] * 1e3:.2f} mm wide, sigma {frame["sigma_width_m"] * 1e3:.2f} mm'


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            config = Path(folder) / "calibrated.toml"
            config.write_text("schema = 1\n[gauges]\nmodel_error = 0.003\n", encoding="ascii")
            run = subprocess.run([STRAINFINGER, "run", "-c", config, "--can", "loopback", "--truth"],
                                 capture_output=True, text=True, check=True)
        cls.truth, cls.log = run.stderr.splitlines(), run.stdout.splitlines()

    def test_its_commands_are_those_of_the_program(self):
        said = subprocess.run([STRAINFINGER, "--help"], capture_output=True, text=True, check=True).stdout
        commands = set(re.findall(r"^  (\w+) {2,}", said.split("Subcommands:")[1], re.M))
        table = Path(README).read_text(encoding="utf-8").split("## Commands")[1].split("\n## ")[0]
        told = {name for row in re.findall(r"^\| (`.*?) \|", table, re.M) for name in re.findall(r"`(\w+)`", row)}
        self.assertEqual(told, commands)

    def test_the_lines_of_truth_are_those_of_the_demo(self):
        lines = shown(" | ")
        self.assertGreaterEqual(len(lines), 3)
        for line in lines:
            self.assertTrue(line.strip() in [each.strip() for each in self.truth], line)

    def test_the_frames_are_those_of_the_demo_in_words(self):
        lines = shown("loopback ")
        self.assertGreaterEqual(len(lines), 3)
        for line in lines:
            frame, words = line.split("     ", 1)
            self.assertTrue(frame in self.log, frame)
            decoded = subprocess.run([STRAINFINGER, "decode", "--json"], input=frame, capture_output=True, text=True, check=True)
            values = json.loads(decoded.stdout)
            self.assertEqual(words.strip(), f'{values["frame"]}: {in_words(values)}')


if __name__ == "__main__":
    STRAINFINGER, README = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1], verbosity=2)
