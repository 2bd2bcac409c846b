#!/usr/bin/env python3
"""calibrate_test.py PROGRAM: a guided session with a simulated finger as built, in a pipe and in a terminal. What presses it is a
scene; the truth that the finger prints is the scale and the mark."""
import contextlib
import csv
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest

from fingers import Bench
from terminal import SHELL, Terminal

PROGRAM = os.path.abspath(sys.argv.pop(1))

FINGER = """schema = 1
[as_built]
seed = 7
angle_deg = 0.5
depth_m = 5e-5
gain = 0.03
core_radius_m = 6e-5
poisson_ratio = -0.012
"""
CORE_M = 8.9e-3 + 6e-5  # the default drawing's, and what it is off

QUIET_S, ROLLED_S, HELD_S, HOLDS = 8, 60, 5, 10


def touch(start_s, end_s, angle_deg, normal, tangential, width_m):
    return (f"[[touch]]\nstart_s = {start_s}\nend_s = {end_s}\nangle_deg = {angle_deg}\nnormal_n_per_m = {normal}\n"
            f"tangential_n_per_m = {tangential}\nwidth_m = {width_m}\nprofile = \"hertz\"\n")


def scene():
    """Left alone, rolled all around with various loads, then pressed at one place after the other; over and over again."""
    draws = random.Random(3)
    loads = [draws.uniform(6, 36) for _ in range(ROLLED_S)]
    rubs = [load * draws.uniform(-0.6, 0.6) for load in loads]
    widths = [draws.uniform(0.5e-3, 4e-3) for _ in range(ROLLED_S // 4)]
    text = touch(QUIET_S, QUIET_S + ROLLED_S, [0, 50 * ROLLED_S], loads, rubs, widths)
    start_s = QUIET_S + ROLLED_S + 1
    for hold in range(HOLDS):
        load = [[0, 0], [0.5, 20 + 2 * hold], [HELD_S - 0.5, 20 + 2 * hold], [HELD_S, 0]]
        text += touch(start_s, start_s + HELD_S, 20 + 47 * hold, load, 0, 1.5e-3)
        start_s += HELD_S + 1
    return f"schema = 1\nrepeat_s = {start_s}\n" + text


class Follower(threading.Thread):
    """Reads the lines of a stream as they come."""

    def __init__(self, stream):
        super().__init__(daemon=True)
        self.stream, self.lines = stream, []
        self.start()

    def run(self):
        for line in self.stream:
            self.lines.append(line.rstrip("\n"))

    @property
    def last(self):
        return self.lines[-1] if self.lines else ""


class Truth(Follower):
    """What touches the finger, as the finger itself prints it."""

    def held(self):
        """(angle, normal) of a touch that has stayed as it is for half a second."""
        touches = [re.match(r" *[0-9.]+ \| +([0-9.]+) +([0-9.]+) ", line) for line in self.lines[-3:]]
        said = [(float(m.group(1)), float(m.group(2))) for m in touches if m]
        return said[-1] if len(said) == 3 and len(set(said)) == 1 else None


class Finger:
    def __init__(self, bench, scenario):
        self.config = bench.folder / "finger.toml"
        self.config.write_text(FINGER)
        touches = bench.folder / "scene.toml"
        touches.write_text(scenario)
        self.process = bench.start("run", "-c", str(self.config), "--can", bench.bus, "--scenario", str(touches), "--truth",
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.truth = Truth(self.process.stderr)
        bench.until(lambda: "|" in self.truth.last and "nothing" in self.truth.last, 60)


class Session:
    """`calibrate --can` in pipes."""

    def __init__(self, bench, finger, output, *options):
        self.process = bench.start("calibrate", "--can", bench.bus, "-c", str(finger.config), "-o", str(output), *options,
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.said = Follower(self.process.stderr)
        self.printed = Follower(self.process.stdout)

    def say(self, text):
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def states(self):
        return [line for line in self.said.lines if " | " in line]

    def rows(self):
        """So many there were in the last line."""
        found = re.search(r"  (\d+) rows: ", self.states()[-1]) if self.states() else None
        return int(found.group(1)) if found else 0

    def next(self):
        return self.states()[-1].rpartition(" | ")[2] if self.states() else ""

    def ended(self, longest_s):
        status = self.process.wait(longest_s)
        self.said.join(10)
        self.printed.join(10)
        return status


def table(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def swap_gauges(strains):
    """3 and 8."""
    rows = [line.split(",") for line in strains.read_text().splitlines()]
    for row in rows[1:]:
        row[4], row[9] = row[9], row[4]  # time_s is first
    strains.write_text("".join(",".join(row) + "\n" for row in rows))


def summary_of_run(config, bench, folder):
    """What the firmware's answers are off, in the scene."""
    run = subprocess.run([PROGRAM, "run", "-c", str(config), "--scenario", str(bench.folder / "scene.toml"), "--duration", "68", "--json"],
                         stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=True, cwd=folder)
    return json.loads(run.stderr.splitlines()[-1])


class Guided(unittest.TestCase):
    def test_a_finger_is_calibrated_as_it_says(self):
        with Bench(PROGRAM) as bench:
            finger = Finger(bench, scene())
            output = bench.folder / "cal.toml"
            strains, touches = bench.folder / "cal.strains.csv", bench.folder / "cal.touches.csv"
            log = bench.folder / "bus.log"
            recorder = bench.start("record", "--can", bench.bus, "-o", str(log), stderr=subprocess.DEVNULL)

            session = Session(bench, finger, output)
            bench.until(lambda: session.next().startswith("Leave it alone for 5 s"))
            bench.until(lambda: session.next().startswith("Roll it along a table edge"), 60)
            bench.until(lambda: session.rows() >= 100, 120)
            session.process.kill()  # SIGKILL: nothing can be tidied up
            session.process.wait()
            kept = len(table(strains))
            self.assertGreaterEqual(kept, 100)
            self.assertIn(kept - len(table(touches)), (0, 1))

            session = Session(bench, finger, output)
            bench.until(lambda: session.rows() >= kept)
            loads, angles, told = [], [], False
            for _ in range(4 * 700):  # as a user does what it asks for, for at most 700 s: a press tells one thing
                time.sleep(0.25)
                if session.process.poll() is not None:  # nothing is left to gain already
                    break
                held = finger.truth.held()
                if not held:
                    told = False
                elif not told and session.next().startswith("Press it with a known weight"):
                    session.say(f"load {held[1]} N/m")
                    loads.append(held[1])
                    told = True
                elif not told and session.next().startswith("Press it at a mark"):
                    session.say(f"angle {held[0]}")
                    angles.append(held[0])
                    told = True
                known = re.search(r"unit of force \+-([0-9.]+) %", session.states()[-1])
                if known and float(known.group(1)) <= 1 and session.next().startswith(("Roll", "Nothing")):
                    break
            else:
                self.fail(f"loads {loads}, angles {angles}: {session.said.lines[-3:]}")
            self.assertGreaterEqual(len(loads), 2)
            self.assertGreaterEqual(len(angles), 2)
            self.assertRegex(session.states()[-1], r"errors to come: place 0\.\d+ mm \(drawn 0\.\d+, noise alone 0\.0\d\d\)")
            self.assertIn("; 0 lost", session.states()[-1])
            with contextlib.suppress(BrokenPipeError):
                session.say("quit")
            self.assertEqual(0, session.ended(200), session.said.lines[-3:])
            recorder.send_signal(signal.SIGINT)
            recorder.wait(20)

            # the rows are what calibrate reads, and the session's own result comes of them
            again = subprocess.run([PROGRAM, "calibrate", "-c", str(finger.config), "--strains", str(strains), "--touches", str(touches)],
                                   capture_output=True, text=True, check=True)
            self.assertEqual(again.stdout.splitlines(), session.printed.lines)
            self.assertEqual(len(table(strains)), len(table(touches)))
            self.assertEqual(10, sum(row["normal_n_per_m"] == "0" for row in table(touches)))

            core_m = float(re.search(r"core_radius_m = ([0-9.e-]+)", output.read_text()).group(1))
            self.assertAlmostEqual(CORE_M, core_m, delta=1.5e-5)
            before, after = (summary_of_run(config, bench, bench.folder)["arc_rms_m"] for config in (finger.config, output))
            print(f"firmware's place: {1e6 * before:.0f} um RMS as drawn, {1e6 * after:.0f} um calibrated", file=sys.stderr)
            self.assertLess(after, before / 2)

            # the recording of it all, thinned
            thinned = subprocess.run([PROGRAM, "calibrate", "-c", str(finger.config), "--strains", str(log), "--summary", "--json"],
                                     capture_output=True, text=True)
            self.assertEqual(0, thinned.returncode, thinned.stderr)
            self.assertRegex(thinned.stderr, r"^calibrate: \d+ of \d+ sample sets are touches that differ")
            self.assertAlmostEqual(CORE_M, json.loads(thinned.stdout)["core_radius_m"], delta=3e-5)


class OfSimulatedRows(unittest.TestCase):
    """Sessions that go on with rows that were simulated beforehand."""
    SCENE = "schema = 1\n"

    @classmethod
    def setUpClass(cls):
        cls.bench = Bench(PROGRAM)
        cls.addClassCleanup(cls.bench.close)
        cls.finger = Finger(cls.bench, cls.SCENE)
        scenario = cls.bench.folder / "touches.toml"
        scenario.write_text(scene())
        cls.strains, cls.touches = cls.bench.folder / "all.strains.csv", cls.bench.folder / "all.touches.csv"
        subprocess.run([PROGRAM, "run", "-c", str(cls.finger.config), "--scenario", str(scenario), "--duration", "100", "--rows-hz", "7",
                        "--strains", str(cls.strains), "--touches", str(cls.touches)], stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL, check=True)

    def session_of(self, rows):
        """The output of a session that has so many of the rows."""
        folder = self.bench.new_folder()
        for source, name in ((self.strains, "cal.strains.csv"), (self.touches, "cal.touches.csv")):
            lines = source.read_text().splitlines(keepends=True)
            (folder / name).write_text("".join(lines[:1 + rows]))
        return folder / "cal.toml"

    def command(self, output):
        return f"{PROGRAM} calibrate --can {self.bench.bus} -c {self.finger.config} -o {output}"


class Pressed(OfSimulatedRows):
    """The finger is pressed at one place all the time, but for a while at its start."""
    SCENE = "schema = 1\n" + touch(4, 3600, 67, 20, 0, 1.5e-3)

    def setUp(self):
        self.bench.until(lambda: self.finger.truth.held(), 60)

    def tare(self, *options):
        return subprocess.run([PROGRAM, "tare", "--can", self.bench.bus, "-n", "1", *options], capture_output=True, text=True)

    def test_a_session_ends_by_another_zero_but_not_by_one_that_is_refused(self):
        for options in ([], ["--rate", "10"]):
            output = self.session_of(40)
            session = Session(self.bench, self.finger, output, *options)
            self.bench.until(lambda: session.rows() >= 40)
            self.assertEqual(1, self.tare().returncode)
            time.sleep(3)
            self.assertIsNone(session.process.poll(), session.said.lines[-3:])
            self.assertEqual(0, self.tare("--force").returncode)
            self.assertEqual(1, session.ended(10))
            self.assertRegex(session.said.last, r"node 1 has taken another zero, .*; \d+ rows are kept in .*, of the old zero: start again with another -o")
            self.assertGreaterEqual(len(table(output.with_suffix(".strains.csv"))), 40)
            self.finger.process.kill()
            self.finger.process.wait()
            type(self).finger = Finger(self.bench, self.SCENE)
            self.setUp()

    def test_what_is_held_is_entered_before_it_ends(self):
        output = self.session_of(700)
        session = Session(self.bench, self.finger, output)
        self.bench.until(lambda: session.states())
        time.sleep(1)  # of readings
        session.say("hold")
        self.bench.until(lambda: any(line.endswith(": held") for line in session.said.lines))
        self.bench.until(lambda: session.next().startswith("Nothing"), 300)
        time.sleep(2)
        self.assertIsNone(session.process.poll(), session.said.lines[-3:])
        session.say("load 20 N/m")
        self.assertEqual(0, session.ended(300), session.said.lines[-3:])
        self.assertIn("calibrate: the load of 20 N/m is taken", session.said.lines)

    @unittest.skipIf(shutil.which("tmux") is None, "tmux is not installed: apt install tmux")
    def test_what_is_being_typed_is_not_cut_off_by_the_end(self):
        with Terminal(self.command(self.session_of(700)), 100, 30) as terminal:
            terminal.wait_for(r"q end")
            time.sleep(1)  # of readings
            terminal.press("l", "2")
            terminal.wait_for(r"Return or Esc: 2_")
            terminal.wait_for(r"Nothing is left to gain", 120)
            time.sleep(1)
            terminal.press("0")
            terminal.wait_for(r"Return or Esc: 20_")
            terminal.press("Escape")
            terminal.wait_for(r"ended: 0", 120)


class Resumed(OfSimulatedRows):

    def test_it_ends_when_nothing_is_left_to_gain(self):
        output = self.session_of(700)
        session = Session(self.bench, self.finger, output)
        self.assertEqual(0, session.ended(300), session.said.lines[-3:])
        self.assertRegex("\n".join(session.said.lines), r"rows are kept in \S+cal.strains.csv and \S+cal.touches.csv")
        self.assertIn("[calibration]", output.read_text())
        self.assertEqual(17, len(session.printed.lines))

    def test_with_stdin_at_its_end_it_asks_for_nothing_that_is_to_be_entered(self):
        output = self.session_of(700)
        touches = output.with_suffix(".touches.csv")
        lines = touches.read_text().splitlines()
        touches.write_text("\n".join(lines[:1] + [line if re.search(r"(?<![0-9.])0,0$", line) else ",," for line in lines[1:]]) + "\n")
        run = subprocess.run(self.command(output).split(), capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=300)
        said = run.stderr.splitlines()
        self.assertEqual(0, run.returncode, said[-3:])
        self.assertIn("calibrate: stdin is at its end: skipped: without known loads the unit of force is the drawing's", said)
        self.assertIn("calibrate: stdin is at its end: skipped: without known directions a ring that is turned or reversed is not noticed", said)
        self.assertIn("[calibration]", output.read_text())

    def test_with_stdin_at_its_end_a_finger_that_is_to_be_mended_ends_it(self):
        output = self.session_of(400)
        swap_gauges(output.with_suffix(".strains.csv"))
        run = subprocess.run(self.command(output).split(), capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120)
        self.assertEqual(1, run.returncode)
        self.assertRegex(run.stderr.splitlines()[-1], r"^strainfinger: .*3.* 8.*rows are kept in .*: start again with another -o")
        self.assertFalse(output.exists())

    def test_a_last_line_without_its_end_is_obeyed(self):
        run = subprocess.run(self.command(self.session_of(40)).split(), capture_output=True, text=True, input="quit", timeout=60)
        self.assertEqual(1, run.returncode)
        self.assertIn("too few", run.stderr)

    def test_too_few_rows_at_the_end_are_told_and_kept(self):
        output = self.session_of(0)
        session = Session(self.bench, self.finger, output)
        self.bench.until(lambda: session.next().startswith("Roll it"), 60)
        session.say("load 20\nbogus\nundo")  # each has its answer
        for answer in ("say the unit", "say load, angle", "no load and no angle was entered yet"):
            self.bench.until(lambda: any(answer in line for line in session.said.lines))
        session.say("quit")
        self.assertEqual(1, session.ended(60))
        self.assertRegex(session.said.last, r"too few.*10 rows are kept in .*: the same command goes on with them")
        self.assertFalse(output.exists())

    def test_what_was_mistyped_is_taken_back_in_the_file(self):
        output = self.session_of(40)
        touches = output.with_suffix(".touches.csv")
        before = touches.read_text().splitlines()
        session = Session(self.bench, self.finger, output)
        self.bench.until(lambda: session.said.lines)
        session.say("undo")
        self.bench.until(lambda: any("of an earlier session, is taken back" in line for line in session.said.lines))
        session.say("quit")
        self.assertEqual(1, session.ended(60))
        after = touches.read_text().splitlines()
        changed = [new for old, new in zip(before, after) if [float(x) for x in old.split(",") if x and x[0] not in "ant"]
                   != [float(x) for x in new.split(",") if x and x[0] not in "ant"]]
        self.assertEqual([",,"], changed)

    def test_what_is_quit_before_any_row_is_not_said_to_be_fitted(self):
        output = self.bench.new_folder() / "none.toml"
        session = Session(self.bench, self.finger, output)
        self.bench.until(lambda: session.said.lines)
        session.say("quit")
        self.assertEqual(1, session.ended(60))
        self.assertIn("there is nothing to fit; no rows were collected", session.said.last)
        self.assertFalse([line for line in session.said.lines if "fitting" in line])

    def test_gauges_that_are_wired_wrongly_are_named(self):
        output = self.session_of(400)
        swap_gauges(output.with_suffix(".strains.csv"))
        session = Session(self.bench, self.finger, output)
        self.bench.until(lambda: "no fit yet: " in session.said.last, 60)
        self.assertRegex(session.said.last, r"no fit yet: .*3.* 8.* \| Stop: gauges or wires must be mended first")
        session.say("quit")
        self.assertEqual(1, session.ended(60))
        self.assertRegex(session.said.last, r"^strainfinger: .*3.* 8.*rows are kept in .*: start again with another -o")
        self.assertFalse(output.exists())

    def test_a_page_that_cannot_be_written_loses_neither_config_nor_rows(self):
        output = self.session_of(250)
        folder = output.parent / "none"
        folder.mkdir()
        session = Session(self.bench, self.finger, output, "--page", str(folder / "page.html"))
        self.bench.until(lambda: session.rows() >= 250)
        folder.rmdir()
        session.say("quit")
        self.assertEqual(1, session.ended(120))
        self.assertRegex(session.said.last, r"cannot write \S+none/page.html: .*; \d\d\d rows are kept in ")
        self.assertIn("[calibration]", output.read_text())
        self.assertEqual(17, len(session.printed.lines))

    def test_a_page_for_which_there_is_no_folder_is_refused_at_once(self):
        output = self.session_of(40)
        session = Session(self.bench, self.finger, output, "--page", str(output.parent / "none" / "page.html"))
        self.assertEqual(1, session.ended(60))
        self.assertRegex(session.said.last, r"--page \S+none/page.html: there is no folder \S+none; make it")
        self.assertFalse(output.exists())

    def test_a_zero_that_is_what_it_was_does_not_end_it(self):
        output = self.session_of(40)
        session = Session(self.bench, self.finger, output)
        self.bench.until(lambda: session.rows() >= 40)
        self.bench.until(lambda: session.states())
        tare = [PROGRAM, "tare", "--can", self.bench.bus, "-n", "1"]
        subprocess.run(tare, check=True, capture_output=True)
        time.sleep(3)
        self.assertIsNone(session.process.poll(), session.said.lines[-3:])
        session.say("quit")
        self.assertEqual(1, session.ended(60))
        self.assertIn("too few", session.said.last)

    def test_control_c_ends_it_with_130_and_nothing_is_lost(self):
        output = self.session_of(40)
        session = Session(self.bench, self.finger, output)
        self.bench.until(lambda: session.rows() >= 40)
        session.process.send_signal(signal.SIGINT)
        self.assertEqual(130, session.ended(60))
        self.assertIn("rows are kept in", session.said.last)
        self.assertGreaterEqual(len(table(output.with_suffix(".strains.csv"))), 40)

    def test_a_config_that_is_not_its_own_is_not_written_over(self):
        output = self.bench.new_folder() / "precious.toml"
        output.write_text("schema = 1\n")
        run = subprocess.run(self.command(output).split(), capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(1, run.returncode)
        self.assertIn("precious.toml: there is such a file already", run.stderr)
        self.assertEqual("schema = 1\n", output.read_text())

    def test_rows_of_another_finger_are_refused_by_the_key_that_differs(self):
        output = self.session_of(40)
        output.with_suffix(".session.toml").write_text(FINGER + "[gauges]\nfull_scale_strain = 0.04\n")
        run = subprocess.run(self.command(output).split(), capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(1, run.returncode)
        self.assertIn("were collected with gauges.full_scale_strain = 0.04, and the config now has 0.03: go on with -c ", run.stderr)

    def test_a_finger_that_is_not_there_is_told(self):
        run = subprocess.run(self.command(self.session_of(0)).split() + ["-n", "9"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(4, run.returncode)
        self.assertIn("node 9: no answer", run.stderr)

    def test_what_does_not_go_together_is_refused(self):
        for arguments, named in ((["--can", self.bench.bus], "--output"), (["--can", self.bench.bus, "-o", "x", "--strains", "y"], "--strains"),
                                 (["--rate", "100"], "--can"), (["--can", self.bench.bus, "-o", "x", "--rate", "5"], "--rate")):
            run = subprocess.run([PROGRAM, "calibrate", *arguments], capture_output=True, text=True, stdin=subprocess.DEVNULL)
            self.assertEqual((2, ""), (run.returncode, run.stdout))
            self.assertIn(named, run.stderr)

    @unittest.skipIf(shutil.which("tmux") is None, "tmux is not installed: apt install tmux")
    def test_the_screen_shows_it_follows_the_window_and_takes_keys(self):
        output = self.session_of(180)  # some arcs are covered, some are not
        with Terminal(self.command(output), 100, 30) as terminal:
            screen = terminal.wait_for(r"(?s)node 1  \d+ rows: .*sigma: gain.*\n +15 +337\.5 .*q end")
            self.assertRegex(screen, r"(?m)^Roll it along a table edge ")
            self.assertIn("█", screen)
            self.assertIn("\x1b[", terminal.screen(escapes=True))
            terminal.resize(100, 12)
            terminal.wait_for(r"\d+ more gauges: make the window higher")
            terminal.resize(100, 30)
            terminal.wait_for(r"\n +15 +337\.5 ")
            terminal.press("l")
            screen = terminal.wait_for(r"nothing presses the finger")
            self.assertNotIn("load, with its unit", screen)
            terminal.press("t")
            screen = terminal.wait_for(r"not zeroed: the rows that were collected have the old zero")
            self.assertNotIn("does nothing touch it?", screen)
            terminal.press("C-c")
            terminal.wait_for(r"(?s)calibrate: interrupted; \d+ rows are.*ended: 130", 60)

    @unittest.skipIf(shutil.which("tmux") is None, "tmux is not installed: apt install tmux")
    def test_without_an_option_it_says_that_it_reads_the_terminal(self):
        with Terminal(f"{PROGRAM} calibrate -c {self.finger.config} -o {self.bench.folder / 'typed.toml'}") as terminal:
            terminal.wait_for(r"reading rows of strains from the terminal, up to Ctrl-D; --strains FILE reads")
            terminal.press("C-d")
            terminal.wait_for(r"(?s)there are no rows of strains.*ended: 1")

    @unittest.skipIf(shutil.which("tmux") is None, "tmux is not installed: apt install tmux")
    def test_no_color_and_ascii(self):
        with Terminal("NO_COLOR=1 " + self.command(self.session_of(40)), 100, 30, locale="C") as terminal:
            screen = terminal.wait_for(r"sigma: gain")
            self.assertTrue(screen.isascii())
            self.assertNotIn("\x1b[", terminal.screen(escapes=True))
            terminal.press("C-c")
            terminal.wait_for(r"ended: 130", 60)

    @unittest.skipIf(shutil.which("tmux") is None, "tmux is not installed: apt install tmux")
    def test_stopped_by_control_z_it_goes_on_with_fg(self):
        with Terminal(SHELL, 100, 30) as terminal:
            terminal.wait_for(r"\$")
            terminal.press(self.command(self.session_of(40)), "Enter")
            terminal.wait_for(r"q end")
            terminal.press("C-z")
            terminal.wait_for(r"Stopped")
            self.assertTrue(terminal.is_given_back())
            terminal.press("fg; echo fg $?", "Enter")
            terminal.wait_for(r"q end")
            terminal.press("s")
            terminal.wait_for(r"this cannot be skipped")
            terminal.press("C-c")
            terminal.wait_for(r"(?s)calibrate: interrupted; \d+ rows are.*fg 130", 60)
            self.assertTrue(terminal.is_given_back())

    @unittest.skipIf(shutil.which("tmux") is None, "tmux is not installed: apt install tmux")
    def test_a_new_zero_is_taken_when_the_user_agrees(self):
        with Terminal(self.command(self.session_of(0)), 100, 30) as terminal:
            terminal.wait_for(r"Leave it alone for 5 s")
            terminal.press("t", "n")
            terminal.press("t", "y")
            terminal.wait_for(r"tare: Done")
            terminal.press("q")
            terminal.wait_for(r"ended: 1", 60)


if __name__ == "__main__":
    unittest.main()
