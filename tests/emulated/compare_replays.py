#!/usr/bin/env python3
"""compare_replays.py BLOCKS REFERENCE CANDIDATE: the firmware's logic on two machines or of two compilers, bit for bit.

REFERENCE is a program for this machine (replay_host.cpp), and what it says of every block is in REFERENCE.txt; CANDIDATE
is one too, or an .elf for an emulated board (target/replay_target.cpp). Where a block's hash differs, the first sample
set in it that does is found and named.
"""
import subprocess
import sys

import emulator

SAMPLES_PER_BLOCK = 1024


def lines_of(image, *arguments):
    arguments = [str(argument) for argument in arguments]
    if image.endswith(".elf"):
        return emulator.output_of(image, arguments).splitlines()
    return subprocess.run([image, *arguments], check=True, capture_output=True, text=True).stdout.splitlines()


def first_difference(ours, theirs):
    """The first pair of lines that differ, or None."""
    if len(ours) != len(theirs):
        sys.exit(f"{len(ours)} lines and {len(theirs)} lines: one of them ended early")
    return next((pair for pair in zip(ours, theirs) if pair[0] != pair[1]), None)


def main():
    blocks, reference, candidate = int(sys.argv[1]), sys.argv[2], sys.argv[3]
    emulator.require(*([candidate] if candidate.endswith(".elf") else []))
    with open(reference + ".txt") as told:
        ours = told.read().splitlines()[:blocks]
    if len(ours) != blocks:
        sys.exit(f"{reference}.txt: {len(ours)} lines for {blocks} blocks")
    theirs = lines_of(candidate, 0, blocks)
    different = first_difference(ours, theirs)
    if not different:
        print(f"{blocks * SAMPLES_PER_BLOCK} sample sets, {blocks} blocks, no difference")
        return 0
    block = different[0].split()[1]
    sample = first_difference(lines_of(reference, block, 1, "detail"), lines_of(candidate, block, 1, "detail"))
    count = sum(a != b for a, b in zip(ours, theirs))
    print(f"{count} of {blocks} blocks differ. First difference: block {block}, sample set {sample[0].split()[0]}")
    return 1


if __name__ == "__main__":
    sys.exit(main())
