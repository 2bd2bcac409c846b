"""Runs images on emulated boards: the one place that knows QEMU's command line."""
import os
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

SKIPPED = 77
QEMU = "qemu-system-arm"


def require(*files):
    """Skips the test (or fails it, under STRAINFINGER_REQUIRE_VCAN=1) when there is no emulator or no image."""
    missing = [] if shutil.which(QEMU) else [f"{QEMU} is not installed; cmake/setup.sh installs it"]
    missing += [f"{name} was not built: arm-none-eabi-g++ was missing" for name in files if not os.path.exists(name)]
    if not missing:
        return
    print("skipped:", "; ".join(missing), file=sys.stderr)
    sys.exit(1 if os.environ.get("STRAINFINGER_REQUIRE_VCAN") == "1" else SKIPPED)


def machine_of(elf):
    """Cortex-M4 images run on the AN386; the AN385's Cortex-M3 runs those for M3 and M0+."""
    return "mps2-an386" if "cortex-m4" in elf or "an386" in elf else "mps2-an385"


def command(elf, arguments=(), options=()):
    semihosting = "enable=on,target=native" + "".join(f",arg={word}" for word in ("image", *arguments))
    return [QEMU, "-M", machine_of(elf), "-kernel", elf, "-display", "none", "-monitor", "none",
            "-semihosting-config", semihosting, *options]


def output_of(elf, arguments=(), options=(), timeout_s=300):
    """What an image that runs by itself says on UART0."""
    done = subprocess.run(command(elf, arguments, ["-serial", "stdio", *options]), stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=timeout_s)
    if done.returncode != 0:
        raise RuntimeError(f"{elf} ended with {done.returncode}: {done.stdout[-500:]}{done.stderr}")
    return done.stdout


def with_tables(elf, tables, image):
    """An image with these tables in place of its own, as firmware/board/README.md says."""
    subprocess.run(["arm-none-eabi-objcopy", "--update-section", f".tables={tables}", elf, image], check=True)
    return image


def record(kind, payload=b""):
    return kind + bytes([len(payload)]) + payload


def samples_record(codes):
    return record(b"S", struct.pack(f"<{len(codes)}H", *codes))


class Board:
    """A finger on an emulated board. Its world is told over a socket, and its CAN bus (SLCAN) is one: this object
    listens to it, or, without `bus`, who connects to `bus_path`. firmware/board/mps2/world_record.hpp has the records."""

    def __init__(self, elf, bus=True, node=1, arguments=()):
        self.folder = tempfile.TemporaryDirectory()
        self.bus_path = self.folder.name + "/bus"
        self.console_path = self.folder.name + "/console"
        world_path = self.folder.name + "/world"
        lines = []
        for name, path in (("bus", self.bus_path), ("world", world_path)):
            lines += ["-chardev", f"socket,id={name},path={path},server=on,wait=on", "-serial", f"chardev:{name}"]
        options = ["-serial", f"file:{self.console_path}", *lines]
        self.process = subprocess.Popen(command(elf, [*arguments, f"node={node}"], options),
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.heard = bytearray()
        self.bus = self.world = None
        if bus:
            self.bus = self.connected(self.bus_path)
            threading.Thread(target=self.listen, daemon=True).start()
            self.world = self.connected(world_path)
        else:
            self.world_path = world_path  # QEMU offers it once the bus is connected

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        for line in (self.bus, self.world):
            if line:
                line.close()
        self.folder.cleanup()

    def connected(self, path, timeout_s=30):
        line = socket.socket(socket.AF_UNIX)
        line.settimeout(30)
        end = time.monotonic() + timeout_s
        while True:
            try:
                line.connect(path)
                return line
            except OSError:
                if self.process.poll() is not None or time.monotonic() > end:
                    raise
                time.sleep(0.02)

    def listen(self):
        try:
            while data := self.bus.recv(65536):
                self.heard += data
        except OSError:
            pass

    def wait_ready(self):
        """Until the board has started, or started again."""
        said = self.world.recv(1)
        if said != b"R":
            raise RuntimeError(f"the board said {said}")

    def record(self, kind, payload=b""):
        self.world.sendall(record(kind, payload))

    def samples(self, codes):
        self.world.sendall(samples_record(codes))

    def end(self):
        """Its bus lines, once it has ended by itself."""
        self.record(b"Q", b"\0")
        status = self.process.wait(30)
        if status != 0:
            raise RuntimeError(f"the board ended with {status}")
        time.sleep(0.1)
        return self.heard.decode("latin1").split("\r")

    def console(self):
        with open(self.console_path) as text:
            return text.read()
