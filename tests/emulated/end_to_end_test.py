#!/usr/bin/env python3
"""end_to_end_test.py FINGER.elf STRAINFINGER TOUCH_WORLD IN_VCAN: emulated fingers on a Linux CAN bus.

    simulated touches -> emulated Cortex-M4 -> SLCAN -> slcand in a small machine -> slcan1 -> cangw -> vcan0 -> candump -> decode
                                                                                                             -> monitor, serve

Every frame of a touch must arrive, in order, as the same logic says on this machine, over a thousand a second, from one
finger and from three at once; what decode makes of them must be what really touched the finger; and what happens to the
bus must be seen on both sides. One machine serves all of it: it is booted and everything done first, then looked at.
"""
import contextlib
import csv
import io
import json
import re
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest
from pathlib import Path

import emulator
from machine import TIMEOUT_S, Machine
from touches import (ANGLE_ROUNDING_DEG, FORCE_ROUNDING_N, SIGMAS, SLIDE_S, TouchedFinger, check_arrived, check_truth,
                     decoded, touch_frames)

NODES = (1, 2, 3)
PERIOD_S = 0.001
FRAMES = 2000
FRAMES_PER_S = 1000
FRAMES_OF_TOUCH = 3  # CONTACT, FORCE, PATCH
AS_DRAWN = "[gauges]\nmodel_error = 0\n"  # as the touched finger is; doubts of how it was built would make most sets no news
ACTIVE, PASSIVE, BUS_OFF = 0, 2, 3  # hal::CanState
CRC_AT = 12  # the lowest byte, in tables (common/TABLES.md)
UNTOUCHED = [emulator.samples_record([0x8000] * 16)]
LINK = "ip -d link show slcan1"
UNTIL = "for _ in $(seq 100); do ! {link} | grep -q {state} || break; sleep 0.05; done; {link}"


def play(tracks):
    """[(board, records)], together, a record a millisecond."""
    begin = time.monotonic()
    for number in range(max(len(records) for _, records in tracks)):
        for board, records in tracks:
            board.world.sendall(records[number])
        time.sleep(max(0, begin + (number + 1) * PERIOD_S - time.monotonic()))


def during(machine, board, records, script):
    """What the script says, while the board is told the records again and again."""
    done = machine.job / "done"
    machine.run(f"({{ {script}\n}} &>$JOB/said || true; touch $JOB/done) &")
    end = time.monotonic() + TIMEOUT_S
    while not done.exists():
        machine.check_alive()
        if time.monotonic() > end:
            raise RuntimeError(f"no end of: {script}")
        play([(board, records)])
    done.unlink()
    return (machine.job / "said").read_text()


class Recording:
    """A candump log, and what should be in it by node."""

    def __init__(self, log, expected):
        self.log, self.expected = log, expected
        lines = [line.split() for line in log.splitlines()]
        self.frames = [frame for _, _, frame in lines]
        touches = [float(stamp.strip("()")) for stamp, _, frame in lines if touch_frames([frame])]
        self.frames_per_s = (len(touches) - 1) / (touches[-1] - touches[0])

    def of(self, node):
        return [frame for frame in self.frames if int(frame[:3], 16) & 63 == node]

    def check_arrived(self, test):
        for node, expected in self.expected.items():
            check_arrived(test, self.of(node), expected)
            test.assertGreaterEqual(len(expected), FRAMES)


class Bus:
    """What happened to the bus of finger 1 alone, and what both sides said of it."""

    def __init__(self, machine, board, finger):
        self.machine, self.board, self.records = machine, board, finger.records[300:900]
        machine.run("candump -D -e slcan1,0:0,#FFFFFFFF >$TMPDIR/errors & echo $! >$TMPDIR/recorder_of_errors; sleep 0.2")
        self.passive_link, self.passive_log = self.happen(PASSIVE, 130, 5, "ERROR-PASSIVE")
        self.active_link, _ = self.happen(ACTIVE, 0, 0, "ERROR-ACTIVE")
        self.off_link, self.off_log = self.happen(BUS_OFF, 255, 0, "BUS-OFF")
        self.board.record(b"B", bytes([ACTIVE, 0, 0]))
        self.still_off_link = machine.run(f"sleep 0.3; {LINK}")
        machine.run("ip link set slcan1 down; ip link set slcan1 up")
        self.back_link, self.back_log = self.happen(ACTIVE, 0, 0, "ERROR-ACTIVE")
        self.errors = machine.run("kill $(cat $TMPDIR/recorder_of_errors); cat $TMPDIR/errors")

    def happen(self, state, tx_errors, rx_errors, link_state):
        """(what ip says, what candump heard of the touches after it)"""
        self.machine.record()
        self.board.record(b"B", bytes([state, tx_errors, rx_errors]))
        link = self.machine.run(UNTIL.format(link=LINK, state=link_state))
        play([(self.board, self.records)])
        return link, self.machine.recorded(0 if state == BUS_OFF else 500)


class Told:
    """What a finger is told from Linux, and what it then does: the way of the frames, backwards."""
    NODE, TOUCHED_MS, RATE_HZ = 2, 600, 100
    RAW_HZ, ROWS = 50, 60

    def __init__(self, machine, board, finger):
        untouched = 100 * UNTOUCHED
        play([(board, untouched)])
        program = f"{STRAINFINGER} {{}} --can vcan0 --node {self.NODE}"
        self.tare = during(machine, board, untouched, program.format("tare"))
        machine.record()
        self.said_of_strains = during(machine, board, untouched, f"{program.format('strains')} --rate {self.RAW_HZ} --rows {self.ROWS} >$TMPDIR/strains")
        self.strains = machine.run("cat $TMPDIR/strains")
        self.raw = [line.split()[2] for line in machine.recorded(0).splitlines() if f"40{self.NODE}#" in line]
        self.rate = machine.run(f"{program.format('config')} --contact-rate-hz {self.RATE_HZ} 2>&1")
        machine.record()
        play([(board, finger.records[300:300 + self.TOUCHED_MS])])
        self.frames = [line.split()[2] for line in machine.recorded(FRAMES_OF_TOUCH * (self.TOUCHED_MS * self.RATE_HZ // 1000 - 2)).splitlines()]


class Watched:
    """What `monitor` and `serve` show of a finger that is held, and what becomes of a tare through the page's server."""
    NODE, AT_S, PORT = 3, 2.4, 8080
    SCRIPT = """
        ip link set lo up
        {program} serve --can vcan0 --port {port} &>$TMPDIR/address & server=$!
        {program} monitor --can vcan0 --every 0.5 &>$TMPDIR/lines & monitor=$!
        until grep -q 'node {node}  run  angle' $TMPDIR/lines; do sleep 0.1; done
        kill $monitor
        cansend vcan0 60{node}#03063200   # RAW, 50 sets a second
        until curl -s localhost:{port}/state >$TMPDIR/state &&
              grep '"fitted":\\[' $TMPDIR/state | grep -q '"info":{{'; do sleep 0.1; done
        curl -s -X POST -H 'X-Strainfinger: -' localhost:{port}/fingers/{node}/tare >$TMPDIR/answer
        kill $server
        wait || true
        cat $TMPDIR/state $TMPDIR/answer $TMPDIR/lines
    """

    def __init__(self, machine, board, finger):
        at = round(self.AT_S / finger.period_s)
        self.truth = next(line.truth for line in finger.expected if round(line.time_s / finger.period_s) >= at)
        play([(board, 100 * UNTOUCHED)])
        script = self.SCRIPT.format(program=STRAINFINGER, port=self.PORT, node=self.NODE)
        said = during(machine, board, 20 * finger.records[at:at + 1], script).splitlines()
        self.bus, self.answer, self.lines = json.loads(said[0]), json.loads(said[1]), said[2:]
        self.finger = next(each for each in self.bus["fingers"] if each["node"] == self.NODE)


class Kept:
    """What `record` keeps of a finger that is touched, beside what candump hears, and what becomes of it here.

    The two start and stop at different times and may hear late frames of an earlier step: they are compared from one frame
    that both have to another."""
    NODE, TOUCHED_MS = 3, 600
    BEGIN, END = "7FF#00", "7FF#01"

    def __init__(self, machine, board, finger, folder):
        machine.record()
        machine.run(f"{STRAINFINGER} record --can vcan0 -o $TMPDIR/kept.log &>$TMPDIR/kept.said & echo $! >$TMPDIR/keeper\n"
                    f"until grep -qs {self.BEGIN} $TMPDIR/kept.log; do cansend vcan0 {self.BEGIN}; sleep 0.5; done")
        play([(board, finger.records[300:300 + self.TOUCHED_MS])])
        machine.run(f"sleep 0.3; cansend vcan0 {self.END}")
        self.heard = machine.recorded(FRAMES_OF_TOUCH * self.TOUCHED_MS // 4)
        machine.run("kill $(cat $TMPDIR/keeper); while kill -0 $(cat $TMPDIR/keeper) 2>/dev/null; do sleep 0.05; done")
        self.log, self.notes = (machine.run(f"cat $TMPDIR/kept.{ending}") for ending in ("log", "toml"))
        path = folder / "kept.log"
        path.write_text(self.log)
        subprocess.run([STRAINFINGER, "plot", path, "-o", folder / "kept.svg"], check=True, capture_output=True)
        self.picture = (folder / "kept.svg").read_text()
        self.table_crc = (folder / "tables").read_bytes()[CRC_AT]
        rows = subprocess.run([STRAINFINGER, "decode", "--touches", path], check=True, capture_output=True, text=True).stdout
        self.rows = list(csv.DictReader(io.StringIO(rows)))

    @classmethod
    def touches_in(cls, log):
        frames = [line.split()[2] for line in log.splitlines()]
        last_begin = len(frames) - 1 - frames[::-1].index(cls.BEGIN)
        return touch_frames(frames[last_begin:frames.index(cls.END)])


def setUpModule():
    global one, three, told, watched, kept, bus, consoles
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        (folder / "job").mkdir()
        tables = folder / "tables"
        subprocess.run([STRAINFINGER, "tables", "-c", config_of(folder, 1), "-o", tables], check=True, capture_output=True)
        image = emulator.with_tables(ELF, tables, folder / "an386.elf")
        fingers = [touched_finger(folder, node, tables, 2 if node == 1 else 1) for node in NODES]
        boards = [stack.enter_context(emulator.Board(str(image), bus=False, node=node)) for node in NODES]
        machine = stack.enter_context(Machine(IN_VCAN, folder / "job", boards))
        machine.join()
        one = slide_at_once(machine, boards[:1], fingers[:1])
        three = slide_at_once(machine, boards, fingers)
        told = Told(machine, boards[Told.NODE - 1], fingers[Told.NODE - 1])
        watched = Watched(machine, boards[Watched.NODE - 1], fingers[Watched.NODE - 1])
        kept = Kept(machine, boards[Kept.NODE - 1], fingers[Kept.NODE - 1], folder)
        bus = Bus(machine, boards[0], fingers[0])
        consoles = [board.console() for board in boards]
        machine.end()


def config_of(folder, node):
    config = folder / f"finger{node}.toml"
    config.write_text(f"schema = 1\n{AS_DRAWN}[can]\nnode = {node}\n")
    return config


def touched_finger(folder, node, tables, slides):
    return TouchedFinger(TOUCH_WORLD, config_of(folder, node), tables, slides)


def slide_at_once(machine, boards, fingers):
    slides = [finger.next_slide() for finger in fingers]
    machine.record()
    play([(board, records) for board, (records, _) in zip(boards, slides)])
    expected = {node: lines for node, (_, lines) in zip(NODES, slides)}
    return Recording(machine.recorded(sum(map(len, expected.values()))), expected)


class OneFinger(unittest.TestCase):
    def test_every_frame_arrives_once_in_order_as_computed_here(self):
        one.check_arrived(self)

    def test_a_thousand_frames_a_second_of_the_samples_time(self):
        times = [line.time_s for line in one.expected[1]]
        self.assertLess(min(b - a for a, b in zip(times, times[FRAMES - 1:])), FRAMES / FRAMES_PER_S)
        print(f"{one.frames_per_s:.0f} heard a second", file=sys.stderr)

    def test_decode_misses_nothing(self):
        _, said = decoded(STRAINFINGER, one.log)
        self.assertIn(f"{len(one.expected[1])} frames of touches received, 0 lost", said)

    def test_decode_tells_the_truth(self):
        rows, _ = decoded(STRAINFINGER, one.log)
        check_truth(self, rows, one.expected[1])

    def test_the_finger_tells_that_it_is_alive(self):
        self.assertAlmostEqual(sum(frame.startswith("701#22") for frame in one.frames), SLIDE_S * 10, delta=2)
        self.assertIn("481#0100000100000000", one.frames)


class ThreeFingers(unittest.TestCase):
    def test_every_frame_of_each_arrives_once_in_order_as_computed_here(self):
        three.check_arrived(self)
        print(f"{three.frames_per_s:.0f} heard a second", file=sys.stderr)

    def test_they_differ(self):
        data = lambda node: [frame[4:] for frame in touch_frames(three.of(node))]
        self.assertNotEqual(data(2), data(3))

    def test_each_tells_that_it_is_alive(self):
        for node in NODES:
            self.assertAlmostEqual(sum(frame.startswith(f"70{node}#22") for frame in three.frames), SLIDE_S * 10, delta=2)


class Commands(unittest.TestCase):
    ANSWER = "interface,node,command,status\nvcan0,2,{},done\n"

    def test_a_tare_from_linux_is_done_and_answered(self):
        self.assertEqual(told.tare, self.ANSWER.format("tare"))

    def test_its_strains_come_to_linux(self):
        names, *rows = (line.split(",") for line in told.strains.splitlines())
        self.assertEqual(["time_s", *(f"strain_{gauge}" for gauge in range(16))], names)
        self.assertEqual(f"strains: {told.ROWS} sets, 0 incomplete\n", told.said_of_strains)
        self.assertEqual(told.ROWS, len(rows))
        self.assertEqual({0}, {float(strain) for row in rows for strain in row[1:]}, "untouched, of the finger's zero")

    def test_its_readings_come_at_the_rate_that_was_asked_for(self):
        firsts = [bytes.fromhex(frame[4:]) for frame in told.raw]
        samples = [data[1] for data in firsts if data[0] == 0]  # page 0 of readings: the number of its set, one a millisecond
        self.assertGreaterEqual(len(samples), told.ROWS)
        self.assertEqual({1000 // told.RAW_HZ}, {(b - a) % 256 for a, b in zip(samples, samples[1:])})

    def test_a_contact_rate_from_linux_is_done_and_answered(self):
        self.assertEqual(told.rate, self.ANSWER.format("contact_rate"))

    def test_the_finger_keeps_to_its_new_rate(self):
        contacts = sum(frame.startswith("182#") for frame in told.frames)
        self.assertAlmostEqual(contacts, told.TOUCHED_MS * told.RATE_HZ / 1000, delta=2)


class Live(unittest.TestCase):
    def check_near_truth(self, angle, normal):
        """(value, sigma) of each."""
        off_deg = (angle[0] - watched.truth["angle_deg"] + 180) % 360 - 180
        self.assertLessEqual(abs(off_deg), SIGMAS * angle[1] + ANGLE_ROUNDING_DEG)
        self.assertLessEqual(abs(normal[0] - watched.truth["normal_n"]), SIGMAS * normal[1] + FORCE_ROUNDING_N)

    def test_monitor_shows_where_and_how_hard_the_finger_is_touched(self):
        line = next(line for line in watched.lines if f"node {watched.NODE}  run  angle" in line)
        number = r"(\d+\.\d+) \+- (\d+\.\d+)"  # the virtual machine has no UTF-8
        found = re.search(rf"vcan0 node \d  run  angle {number} deg  normal {number} N", line)
        angle, sigma_angle, normal, sigma_normal = map(float, found.groups())
        self.check_near_truth((angle, sigma_angle), (normal, sigma_normal))

    def test_serve_shows_the_same(self):
        touch = watched.finger["touch"]
        self.assertEqual(("vcan0", "run", True), (watched.bus["bus"], watched.finger["state"], touch["touched"]))
        self.check_near_truth((touch["angle_deg"], touch["sigma_angle_deg"]), (touch["normal_n"], touch["sigma_normal_n"]))

    def test_serve_shows_the_boards_firmware(self):
        self.assertEqual(("0.1", "none"), (watched.finger["info"]["version"], watched.finger["info"]["crash"]))

    def test_its_strains_are_what_the_touch_explains(self):
        strains, fitted = watched.finger["strains"], watched.finger["fitted"]
        self.assertEqual((16, 16), (len(strains), len(fitted)))
        deepest = min(strains)
        self.assertLess(deepest, -0.004)
        for gauge, (read, explained) in enumerate(zip(strains, fitted)):
            self.assertAlmostEqual(read, explained, delta=-deepest / 100, msg=f"gauge {gauge}")

    def test_a_tare_through_the_pages_server_is_refused_while_touched(self):
        self.assertIn(f"node {watched.NODE}: tare: Refused: something touches", watched.answer["text"])


class KeptTouches(unittest.TestCase):
    def test_the_log_has_every_frame_that_candump_heard(self):
        heard = Kept.touches_in(kept.heard)
        self.assertGreater(len(heard), 300)
        self.assertEqual(heard, Kept.touches_in(kept.log))

    def test_the_notes_name_the_finger_and_its_tables(self):
        fingers = tomllib.loads(kept.notes)["recording"]["finger"]
        self.assertEqual([Kept.NODE], [finger["node"] for finger in fingers])  # time stands still for the others
        self.assertEqual(kept.table_crc, int(fingers[0]["table_crc"], 16))

    def test_a_touch_is_a_row(self):
        nodes = {row["node"] for row in kept.rows}
        contacts = kept.log.count(f" 18{Kept.NODE}#")
        self.assertIn(str(Kept.NODE), nodes)
        self.assertEqual(contacts, sum(row["node"] == str(Kept.NODE) for row in kept.rows))

    def test_the_log_is_a_picture(self):
        self.assertIn("angle", kept.picture)
        self.assertIn("</svg>", kept.picture)


class BusStates(unittest.TestCase):
    def heartbeats(self, log):
        frames = [line.split()[2] for line in log.splitlines()]
        return [bytes.fromhex(frame[4:]) for frame in frames if frame.startswith("701#")]

    def check_flowing(self, log):
        _, said = decoded(STRAINFINGER, log)
        self.assertRegex(said, r"\b[789]\d\d frames of touches received, 0 lost")

    def test_error_passive_shows_on_linux(self):
        self.assertIn("can state ERROR-PASSIVE", bus.passive_link)
        controller, transmit_passive = 0x20000204, "00 20"  # linux/can/error.h; then the counters
        self.assertIn(f"{controller:X}   [8]  {transmit_passive} 00 00 00 00 82 05   ERRORFRAME", bus.errors)

    def test_an_error_passive_finger_goes_on(self):
        self.check_flowing(bus.passive_log)

    def test_its_heartbeat_has_the_counters(self):
        self.assertEqual([beat[6] for beat in self.heartbeats(bus.passive_log)][-1], 5 // 16 << 4 | 130 // 16)

    def test_recovery_from_error_passive_shows_on_linux(self):
        self.assertIn("can state ERROR-ACTIVE", bus.active_link)

    def test_bus_off_shows_on_linux(self):
        self.assertIn("can state BUS-OFF", bus.off_link)
        self.assertIn("NO-CARRIER", bus.off_link)
        self.assertRegex(bus.errors, r"20000040   \[8\]  .*ERRORFRAME\s+bus-off")

    def test_nothing_is_sent_in_bus_off(self):
        self.assertEqual(bus.off_log, "")

    def test_linux_comes_back_when_it_is_told_to(self):
        self.assertIn("NO-CARRIER", bus.still_off_link)
        self.assertIn("can state ERROR-ACTIVE", bus.back_link)
        self.assertNotIn("NO-CARRIER", bus.back_link)

    def test_frames_flow_again(self):
        self.check_flowing(bus.back_log)

    def test_the_finger_has_gone_on_all_the_time(self):
        first, last = self.heartbeats(bus.passive_log)[0], self.heartbeats(bus.back_log)[-1]
        uptime_s = lambda beat: int.from_bytes(beat[3:5], "little")
        self.assertAlmostEqual(uptime_s(last) - uptime_s(first), 4 * 0.6, delta=1)
        self.assertEqual((last[0] & 15, last[1], last[2], last[6]), (2, 0, 0, 0), "run, no faults, no errors")

    def test_no_finger_has_restarted(self):
        self.assertEqual([console.count("strainfinger on mps2") for console in consoles], [1, 1, 1])


if __name__ == "__main__":
    ELF, STRAINFINGER, TOUCH_WORLD, IN_VCAN = sys.argv[1:5]
    emulator.require(ELF)
    unittest.main(argv=sys.argv[:1], verbosity=2)
