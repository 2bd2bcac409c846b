#!/usr/bin/env python3
"""whole_bus_test.py PROGRAM: three simulated fingers, `monitor`, `serve` and `record` on one bus at the same time."""
import json
import subprocess
import sys
import time
import tomllib
import unittest

from fingers import Bench, Reader, cpu_s

PROGRAM = sys.argv.pop(1)
NODES = (1, 2, 3)
TIME_S = 10


class WholeBus(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with Bench(PROGRAM) as bench:
            cls.log = bench.folder / "bus.log"
            recorder = bench.start("record", "--can", bench.bus, "-o", str(cls.log), stderr=subprocess.DEVNULL)
            bench.until(cls.log.with_suffix(".toml").exists)
            server, url = bench.serve()
            watchers = {"serve": server,
                        "monitor": bench.start("monitor", "--can", bench.bus, "--every", "0.1", "--json", stdout=subprocess.PIPE,
                                               stderr=subprocess.DEVNULL, text=True)}
            fingers = [bench.finger(node, said=subprocess.PIPE) for node in NODES]
            lines = iter(watchers["monitor"].stdout.readline, "")
            next(line for line in lines if len(json.loads(line)["fingers"]) == len(NODES))
            reader = Reader(url, TIME_S)
            reader.start()
            before_s, began_s = {name: cpu_s(process) for name, process in watchers.items()}, time.monotonic()
            for line in lines:
                cls.seen = json.loads(line)
                if time.monotonic() > began_s + TIME_S:
                    break
            cls.shares = {name: (cpu_s(process) - before_s[name]) / (time.monotonic() - began_s) for name, process in watchers.items()}
            reader.join()
            cls.sent = [json.loads(bench.ended(finger).splitlines()[0]) for finger in fingers]
            cls.events = len(reader.states)
            bench.ended(recorder)
            cls.notes = tomllib.loads(cls.log.with_suffix(".toml").read_text())["recording"]
            cls.said = subprocess.run([PROGRAM, "decode", cls.log], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True).stderr

    def test_every_frame_that_was_sent_is_in_the_recording(self):
        self.assertEqual(sum(finger["frames"] for finger in self.sent), self.notes["frames"])
        self.assertEqual(0, self.notes["missed"])
        self.assertEqual(len(NODES), self.said.count(" 0 lost, 0 repeated, 0 restarts"))

    def test_the_monitor_sees_every_frame(self):
        self.assertEqual([0] * (1 + len(NODES)), [self.seen["missed"], *(finger["lost"] for finger in self.seen["fingers"])])

    def test_the_page_is_told_all_the_time(self):
        self.assertGreater(self.events, 20 * TIME_S)  # 25 a second

    def test_watching_costs_less_than_a_tenth_of_a_core(self):
        contacts = [finger["contacts_per_s"] for finger in self.seen["fingers"]]
        shares = ", ".join(f"{name}: {100 * share:.1f} % of a core" for name, share in self.shares.items())
        print(f"{shares}, at {contacts} contacts a second", file=sys.stderr)
        self.assertLess(max(self.shares.values()) * 500 / min(contacts), 0.1)  # a busy machine simulates fewer


if __name__ == "__main__":
    unittest.main()
