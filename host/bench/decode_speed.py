"""How fast `strainfinger decode` is, beside Debian's python3-canmatrix on the same frames.

usage: decode_speed.py STRAINFINGER [MEGABYTES]
Speeds are of processor time, which a busy machine takes little from. MEGABYTES (default 200) is the log's size. Fails below
20 times canmatrix' speed or 100 MB/s, which are the bars for an optimised program on an idle machine.
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
LEAST_MB_PER_S = 100
ROUNDS = 3
MATRIX_LINES = 2000


def make_log(folder):
    run = subprocess.run([STRAINFINGER, "run", "--duration", "20"], capture_output=True, text=True, check=True)
    lines = [line.replace(" loopback ", " can0 ") for line in run.stdout.splitlines()]
    path = os.path.join(folder, "long.log")
    block = "\n".join(lines) + "\n"
    with open(path, "w", encoding="ascii") as log:
        for _ in range(max(1, MEGABYTES * 1_000_000 // len(block))):
            log.write(block)
    return lines, path


def decode(path):
    """Bytes a second."""
    with open(path, "rb") as log:
        child = subprocess.Popen([STRAINFINGER, "decode"], stdin=log, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
    assert status == 0, status
    return os.path.getsize(path) / (usage.ru_utime + usage.ru_stime)


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
        rounds = [(decode(path), decode_by_canmatrix(matrix, lines)) for _ in range(ROUNDS)]
    ratio = sorted(ours / theirs for ours, theirs in rounds)[ROUNDS // 2]
    fastest = max(ours for ours, _ in rounds) / 1e6
    print(f"decode: {fastest:.0f} MB/s; canmatrix: "
          f"{max(theirs for _, theirs in rounds) / 1e6:.2f} MB/s; ratio, the middle of {ROUNDS} rounds: {ratio:.0f}")
    return 0 if ratio >= LEAST_RATIO and fastest >= LEAST_MB_PER_S else 1


if __name__ == "__main__":
    STRAINFINGER, MEGABYTES = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200
    sys.exit(main())
