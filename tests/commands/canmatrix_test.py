"""The DBC file against the C++ codec, with a parser that is not ours (Debian's python3-canmatrix).

usage: canmatrix_test.py STRAINFINGER FRAME_CODEC
Frames that the C++ code encoded are decoded by canmatrix from the DBC file, and the other way round, over extreme
and random values. Prints its seed; CANMATRIX_TEST_SEED repeats a run.
"""
import logging
import os
import random
import subprocess
import sys
import tempfile
import unittest
import warnings
from decimal import Decimal

logging.disable(logging.CRITICAL)  # on import canmatrix reports the formats it lacks packages for
import canmatrix.formats  # noqa: E402

logging.disable(logging.NOTSET)

NODE = 5
PROTOCOL = 2
RANDOM_FRAMES = 2000
FLAGS = ["contact", "saturated", "degraded", "uncertain", "several_contacts", "stale_zero", "uncalibrated", "simulated"]
FAULTS = ["tables", "gauges", "converter", "can", "configuration", "watchdog_reset", "samples", "clock",
          "noisy"]

# The frames once more, by hand, from the bus's description and not from the code: the fields in their order, with
# the raw values a sender may send as (lowest, highest, "not known"), and the step of the physical value.
CONTACT = [
    ("angle", 0, 35999, 65535, "0.01"), ("sigma_angle", 0, 65534, 65535, "0.01"), ("alternative", -127, 127, -128, "1"),
    (FLAGS, 0, 255, None, "1"), ("quality", 0, 100, 255, "1"), ("sequence", 0, 255, None, "1")]
FORCE = [
    ("normal", -32767, 32767, -32768, "0.001"), ("tangential", -32767, 32767, -32768, "0.001"),
    ("sigma_normal", 0, 254, 255, "0.0005"), ("sigma_tangential", 0, 254, 255, "0.0005"), (FLAGS, 0, 255, None, "1"),
    ("sequence", 0, 255, None, "1")]
FRAMES = {
    "CONTACT": (0x180, CONTACT),
    "FORCE": (0x280, FORCE),
    "PATCH": (0x380, [
        ("width", 0, 65534, 65535, "1e-6"), ("sigma_width", 0, 65534, 65535, "1e-6"), ("chi", 0, 254, 255, "0.0625"),
        ("contacts", 0, 255, None, "1"), (FLAGS, 0, 255, None, "1"), ("sequence", 0, 255, None, "1")]),
    "CONTACT2": (0x200, CONTACT),
    "FORCE2": (0x300, FORCE),
    "HEARTBEAT": (0x700, [
        ("state", 0, 15, None, "1"), ("protocol", 0, 15, None, "1"), (FAULTS, 0, 2 ** len(FAULTS) - 1, None, "1"),
        ("uptime", 0, 65534, 65535, "1"), ("temperature", -127, 127, -128, "1"), ("tx_errors", 0, 14, 15, "16"),
        ("rx_errors", 0, 14, 15, "16"), ("table_crc", 0, 255, None, "1")]),
    "INFO": (0x480, [
        ("reset_cause", 0, 15, None, "1"), ("crash", 0, 15, None, "1"), ("restarts", 0, 255, None, "1"),
        ("version_major", 0, 255, None, "1"), ("version_minor", 0, 255, None, "1"),
        ("crash_address", 0, 0xFFFFFF, None, "1"), ("board", 0, 255, None, "1")]),
    "GAUGES": (0x080, [
        ("out_of_use", 0, 0xFFFFFFFF, None, "1"), ("zero_age", 0, 65534, 65535, "1"),
        ("zero_rate", 0, 65534, 65535, "1e-9")]),
    "REQUEST": (0x600, [
        ("length", 0, 7, None, "1"), ("command", 0, 127, None, "1"), ("answer", 0, 1, None, "1"),
        ("argument", 0, 0xFFFF, None, "1"), ("word", 0, 0xFFFFFFFF, None, "1")]),
    "RESPONSE": (0x580, [
        ("length", 0, 7, None, "1"), ("command", 0, 127, None, "1"), ("answer", 0, 1, None, "1"),
        ("status", 0, 255, None, "1"), ("value", 0, 0xFFFFFFFF, None, "1")]),
    "RAW": (0x400, [
        ("page", 0, 15, None, "1"), ("kind", 0, 15, None, "1"), ("sample", 0, 255, None, "1"),
        ("code_0", 0, 0xFFFF, None, "1"), ("code_1", 0, 0xFFFF, None, "1"), ("code_2", 0, 0xFFFF, None, "1")]),
}
COMMANDS = ("REQUEST", "RESPONSE", "RAW")  # not what a finger sends by itself


def codec(lines):
    """The answers of the C++ codec, one a line."""
    run = subprocess.run([FRAME_CODEC], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    return run.stdout.splitlines()


def extremes(field):
    _, low, high, unknown, _ = field
    return [value for value in (low, high, unknown, max(low, -1), 0, 1, high - 1) if value is not None]


def some_values(frame, rng):
    """Raw values of the whole frame: each extreme of each field among random others, then random ones."""
    fields = FRAMES[frame][1]

    def anything(field):
        return rng.choice(extremes(field)) if rng.random() < 0.2 else rng.randint(field[1], field[2])

    for index, field in enumerate(fields):
        for extreme in extremes(field):
            values = [anything(each) for each in fields]
            values[index] = extreme
            yield values
    for _ in range(RANDOM_FRAMES):
        yield [anything(field) for field in fields]


def signals(frame, values):
    """The raw values as signals of the DBC file: a flags field is a signal a bit."""
    result = {}
    for (name, *_), value in zip(FRAMES[frame][1], values):
        if isinstance(name, list):
            result.update({flag: value >> bit & 1 for bit, flag in enumerate(name)})
        else:
            result[name] = value
    return result


class Canmatrix(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            cls.path = os.path.join(folder, "finger.dbc")
            subprocess.run([STRAINFINGER, "dbc", "--node", str(NODE), "-o", cls.path], check=True)
            records = []
            handler = logging.Handler()
            handler.emit = records.append
            logging.getLogger().addHandler(handler)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                cls.matrix = canmatrix.formats.loadp_flat(cls.path)
            logging.getLogger().removeHandler(handler)
        cls.complaints = [record.getMessage() for record in records if record.levelno >= logging.WARNING]
        cls.complaints += [str(each.message) for each in caught if "dbc" in str(each.filename)]
        cls.rng = random.Random(SEED)

    def frame(self, name):
        return self.matrix.frame_by_id(canmatrix.ArbitrationId(FRAMES[name][0] + NODE))

    def test_loads_without_complaint(self):
        self.assertEqual([], self.complaints)
        self.assertEqual(sorted(FRAMES), sorted(frame.name for frame in self.matrix.frames))

    def test_fingers_of_one_bus_share_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "fingers.dbc")
            subprocess.run([STRAINFINGER, "dbc", "--node", f"{NODE},63", "-o", path], check=True)
            matrix = canmatrix.formats.loadp_flat(path)
        self.assertEqual(2 * len(FRAMES), len(matrix.frames))
        self.assertEqual({"HOST", f"FINGER_{NODE}", "FINGER_63"}, {ecu.name for ecu in matrix.ecus})
        for node in (NODE, 63):
            for name, (identifier, fields) in FRAMES.items():
                frame = matrix.frame_by_id(canmatrix.ArbitrationId(identifier + node))
                self.assertTrue(frame.name.startswith(name), frame.name)
                self.assertEqual(["HOST" if name == "REQUEST" else f"FINGER_{node}"], frame.transmitters)
                one = self.frame(name)
                for signal in frame.signals:
                    other = one.signal_by_name(signal.name)
                    self.assertEqual((other.start_bit, other.size, other.factor, other.unit, other.values),
                                     (signal.start_bit, signal.size, signal.factor, signal.unit, signal.values))

    def test_frames_are_of_the_finger(self):
        for name in FRAMES:
            frame = self.frame(name)
            sender = "HOST" if name == "REQUEST" else "FINGER_5"
            self.assertEqual((name, 8, [sender]), (frame.name, frame.size, frame.transmitters))
            self.assertFalse(frame.arbitration_id.extended)
        self.assertEqual([50, 50, 50, 50, 50, 100, 1000, 1000, 0, 0, 0], [self.frame(name).cycle_time for name in FRAMES])

    def test_signals_have_unit_range_and_comment(self):
        for name, (_, fields) in FRAMES.items():
            frame = self.frame(name)
            self.assertTrue(frame.comment)
            self.assertEqual(set(signals(name, [0] * len(fields))), {signal.name for signal in frame.signals})
            for signal in frame.signals:
                self.assertTrue(signal.comment, signal.name)
                self.assertEqual(["FINGER_5" if name == "REQUEST" else "HOST"], signal.receivers)
                self.assertTrue(signal.is_little_endian)
            for field in (each for each in fields if isinstance(each[0], str)):
                signal, step = frame.signal_by_name(field[0]), Decimal(field[4])
                self.assertEqual((step, field[1] * step, field[2] * step), (signal.factor, signal.min, signal.max))
        units = {signal.name: signal.unit for frame in self.matrix.frames for signal in frame.signals}
        self.assertEqual(("deg", "deg", "N", "N", "m", "", "degC", "s", "percent"), tuple(units[name] for name in (
            "angle", "alternative", "normal", "sigma_tangential", "sigma_width", "chi", "temperature", "uptime", "quality")))

    def test_values_are_named(self):
        state = self.frame("HEARTBEAT").signal_by_name("state")
        self.assertEqual({0: "boot", 1: "zeroing", 2: "run", 3: "fault"}, state.values)
        self.assertEqual("not_known", self.frame("CONTACT").signal_by_name("angle").values[65535])
        self.assertEqual({0: "no", 1: "yes"}, self.frame("FORCE").signal_by_name("simulated").values)

    def test_decodes_what_the_firmware_encodes(self):
        for name in FRAMES:
            samples = list(some_values(name, self.rng))
            sent = codec(f"encode {name} {NODE} " + " ".join(map(str, values)) for values in samples)
            self.assertEqual(len(samples), len(sent))
            for values, line in zip(samples, sent):
                identifier, data = line.split("#")
                self.assertEqual(FRAMES[name][0] + NODE, int(identifier, 16))
                decoded = self.frame(name).decode(bytes.fromhex(data))
                self.assertEqual(signals(name, values), {key: each.raw_value for key, each in decoded.items()}, line)
                for field, value in zip(FRAMES[name][1], values):
                    if isinstance(field[0], str):
                        self.assertEqual(value * Decimal(field[4]), decoded[field[0]].phys_value, line)

    def test_the_firmware_decodes_what_canmatrix_encodes(self):
        for name in FRAMES:
            frame = self.frame(name)
            samples = list(some_values(name, self.rng))
            lines = []
            for values in samples:
                physical = {key: raw * frame.signal_by_name(key).factor for key, raw in signals(name, values).items()}
                raw = {key: frame.signal_by_name(key).phys2raw(value) for key, value in physical.items()}
                lines.append(f"decode {FRAMES[name][0] + NODE:03X}#{frame.encode(raw).hex()}")
            expected = [f"{name} {NODE} " + " ".join(map(str, values)) for values in samples]
            self.assertEqual(expected, codec(lines))

    def test_decode_prints_what_canmatrix_reads(self):
        for name in (each for each in FRAMES if each not in COMMANDS):
            values = next(some_values(name, self.rng))
            if name == "HEARTBEAT":
                values[1] = PROTOCOL  # of another one decode prints nothing
            sent, = codec([f"encode {name} {NODE} " + " ".join(map(str, values))])
            run = subprocess.run([STRAINFINGER, "decode"], input=f"(0000000001.000000) can0 {sent}\n",
                                 capture_output=True, text=True, check=False)
            header, row = (line.split(",") for line in run.stdout.splitlines())
            printed = dict(zip(header, row))
            decoded = self.frame(name).decode(bytes.fromhex(sent.split("#")[1]))
            for field, value in zip(FRAMES[name][1], values):
                if not isinstance(field[0], str) or field[0] in ("state", "reset_cause", "crash") or value == field[3]:
                    continue
                if field[0] == "out_of_use":
                    bits = "+".join(str(bit) for bit in range(32) if value >> bit & 1)
                    self.assertEqual(bits, printed[field[0]])
                    continue
                column, = (key for key in printed if key == field[0] or key in (
                    f"{field[0]}_{unit}" for unit in ("deg", "n", "m", "s", "percent", "degc", "per_s")))
                self.assertEqual(decoded[field[0]].phys_value, Decimal(printed[column]), f"{sent} {column}")

    def test_reads_what_a_running_finger_sends(self):
        run = subprocess.run([STRAINFINGER, "run", "--can", "loopback", "--duration", "2", "-c", "/dev/stdin"],
                             input=f"schema = 1\n[gauges]\nmodel_error = 0\n[can]\nnode = {NODE}\n",
                             capture_output=True, text=True, check=True)
        seen = {name: [] for name in FRAMES}
        names = {identifier + NODE: name for name, (identifier, _) in FRAMES.items()}
        for line in run.stdout.splitlines():
            identifier, data = line.split()[2].split("#")
            name = names[int(identifier, 16)]
            decoded = self.frame(name).decode(bytes.fromhex(data))
            seen[name].append({key: each.raw_value for key, each in decoded.items()})
        contacts, forces, patches = seen["CONTACT"], seen["FORCE"], seen["PATCH"]
        self.assertGreater(len(contacts), 100)
        self.assertEqual([number % 256 for number in range(len(contacts))], [each["sequence"] for each in contacts])
        for others in (forces, patches):
            for signal in ("sequence", *FLAGS):
                self.assertEqual([each[signal] for each in contacts], [each[signal] for each in others], signal)
        self.assertEqual({1}, {each["simulated"] for each in contacts})
        self.assertEqual(sum(each["contacts"] == 2 for each in patches), sum(each["contact"] for each in seen["CONTACT2"]))
        self.assertEqual([each["sequence"] for each in seen["CONTACT2"]], [each["sequence"] for each in seen["FORCE2"]])
        self.assertEqual(20, len(seen["HEARTBEAT"]))


if __name__ == "__main__":
    STRAINFINGER, FRAME_CODEC = sys.argv[1:3]
    SEED = int(os.environ.get("CANMATRIX_TEST_SEED") or random.SystemRandom().randrange(2**32))
    print(f"seed {SEED}", flush=True)
    unittest.main(argv=sys.argv[:1], verbosity=2)
