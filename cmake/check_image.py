#!/usr/bin/env python3
"""Flash, RAM and worst-case stack of a bare-metal image against its budgets.

    check_image.py [--flash N] [--ram N] [--stack N] [--interrupt HANDLER]... [--sources FOLDER]
                   IMAGE.elf --objects a.o b.o ...

Fails when a budget is exceeded, and when the image contains a heap, floating point (instructions or the compiler's
routines), recursion, calls through pointers, a stack frame of unknown size, or the path of its sources (it would be
another image in another folder): each is named, with where it is.

The call graph is that of the linked image (its disassembly), so it has what the linker and the libraries added.
Frame sizes are the larger of what the compiler says (-fcallgraph-info=su beside each object) and what a function's
instructions push: the compiler leaves out arguments that it stores beside those of its caller, and library functions
have only their instructions.
"""
import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

TOOLS = "arm-none-eabi-"
EXCEPTION_FRAME = 32 + 4  # r0-r3, r12, lr, pc, xPSR, and alignment to 8 bytes (Armv7-M ARM, B1.5.7); no FPU

HEAP = re.compile(r"_?(malloc|calloc|realloc|free|sbrk)(_r)?$|_Zn[wa]|_Zd[la]")
SOFT_FLOAT = re.compile(
    r"__aeabi_(c?[fd](?!iv0)\w+|[ul]?i?2[fd]|u?l2[fd])$|__\w+[sd]f[23]?$|__(float|fix)\w+$")
FLOAT_INSTRUCTION = re.compile(r"v(add|sub|mul|div|mla|mls|nm|fm|fn|neg|abs|sqrt|cmp|cvt|mov|ldr|str|ldm|stm|push|pop|mrs|msr)")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Function:
    def __init__(self, name):
        self.name = name
        self.instructions = []  # (mnemonic, operands)
        self.calls = set()  # addresses
        self.ends = set()  # addresses of functions that it goes on to once its own frame is given back
        self.indirect = False
        self.frame = 0


def leaves_through_a_pointer(mnemonic, operands, before):
    """Not a return: those are to lr, or to what was pushed (on the M0+ popped just before)."""
    if mnemonic.startswith("blx"):
        return True
    if mnemonic.startswith("bx"):
        return operands != "lr" and before != ("pop", f"{{{operands}}}")
    if mnemonic.startswith("mov"):
        return re.match(r"pc, (?!lr)", operands) is not None
    return mnemonic.startswith("ldr") and re.match(r"pc, (?!\[sp)", operands) is not None


def gives_back_its_frame(mnemonic, operands):
    """The last step before a call at the end (a branch that doesn't come back): lr is as the caller left it."""
    if mnemonic.startswith("ldr"):
        return operands.startswith("lr, [sp], #")
    pops = mnemonic.startswith("pop") or (mnemonic.startswith("ldmia") and operands.startswith("sp!"))
    return pops and re.search(r"\blr}", operands) is not None


def disassembled(elf):
    """Functions by address. A call is any branch to another function's address."""
    functions, current = {}, None
    for line in run(TOOLS + "objdump", "-d", "--no-show-raw-insn", elf).splitlines():
        start = re.match(r"([0-9a-f]+) <(.+)>:$", line)
        if start:
            current = functions.setdefault(int(start[1], 16), Function(start[2]))
            continue
        step = re.match(r"\s*[0-9a-f]+:\s+(\S+)\s*(.*)$", line)
        if current and step and not step[1].startswith("."):
            current.instructions.append((step[1], step[2]))
    for function in functions.values():
        before = ("", "")
        for mnemonic, operands in function.instructions:
            target = re.search(r"\b([0-9a-f]+) <([^>+]+)>", operands)
            if mnemonic.startswith("b") and target and (target[2] != function.name or mnemonic in ("bl", "blx")):
                ends = not mnemonic.startswith("bl") and gives_back_its_frame(*before)
                (function.ends if ends else function.calls).add(int(target[1], 16))
            if not target and leaves_through_a_pointer(mnemonic, operands, before):
                function.indirect = True
            if not (mnemonic.startswith("add") and operands.startswith("sp, #")):
                before = (mnemonic, operands)
    return functions


def pushed(function):
    """Bytes that instructions take from the stack, all of them together, whether or not on one path."""
    size = 0
    for mnemonic, operands in function.instructions:
        if mnemonic.startswith("push") or (mnemonic.startswith("stmdb") and operands.startswith("sp!")):
            size += 4 * registers(operands[operands.index("{") + 1:operands.index("}")])
        elif re.match(r"sub", mnemonic) and re.match(r"sp, (sp, )?#(\d+)", operands):
            size += int(re.match(r"sp, (?:sp, )?#(\d+)", operands)[1])
        elif mnemonic.startswith("str") and re.search(r"\[sp, #-(\d+)\]!", operands):
            size += int(re.search(r"\[sp, #-(\d+)\]!", operands)[1])
    return size


def registers(text):
    """How many: "r4, r5-r7, lr" is five."""
    number = {"sl": 10, "fp": 11, "ip": 12, "sp": 13, "lr": 14, "pc": 15}
    index = lambda name: number.get(name) or int(name[1:])
    ends = [[index(name.strip()) for name in part.split("-")] for part in text.split(",")]
    return sum(end[-1] - end[0] + 1 for end in ends)


def compiler_frames(objects):
    """Largest frame of each function name, and the names of those with frames of no fixed size."""
    frames, unbounded = {}, set()
    for graph in (Path(name).with_suffix(".ci") for name in objects):
        if not graph.exists():
            sys.exit(f"check_image: {graph} is missing: compile with -fcallgraph-info=su")
        for title, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]+)"', graph.read_text()):
            size = re.search(r"(\d+) bytes \(([a-z,]+)\)", label)
            if not size:
                continue
            name = title.rsplit(":", 1)[-1]
            frames[name] = max(frames.get(name, 0), int(size[1]))
            if size[2] == "dynamic":
                unbounded.add(name)
    return frames, unbounded


def sections(elf):
    """(name, size, in flash, in RAM) of what is in the memories."""
    rows = re.findall(r"\]\s+(\.\S+)\s+(\S+)\s+([0-9a-f]+) [0-9a-f]+ ([0-9a-f]+) \S+\s+(\w*)",
                      run(TOOLS + "readelf", "-SW", elf))
    for name, kind, _, size, flags in rows:
        if "A" in flags:
            yield name, int(size, 16), kind != "NOBITS", "W" in flags or kind == "NOBITS"


def loaded(elf):
    """The bytes that are written to the flash."""
    with tempfile.NamedTemporaryFile() as file:
        run(TOOLS + "objcopy", "-O", "binary", elf, file.name)
        return Path(file.name).read_bytes()


class Stack:
    """Deepest use from a function on, by depth-first search."""

    def __init__(self, functions, complain):
        self.functions, self.complain = functions, complain
        self.deepest, self.open = {}, []

    def most_of(self, addresses):
        return max((self.of(call) for call in sorted(addresses) if call in self.functions),
                   default=(0, []), key=lambda found: found[0])

    def of(self, address):
        """(bytes, names along the deepest path)"""
        if address in self.open:
            cycle = self.open[self.open.index(address):] + [address]
            self.complain("recursion: " + " -> ".join(self.functions[a].name for a in cycle))
            return 0, []
        if address not in self.deepest:
            function = self.functions[address]
            self.open.append(address)
            below, instead = self.most_of(function.calls), self.most_of(function.ends)
            self.open.pop()
            within = (function.frame + below[0], [(function.name, function.frame)] + below[1])
            self.deepest[address] = max(within, instead, key=lambda found: found[0])
        return self.deepest[address]


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("elf")
    parser.add_argument("--objects", nargs="+", default=[], help="object files; lists with ; are split")
    for budget in ("flash", "ram", "stack"):
        parser.add_argument("--" + budget, type=int)
    parser.add_argument("--report", help="file to write the figures to, too")
    parser.add_argument("--interrupt", action="append", default=[])
    parser.add_argument("--sources", help="folder whose path may not be in the image")
    return parser.parse_args()


def main():
    options, faults = arguments(), []
    complain = lambda text: faults.append(text) if text not in faults else None
    functions = disassembled(options.elf)
    by_name = {function.name: address for address, function in functions.items()}
    frames, unbounded = compiler_frames([name for part in options.objects for name in part.split(";") if name])
    for function in functions.values():
        function.frame = max(frames.get(function.name, 0), pushed(function))
        for mnemonic, operands in function.instructions:
            if FLOAT_INSTRUCTION.match(mnemonic):
                complain(f"floating point: {mnemonic} {operands} in {function.name}")

    for symbol in run(TOOLS + "nm", options.elf).split("\n"):
        name = symbol.split(" ")[-1]
        if HEAP.match(name):
            complain(f"heap: {name} is linked")
        if SOFT_FLOAT.match(name):
            callers = [f.name for f in functions.values() if by_name.get(name) in f.calls]
            complain(f"floating point: {name} is linked, called by {', '.join(callers) or 'nobody'}")

    stack = Stack(functions, complain)
    deepest, path = stack.of(by_name["resetHandler"])
    handlers = [stack.of(by_name[name]) for name in options.interrupt]
    if handlers:
        above = max(handlers, key=lambda found: found[0])
        deepest, path = deepest + EXCEPTION_FRAME + above[0], path + [("(exception)", EXCEPTION_FRAME)] + above[1]
    for address in stack.deepest:
        function = functions[address]
        if function.indirect:
            complain(f"call through a pointer in {function.name}: its stack is not known")
        if function.name in unbounded:
            complain(f"stack frame of no fixed size: {function.name}")

    if options.sources:
        for path in re.findall(re.escape(options.sources.encode()) + rb"[^\0]*", loaded(options.elf)):
            complain(f"path of the sources: {path.decode()}, as of an assertion")

    used = {"flash": 0, "ram": 0, "stack": deepest}
    for _, size, in_flash, in_ram in sections(options.elf):
        used["flash"] += size if in_flash else 0
        used["ram"] += size if in_ram else 0
    for what, size in used.items():
        budget = getattr(options, what)
        if budget and size > budget:
            complain(f"{what}: {size} bytes, {size - budget} over the budget of {budget}")
            if what == "stack":
                complain("  " + " > ".join(f"{name} {frame}" for name, frame in path))

    name = Path(options.elf).stem
    figures = ", ".join(f"{what} {size}" + (f" of {getattr(options, what)}" if getattr(options, what) else "")
                        for what, size in used.items())
    print(f"{name}: {figures} bytes", flush=True)
    if options.report:
        Path(options.report).write_text(figures + "\n")
    for fault in faults:
        print(f"{name}: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
