#!/usr/bin/env python3
"""Writes st_literals.hpp: the numbers of a chip as its vendor's headers have them, under the vendor's names.

usage: make_literals.py HEADER... > st_literals.hpp

The tests beside this script say which numbers are wanted: every `st::NAME` in them. A NAME is a macro of the headers
(RCC_CR_HSION), or an instance and a register of its structure, joined by _ (RCC_CR: the address of RCC->CR). Headers: the
CMSIS device header (stm32g431xx.h) first, then those files of ST's drivers that define a wanted constant (stm32g4xx_hal_*.h,
stm32g4xx_ll_*.h, stm32g4xx_hal_fdcan.c). For another chip give its headers.
"""
import pathlib
import re
import sys

SIZES = {"uint8_t": 1, "uint16_t": 2, "uint32_t": 4, "uint64_t": 8}


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", " ", text.replace("\\\n", " "), flags=re.S)


def macros_of(text):
    """Macros without arguments, as text; the first definition of a name counts."""
    macros = {}
    for name, value in re.findall(r"^[ \t]*#[ \t]*define[ \t]+(\w+)[ \t]+(\S[^\n]*)$", text, flags=re.M):
        macros.setdefault(name, value.strip())
    return macros


def structures_of(text):
    """Offsets of the members of each structure of registers: {"RCC_TypeDef": {"CR": 0, ...}}."""
    structures = {}
    for body, name in re.findall(r"typedef\s+struct\s*\{([^{}]*)\}\s*(\w+)\s*;", text):
        offset, members = 0, {}
        for kind, member, count in re.findall(r"(uint\d+_t)\s+(\w+)\s*(?:\[(\d+)U?\])?\s*;", body):
            offset = -(-offset // SIZES[kind]) * SIZES[kind]
            members[member] = offset
            offset += SIZES[kind] * int(count or 1)
        structures[name] = members
    return structures


class Headers:
    def __init__(self, texts):
        text = without_comments("\n".join(texts))
        self.macros = macros_of(text)
        self.structures = structures_of(text)

    def value(self, expression):
        """Of a constant expression of C; None if it is none."""
        expression = re.sub(r"\(\s*u?int\d+_t\s*\)", "", expression)
        expression = re.sub(r"\b(0[xX][0-9A-Fa-f]+|\d+)[uUlL]*\b", r"\1", expression)
        for name in set(re.findall(r"\b[A-Za-z_]\w*\b", expression)):
            inner = self.value(self.macros[name]) if name in self.macros else None
            if inner is None:
                return None
            expression = re.sub(rf"\b{name}\b", str(inner), expression)
        if not re.fullmatch(r"[0-9A-Fa-fxX\s()+\-*|&~<>]+", expression):
            return None
        return eval(expression) & 0xFFFFFFFF  # digits and operators only: checked above

    def address(self, name):
        """Of a register INSTANCE_MEMBER; None if there is no such instance or member."""
        for at in [match.start() for match in re.finditer("_", name)]:
            instance = re.fullmatch(r"\(\((\w+) \*\)\s*(\w+)\)", self.macros.get(name[:at], ""))
            members = self.structures.get(instance[1], {}) if instance else {}
            if name[at + 1:] in members:
                return self.value(instance[2]) + members[name[at + 1:]]
        return None

    def literal(self, name):
        number = self.value(self.macros[name]) if name in self.macros else None
        return self.address(name) if number is None else number


def wanted_names():
    tests = [path for path in pathlib.Path(__file__).parent.glob("*.?pp") if path.name != "st_literals.hpp"]
    return sorted({name for path in tests for name in re.findall(r"\bst::(\w+)", path.read_text(encoding="utf-8"))})


def main(*paths):
    headers = Headers([pathlib.Path(path).read_text(encoding="utf-8", errors="replace") for path in paths])
    wanted = wanted_names()
    literals = {name: headers.literal(name) for name in wanted}
    missing = [name for name, number in literals.items() if number is None]
    if missing:
        sys.exit(f"make_literals.py: no header defines {', '.join(missing)}: give the header that does.")
    print("#pragma once\n"
          "// Made by make_literals.py: numbers of the STM32G431 as ST's headers have them, under ST's names.\n\n"
          "#include <cstdint>\n\n"
          "namespace st {\n")
    for name, number in literals.items():
        print(f"inline constexpr std::uint32_t {name} = 0x{number:08X};")
    print("\n}  // namespace st")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
