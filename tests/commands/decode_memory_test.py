"""`strainfinger decode` takes no more memory for a log ten times as long.

usage: decode_memory_test.py STRAINFINGER [MEGABYTES]
MEGABYTES (default 20) is the longer log's size. Memory is read while the program waits for more of a log that it has read but
for what a pipe holds; that which the system counts at the end has this program's in it, from before the other began.
"""
import subprocess
import sys

MEMORY_SPREAD_KIB = 2048


def largest_memory_kib(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmHWM:"))


def decode(program, block, megabytes):
    """The largest memory in KiB."""
    child = subprocess.Popen([program, "decode"], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(max(1, round(megabytes * 1e6 / len(block)))):
        child.stdin.write(block)
    child.stdin.flush()
    memory_kib = largest_memory_kib(child.pid)
    child.stdin.close()
    assert child.wait() == 0, child.returncode
    return memory_kib


def main():
    program, megabytes = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 20
    block = subprocess.run([program, "run", "--duration", "5"], capture_output=True, check=True).stdout
    short, long = decode(program, block, megabytes / 10), decode(program, block, megabytes)
    print(f"memory: {long} KiB for {megabytes:g} MB, {short} KiB for a tenth of it")
    return 0 if long <= short + MEMORY_SPREAD_KIB else 1


if __name__ == "__main__":
    sys.exit(main())
