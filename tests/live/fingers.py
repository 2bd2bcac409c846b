"""Simulated fingers on a bus of their own, and the program under test beside them."""
import contextlib
import json
import multiprocessing
import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import threading
import time
import urllib.request

# Slid around, and pressed harder and softer ten times a second: there is news in every sample set.
SCENARIO = f"""schema = 1
repeat_s = 20
[[touch]]
start_s = 0.3
end_s = 19.9
angle_deg = [20, 340]
normal_n_per_m = {[15, 32] * 196}
tangential_n_per_m = {[-8, 3, 9] * 130}
"""

UNTOUCHED = "schema = 1\n"


def free_bus():
    """A udp bus that no other test uses at the same time: tests have process numbers of their own."""
    return f"udp:{20000 + os.getpid() % 20000}"


def cpu_s(process):
    """Processor time that a process has used so far."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Bench(contextlib.ExitStack):
    """What was started ends with it."""

    def __init__(self, program):
        super().__init__()
        self.program = program
        self.bus = free_bus()
        self.folder = pathlib.Path(self.enter_context(tempfile.TemporaryDirectory()))

    def new_folder(self):
        """Recordings are named by the second: two in one would have one name."""
        return pathlib.Path(tempfile.mkdtemp(dir=self.folder))

    def start(self, *arguments, **options):
        process = subprocess.Popen([self.program, *arguments], **options)
        self.callback(self._end, process)
        return process

    @staticmethod
    def _end(process):
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            raise
        finally:
            for stream in filter(None, (process.stdout, process.stderr)):
                stream.close()

    @staticmethod
    def ended(process):
        """What it says on stderr, if that is a pipe, ended as by Ctrl-C."""
        process.send_signal(signal.SIGINT)
        return process.communicate(timeout=20)[1]

    @staticmethod
    def until(holds, longest_s=30):
        end = time.monotonic() + longest_s
        while not holds():
            if time.monotonic() > end:
                raise AssertionError(f"not within {longest_s} s: {holds}")
            time.sleep(0.02)

    def finger(self, node=1, scenario=SCENARIO, said=subprocess.DEVNULL):
        config = self.folder / f"finger_{node}.toml"
        config.write_text(f"schema = 1\n[can]\nnode = {node}\n[gauges]\nmodel_error = 0.003\n")
        touches = self.folder / f"touches_{node}.toml"
        touches.write_text(scenario)
        return self.start("run", "-c", str(config), "--can", self.bus, "--scenario", str(touches), "--json",
                          stdout=subprocess.DEVNULL, stderr=said, text=True)

    def replayed(self, node, scenario, time_s):
        """A finger simulated beforehand, in its own time."""
        config, touches, log = (self.folder / f"{name}_{node}" for name in ("config", "touches", "log"))
        config.write_text(f"schema = 1\n[can]\nnode = {node}\n[gauges]\nmodel_error = 0.003\n")
        touches.write_text(scenario)
        with log.open("w") as out:
            subprocess.run([self.program, "run", "-c", config, "--scenario", touches, "--duration", str(time_s)], stdout=out,
                           stderr=subprocess.DEVNULL, check=True)
        return self.start("replay", str(log), "--can", self.bus, stderr=subprocess.DEVNULL)

    def chatter(self, nodes=(1, 2, 3), rate_hz=500, time_s=60):
        """So many touches a second of each, however slow this machine is at simulating fingers."""
        process = multiprocessing.Process(target=chatter, args=(self.bus, nodes, rate_hz, time_s), daemon=True)
        process.start()
        self.callback(process.join)
        self.callback(process.terminate)

    def serve(self, *arguments, **options):
        """The process, and the address that it prints."""
        process = self.start("serve", "--can", self.bus, "--port", "0", *arguments, stderr=subprocess.PIPE, text=True, **options)
        line = process.stderr.readline()
        assert line.startswith("serve: http://"), line
        return process, line.split()[1]

    @staticmethod
    def state(url):
        return json.load(urllib.request.urlopen(url + "state", timeout=5))

    def wait_for(self, url, holds, longest_s=30):
        """The first state of which `holds` is true."""
        end = time.monotonic() + longest_s
        while time.monotonic() < end:
            state = self.state(url)
            if holds(state):
                return state
            time.sleep(0.05)
        raise AssertionError(f"not within {longest_s} s; the last state: {state}")


class Reader(threading.Thread):
    """Reads the events of `serve` for so long, as a page does."""

    def __init__(self, url, time_s):
        super().__init__()
        self.url, self.time_s, self.states, self.latest_s = url, time_s, [], 0

    def run(self):
        end = time.monotonic() + self.time_s
        with urllib.request.urlopen(self.url + "events", timeout=10) as stream:
            for line in stream:
                if line.startswith(b"data: "):
                    self.states.append(json.loads(line[6:]))
                    self.latest_s = max(self.latest_s, time.time() - self.states[-1]["time_s"])
                if time.monotonic() > end:
                    return


def bench_with_two(tests, program):
    """For a class of tests: finger 1 is touched, finger 2 is not."""
    bench = Bench(program)
    tests.addClassCleanup(bench.close)
    bench.finger(1)
    bench.finger(2, UNTOUCHED)
    return bench


def touched(state):
    return state["fingers"] and all(finger["touch"] and finger["touch"]["touched"] for finger in state["fingers"])


GROUP = "239.255.67.65"


def chatter(bus, nodes, rate_hz, time_s):
    """Fingers that are all talk: CONTACT, FORCE and PATCH at an exact rate, HEARTBEATs ten times a second. The bytes are those of
    common/BUS*.md's examples, the datagrams those of host/can/UDP_BUS.md."""
    speaks = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    speaks.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
    speaks.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    speaks.bind(("127.0.0.1", 0))
    to = (GROUP, int(bus.partition(":")[2]))

    def send(identifier, data):
        speaks.sendto(bytes([1, identifier >> 8, identifier & 255, 8]) + data, to)

    began = time.monotonic()
    for count in range(int(rate_hz * time_s)):
        time.sleep(max(0.0, began + count / rate_hz - time.monotonic()))
        number = bytes([count % 256])
        for node in nodes:
            if count % (rate_hz // 10) == 0:
                send(0x700 + node, bytes.fromhex("2200004D0E1900A7"))
            send(0x180 + node, (count * 7 % 36000).to_bytes(2, "little") + bytes.fromhex("2201808161") + number)
            send(0x280 + node, (count % 900).to_bytes(2, "little") + bytes.fromhex("1EFF070981") + number)
            send(0x380 + node, bytes.fromhex("F80796001101") + b"\x81" + number)
