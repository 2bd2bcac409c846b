"""What a user's plot of a press and a release shows: candump's log by python-can, the DBC file by canmatrix.

usage: press_and_release_test.py STRAINFINGER
A plot holds each signal's last value until the next frame. After the release it must show no force.
"""
import logging
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import can

logging.disable(logging.CRITICAL)  # on import canmatrix reports the formats it lacks packages for
import canmatrix.formats  # noqa: E402

logging.disable(logging.NOTSET)

SCENARIO = """schema = 1
[[touch]]
start_s = 0.3
end_s = 1.3
angle_deg = 40
normal_n_per_m = 25
tangential_n_per_m = 5
[[touch]]
start_s = 0.5
end_s = 0.9
angle_deg = 220
normal_n_per_m = 20
"""
RELEASED_S, SECOND_RELEASED_S, NOTICED_S = 1.3, 0.9, 0.3
FORCES = ("normal", "tangential")


class PressAndRelease(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            dbc, log, scenario = (str(Path(folder) / name) for name in ("finger.dbc", "touch.log", "touch.toml"))
            Path(scenario).write_text(SCENARIO)
            subprocess.run([STRAINFINGER, "dbc", "-o", dbc], check=True)
            with open(log, "wb") as to:
                subprocess.run([STRAINFINGER, "run", "--scenario", scenario, "--duration", "2"], stdout=to,
                               stderr=subprocess.DEVNULL, check=True)
            cls.matrix = canmatrix.formats.loadp_flat(dbc)
            cls.plots = cls.plotted(can.LogReader(log))

    @classmethod
    def plotted(cls, messages):
        """{(frame, signal): [(time, value)]}"""
        plots = {}
        for message in messages:
            frame = cls.matrix.frame_by_id(canmatrix.ArbitrationId(message.arbitration_id))
            for name, decoded in frame.decode(bytes(message.data)).items():
                plots.setdefault((frame.name, name), []).append((message.timestamp, float(decoded.phys_value)))
        return plots

    def shown(self, frame, signal, begin_s, end_s):
        """What the plot shows in that time: the value held from before, and all that come."""
        plot = self.plots[frame, signal]
        held = [value for time_s, value in plot if time_s < begin_s][-1:]
        return held + [value for time_s, value in plot if begin_s <= time_s < end_s]

    def test_the_press_is_seen(self):
        self.assertGreater(max(self.shown("FORCE", "normal", 0.3, 1.3)), 0.4)  # 25 N/m over 20 mm is 0.5 N
        self.assertGreater(max(self.shown("FORCE2", "normal", 0.3, 1.3)), 0.3)
        self.assertEqual({1.0}, set(self.shown("CONTACT", "contact", 0.4, 1.2)))

    def test_after_the_release_there_is_no_force(self):
        for frame in ("FORCE", "FORCE2"):
            for signal in FORCES:
                self.assertEqual([0.0], self.shown(frame, signal, RELEASED_S + NOTICED_S, 99), (frame, signal))
            self.assertEqual([0.0], self.shown(frame, "contact", RELEASED_S + NOTICED_S, 99), frame)
        for frame in ("CONTACT", "CONTACT2", "PATCH"):
            self.assertEqual([0.0], self.shown(frame, "contact", RELEASED_S + NOTICED_S, 99), frame)
        self.assertEqual([0.0], self.shown("PATCH", "contacts", RELEASED_S + NOTICED_S, 99))

    def test_a_second_contact_that_goes_has_no_force_while_the_first_stays(self):
        for signal in FORCES:
            self.assertEqual({0.0}, set(self.shown("FORCE2", signal, SECOND_RELEASED_S + NOTICED_S, RELEASED_S)))
        self.assertGreater(min(self.shown("FORCE", "normal", SECOND_RELEASED_S + NOTICED_S, RELEASED_S)), 0.4)

    def test_no_force_is_ever_one_that_cannot_be(self):
        for frame in ("FORCE", "FORCE2"):
            for signal in FORCES:
                values = self.shown(frame, signal, 0, 99)
                self.assertLess(max(map(abs, values)), 2, (frame, signal))

    def test_what_is_not_known_after_a_release_is_named_so(self):
        frame = self.matrix.frame_by_name("CONTACT")
        self.assertEqual("not_known", frame.signal_by_name("angle").values[65535])
        self.assertEqual([655.35], self.shown("CONTACT", "angle", RELEASED_S + NOTICED_S, 99))


if __name__ == "__main__":
    STRAINFINGER = sys.argv[1]
    unittest.main(argv=sys.argv[:1], verbosity=2)
