"""How fast `strainfinger decode` is, beside Debian's python3-canmatrix on the same frames, and how much memory it takes.

usage: decode_speed.py STRAINFINGER [MEGABYTES [LEAST_MB_PER_S]]
Speeds are of processor time, which a busy machine hardly takes from. Fails below 20 times canmatrix' speed, below
LEAST_MB_PER_S, and where a log ten times as long takes more memory. MEGABYTES (default 20) is the longer log's size.
"""
import os
import subprocess
import sys
import tempfile
import time
import warnings

warnings.simplefilter("ignore")
import logging  # noqa: E402

logging.disable(logging.CRITICAL)
import canmatrix.formats  # noqa: E402

LEAST_RATIO = 20
ROUNDS = 3
MATRIX_LINES = 2000
MEMORY_SPREAD_KIB = 2048


def make_log(folder):
    run = subprocess.run([STRAINFINGER, "run", "--duration", "20"], capture_output=True, text=True, check=True)
    lines = [line.replace(" loopback ", " can0 ") for line in run.stdout.splitlines()]
    path = os.path.join(folder, "long.log")
    block = "\n".join(lines) + "\n"
    with open(path, "w", encoding="ascii") as log:
        for _ in range(max(1, MEGABYTES * 1_000_000 // len(block))):
            log.write(block)
    return lines, path


def largest_memory_kib(process):
    """So far. (That of getrusage has this program's in it, from before the other began.) None: it has ended."""
    with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
        sizes = [line.split()[1] for line in status if line.startswith("VmHWM:")]
    return int(sizes[0]) if sizes else None


def decode(path):
    """Bytes a second, and the largest memory in KiB."""
    memory_kib = 0
    with open(path, "rb") as log, open(os.devnull, "wb") as nothing:
        child = subprocess.Popen([STRAINFINGER, "decode"], stdin=log, stdout=nothing, stderr=nothing)
        while now_kib := largest_memory_kib(child):
            memory_kib = now_kib
            time.sleep(0.002)
        _, status, usage = os.wait4(child.pid, 0)
    assert status == 0, status
    return os.path.getsize(path) / (usage.ru_utime + usage.ru_stime), memory_kib


def decode_by_canmatrix(matrix, lines):
    """Bytes a second of the same lines, the text taken apart as sparingly as Python can."""
    size, start = 0, time.process_time()
    for line in lines[:MATRIX_LINES]:
        identifier, data = line.rsplit(" ", 1)[1].split("#")
        matrix.decode(canmatrix.ArbitrationId(int(identifier, 16), extended=False), bytes.fromhex(data))
        size += len(line) + 1
    return size / (time.process_time() - start)


def main():
    with tempfile.TemporaryDirectory() as folder:
        lines, path = make_log(folder)
        dbc = os.path.join(folder, "finger.dbc")
        subprocess.run([STRAINFINGER, "dbc", "-o", dbc], check=True)
        matrix = canmatrix.formats.loadp_flat(dbc)
        short = os.path.join(folder, "short.log")
        with open(path, "rb") as log, open(short, "wb") as part:
            part.write(log.read(os.path.getsize(path) // 10) + log.readline())
        rounds = [(*decode(path), decode_by_canmatrix(matrix, lines)) for _ in range(ROUNDS)]
        memory = [decode(short)[1], rounds[0][1]]
    ratio = sorted(ours / theirs for ours, _, theirs in rounds)[ROUNDS // 2]
    fastest = max(ours for ours, *_ in rounds) / 1e6
    print(f"decode: {fastest:.0f} MB/s; canmatrix: "
          f"{max(theirs for *_, theirs in rounds) / 1e6:.2f} MB/s; ratio, the middle of {ROUNDS} rounds: {ratio:.0f}")
    print(f"memory: {memory[1]} KiB for {MEGABYTES} MB, {memory[0]} KiB for a tenth of it")
    is_fast = ratio >= LEAST_RATIO and fastest >= LEAST_MB_PER_S
    return 0 if is_fast and memory[1] <= memory[0] + MEMORY_SPREAD_KIB else 1


if __name__ == "__main__":
    STRAINFINGER, MEGABYTES = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20
    LEAST_MB_PER_S = float(sys.argv[3]) if len(sys.argv) > 3 else 0
    sys.exit(main())
