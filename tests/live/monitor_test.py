#!/usr/bin/env python3
"""monitor_test.py PROGRAM: the monitor in a terminal, by what its screen holds, and in a pipe."""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

from fingers import UNTOUCHED, Bench, bench_with_two, cpu_s
from terminal import SHELL, Terminal

if shutil.which("tmux") is None:
    print("tmux is not installed: apt install tmux")
    sys.exit(77)

PROGRAM = os.path.abspath(sys.argv.pop(1))


class Live(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = bench_with_two(cls, PROGRAM)
        cls.command = f"{PROGRAM} monitor --can {cls.bench.bus}"

    def test_the_screen_shows_every_finger(self):
        with Terminal(self.command) as terminal:
            screen = terminal.wait_for(r"(?s)node 1  run.*angle +\d.*jitter.* zero .*node 2  run.*(nothing touches it|no touch known)")
            self.assertRegex(screen, r"^udp:\d+  \d+ frames/s  load \d+\.\d %")
            self.assertRegex(screen, r"angle +\d+\.\d\d ± \d+\.\d\d deg")
            self.assertRegex(screen, r"normal +\d\.\d{3} ± (>=)?\d\.\d{3} N +[█▒│·]+ ")
            self.assertRegex(screen, r"tangential +[+-]\d\.\d{3} ± (>=)?\d\.\d{3} N")
            self.assertRegex(screen, r"\d+ contacts/s  jitter \d+\.\d ms  0 lost  zero ")
            self.assertIn("●", screen)
            self.assertIn("q quit", screen)

    def test_numbers_change(self):
        with Terminal(self.command) as terminal:
            angle = re.search(r"angle +(\d+\.\d\d)", terminal.wait_for(r"angle +\d")).group(1)
            terminal.wait_for(rf"angle +(?!{re.escape(angle)})\d")

    def test_it_follows_the_size_of_the_window(self):
        with Terminal(self.command) as terminal:
            terminal.wait_for(r"contacts/s")
            terminal.resize(110, 8)
            screen = terminal.wait_for(r"node 1  run  (faults: \w+  )?simulated  \d+\.\d\d ± .*\n  node 2")
            self.assertNotIn("contacts/s", screen)
            terminal.resize(110, 30)
            terminal.wait_for(r"contacts/s")

    def test_t_tares_the_finger_that_is_marked(self):
        with Terminal(self.command) as terminal:
            terminal.wait_for(r"(?s)▸ node 1 .*node 2")
            terminal.press("t")
            terminal.wait_for(r"node 1: tare: Refused: something touches")
            terminal.press("Down")
            terminal.wait_for(r"▸ node 2")
            terminal.press("t")
            terminal.wait_for(r"node 2: tare: Done")

    def test_the_mark_stays_with_its_finger_when_others_come(self):
        with Bench(PROGRAM) as bench:
            bench.bus = f"udp:{int(bench.bus[4:]) + 20000}"  # beside that of the other tests of this process
            bench.finger(node=3)
            bench.finger(node=5, scenario=UNTOUCHED)
            with Terminal(f"{PROGRAM} monitor --can {bench.bus}") as terminal:
                terminal.wait_for(r"(?s)▸ node 3 .*node 5")
                terminal.press("Down")
                terminal.wait_for(r"▸ node 5")
                bench.finger(node=1)
                terminal.wait_for(r"(?s)node 1 .*node 3 .*▸ node 5")
                terminal.press("t")
                terminal.wait_for(r"node 5: tare: Done")

    def test_r_records(self):
        folder = self.bench.new_folder()
        with Terminal(f"cd {folder}; {self.command}") as terminal:
            terminal.wait_for(r"r record  q quit")
            terminal.press("r")
            name = re.search(r"r stop recording (strainfinger-\d{8}-\d{6}\.log)", terminal.wait_for(r"r stop recording \S+log")).group(1)
            time.sleep(1)
            terminal.press("r")
            frames = int(re.search(r"log: (\d+) frames", terminal.wait_for(r"log: \d+ frames")).group(1))
            log = (folder / name).read_text().splitlines()
            self.assertEqual(frames, len(log))
            self.assertGreater(frames, 20)
            notes = tomllib.loads((folder / name).with_suffix(".toml").read_text())  # whoever reads TOML
            self.assertEqual((frames, 0), (notes["recording"]["frames"], notes["recording"]["missed"]))
            self.assertEqual({1, 2}, {finger["node"] for finger in notes["recording"]["finger"]})
            self.assertEqual({"0.1"}, {finger["version"] for finger in notes["recording"]["finger"]})
            for line in log:
                self.assertRegex(line, r"^\(\d{10}\.\d{6}\) udp:\d+ [0-9A-F]{3}#([0-9A-F]{2})*$")

    def test_q_ends_a_recording_too(self):
        folder = self.bench.new_folder()
        with Terminal(f"cd {folder}; {self.command}") as terminal:
            terminal.wait_for(r"r record  q quit")
            terminal.press("r")
            terminal.wait_for(r"r stop recording \S+log")
            terminal.press("q")
            name = re.search(r"monitor: (\S+)\.log: \d+ frames", terminal.wait_for(r"(?s)log: \d+ frames.*ended: 0")).group(1)
            self.assertIn("end", tomllib.loads((folder / f"{name}.toml").read_text())["recording"])

    def test_a_recording_that_cannot_be_made_is_said_to_be(self):
        with Terminal(f"cd /proc; {self.command}") as terminal:  # no file can be made there
            terminal.wait_for(r"r record")
            terminal.press("r")
            self.assertIn("contacts/s", terminal.wait_for(r"cannot make the file"))

    def test_q_ends_it_and_gives_the_terminal_back(self):
        with Terminal(self.command) as terminal:
            terminal.wait_for(r"contacts/s")
            terminal.press("q")
            screen = terminal.wait_for(r"ended: 0")
            self.assertNotIn("contacts/s", screen)
            terminal.press("x")  # echoed again
            terminal.wait_for(r"x")

    def test_control_c_ends_it_with_130(self):
        with Terminal(self.command) as terminal:
            terminal.wait_for(r"contacts/s")
            terminal.press("C-c")
            terminal.wait_for(r"ended: 130")

    def test_control_z_leaves_the_screen_as_it_is_where_no_shell_could_go_on_with_it(self):
        with Terminal(self.command) as terminal:
            terminal.wait_for(r"contacts/s")
            terminal.press("C-z")
            time.sleep(1)
            self.assertFalse(terminal.is_given_back())
            terminal.press("q")
            terminal.wait_for(r"ended: 0")

    def stopped(self, terminal):
        """In a shell, and stopped by Ctrl-Z."""
        terminal.wait_for(r"\$")
        terminal.press(f"{self.command}; echo ended: $?", "Enter")
        terminal.wait_for(r"contacts/s")
        self.assertFalse(terminal.is_given_back())
        terminal.press("C-z")
        screen = terminal.wait_for(r"Stopped")
        self.assertNotIn("contacts/s", screen)
        self.assertTrue(terminal.is_given_back())

    def test_stopped_it_gives_the_terminal_back_and_goes_on_with_fg(self):
        with Terminal(SHELL) as terminal:
            self.stopped(terminal)
            for _ in range(2):  # the first time may have changed something
                terminal.press("clear; fg; echo fg $?", "Enter")
                screen = terminal.wait_for(r"angle +\d")
                self.assertFalse(terminal.is_given_back())
                angle = re.search(r"angle +(\d+\.\d\d)", screen).group(1)
                terminal.wait_for(rf"angle +(?!{re.escape(angle)})\d")
                terminal.press("C-z")
                terminal.wait_for(r"Stopped")
                self.assertTrue(terminal.is_given_back())
            terminal.press("fg; echo fg $?", "Enter")
            terminal.wait_for(r"contacts/s")
            terminal.press("q")
            terminal.wait_for(r"fg 0")
            self.assertTrue(terminal.is_given_back())

    def test_continued_it_ends_by_control_c_and_by_sigterm(self):
        for end in ("C-c", "TERM"):
            with Terminal(SHELL) as terminal:
                self.stopped(terminal)
                terminal.press("fg; echo fg $?", "Enter")
                terminal.wait_for(r"contacts/s")
                if end == "TERM":
                    pid = subprocess.check_output(["pgrep", "-f", f"^{self.command}"], text=True).split()[0]
                    os.kill(int(pid), signal.SIGTERM)
                else:
                    terminal.press(end)
                terminal.wait_for(r"fg 130")
                self.assertTrue(terminal.is_given_back())

    def test_stopped_by_a_signal_that_nothing_withstands_it_goes_on_too(self):
        with Terminal(SHELL) as terminal:
            terminal.wait_for(r"\$")
            terminal.press(self.command, "Enter")
            terminal.wait_for(r"contacts/s")
            pid = subprocess.check_output(["pgrep", "-f", f"^{self.command}"], text=True).split()[0]
            os.kill(int(pid), signal.SIGSTOP)
            terminal.wait_for(r"Stopped")
            terminal.press("fg; echo fg $?", "Enter")
            terminal.wait_for(r"angle +\d")
            terminal.press("q")
            terminal.wait_for(r"fg 0")
            self.assertTrue(terminal.is_given_back())

    def test_colours_unless_they_are_not_wanted(self):
        with Terminal(self.command) as terminal:
            terminal.wait_for(r"contacts/s")
            self.assertIn("\x1b[36m", terminal.screen(escapes=True))
        with Terminal("NO_COLOR=1 " + self.command) as terminal:
            terminal.wait_for(r"contacts/s")
            self.assertNotIn("\x1b[", terminal.screen(escapes=True))

    def test_without_utf8_it_is_ascii(self):
        with Terminal(self.command, locale="C") as terminal:
            screen = terminal.wait_for(r"angle +\d+\.\d\d \+- \d")
            self.assertIn("@", screen)
            self.assertTrue(screen.isascii())

    def test_in_a_pipe_it_prints_lines(self):
        run = subprocess.run(["timeout", "-s", "INT", "3", *self.command.split(), "--every", "0.5"], capture_output=True, text=True)
        lines = run.stdout.splitlines()
        self.assertGreaterEqual(len(lines), 4)
        self.assertRegex(lines[-2], r"^\d+\.\d{3} s  udp:\d+ node 1  run  (angle|no touch|nothing)")
        self.assertNotIn("\x1b", run.stdout)

    def test_in_a_pipe_without_utf8_lines_are_ascii(self):
        run = subprocess.run(["timeout", "-s", "INT", "3", *self.command.split(), "--every", "0.5"], capture_output=True, env=dict(os.environ, LC_ALL="C"))
        self.assertIn(b" +- ", run.stdout)
        self.assertTrue(run.stdout.isascii())

    def test_in_a_pipe_it_prints_objects(self):
        run = subprocess.run(["timeout", "-s", "INT", "2", *self.command.split(), "--every", "0.5", "--json"], capture_output=True, text=True)
        last = json.loads(run.stdout.splitlines()[-1])
        self.assertEqual([1, 2], [finger["node"] for finger in last["fingers"]])


class Cost(unittest.TestCase):
    def test_three_fingers_cost_less_than_a_tenth_of_a_core(self):
        with Bench(PROGRAM) as bench:
            bench.chatter()
            with Terminal(f"{PROGRAM} monitor --can {bench.bus}", 120, 40) as terminal:
                terminal.wait_for(r"(?s)node 3 .*contacts/s")
                pid = int(subprocess.check_output(["pgrep", "-f", f"^{PROGRAM} monitor --can {bench.bus}"], text=True).split()[0])
                process = type("Process", (), {"pid": pid})
                before_s, began_s = cpu_s(process), time.monotonic()
                time.sleep(5)
                share = (cpu_s(process) - before_s) / (time.monotonic() - began_s)
                contacts = re.findall(r"(\d+) contacts/s .* 0 lost", terminal.screen())
                self.assertNotIn("not read in time", terminal.screen())
        print(f"monitor: {100 * share:.1f} % of a core at {contacts} contacts a second", file=sys.stderr)
        self.assertLess(share, 0.1)
        self.assertEqual(3, len(contacts))
        self.assertGreater(min(map(int, contacts)), 400)  # 500 where the talk itself is not held up


class Log(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.log = subprocess.run([PROGRAM, "run", "--duration", "3.5"], capture_output=True, text=True).stdout

    def monitor(self, *arguments, log=None):
        return subprocess.run([PROGRAM, "monitor", *arguments], input=self.log if log is None else log, capture_output=True, text=True)

    def test_a_log_gives_a_line_a_second_of_its_own_time(self):
        run = self.monitor()
        self.assertEqual((0, ""), (run.returncode, run.stderr))
        times = [float(line.split()[0]) for line in run.stdout.splitlines()]
        self.assertEqual(4, len(times))
        for time_s, due_s in zip(times, (1, 2, 3, 3.5)):
            self.assertAlmostEqual(due_s, time_s, delta=0.101)
        normal_n = float(re.search(r"normal ([0-9.]+) ", run.stdout)[1])
        self.assertAlmostEqual(0.4, normal_n, delta=0.003)  # 20 N/m on 20 mm; noise puts a force off by 0.15 N/m at most

    def test_a_log_can_be_watched_on_a_screen(self):
        with Bench(PROGRAM) as bench:
            log = bench.folder / "touch.log"
            log.write_text(self.log)
            with Terminal(f"(cat {log}; sleep 3) | {PROGRAM} monitor") as terminal:
                terminal.wait_for(r"(?s)node 1  run.*a log on stdin  q quit")
                terminal.press("q")
                terminal.wait_for(r"(?s) s  loopback node 1  run  .*ended: 0")  # the last state stays

    def test_without_a_bus_and_a_log_there_is_nothing_to_watch(self):
        with Terminal(f"{PROGRAM} monitor") as terminal:
            terminal.wait_for(r"(?s)nothing to watch: give --can BUS.*ended: 2")

    def test_lines_that_cannot_be_read_are_counted(self):
        run = self.monitor(log="nonsense\n" + self.log + "more\n")
        self.assertEqual(1, run.returncode)
        self.assertIn("2 of ", run.stderr)
        self.assertIn("could not be read; the first: stdin:1:9: ", run.stderr)
        self.assertEqual(4, len(run.stdout.splitlines()))

    def test_a_last_line_without_its_end_counts(self):
        run = self.monitor(log="more")
        self.assertEqual(1, run.returncode)
        self.assertIn("1 of 1 lines could not be read; the first: stdin:1:", run.stderr)

    def test_a_line_that_never_ends_takes_no_memory(self):
        def most_kib(size):
            with tempfile.TemporaryFile() as log:
                log.write(b"x" * size)
                log.seek(0)
                process = subprocess.Popen([PROGRAM, "monitor"], stdin=log, stderr=subprocess.DEVNULL)
                _, status, used = os.wait4(process.pid, 0)
                self.assertEqual(1, os.waitstatus_to_exitcode(status))
                process.returncode = 1  # it has been waited for
                return used.ru_maxrss

        self.assertLess(most_kib(50_000_000) - most_kib(100), 10_000)

    def test_no_log_is_no_line(self):
        run = self.monitor(log="")
        self.assertEqual((0, "", ""), (run.returncode, run.stdout, run.stderr))

    def test_a_stdin_that_cannot_be_read_is_a_failure(self):
        folder = os.open("/", os.O_RDONLY)
        try:
            run = subprocess.run([PROGRAM, "monitor"], stdin=folder, capture_output=True, text=True)
        finally:
            os.close(folder)
        self.assertEqual(1, run.returncode)
        self.assertIn("stdin: cannot read: Is a directory", run.stderr)

    def test_a_full_disk_is_a_failure(self):
        with open("/dev/full", "w") as full:
            run = subprocess.run([PROGRAM, "monitor"], input=self.log, stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(1, run.returncode)
        self.assertIn("cannot write the output", run.stderr)

    def test_what_is_outside_the_domain_is_refused(self):
        for every in ("0", "nan", "1e6", "x"):
            run = self.monitor("--every", every)
            self.assertEqual((2, ""), (run.returncode, run.stdout))
            self.assertIn("--every", run.stderr)


if __name__ == "__main__":
    unittest.main()
