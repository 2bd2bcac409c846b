#!/usr/bin/env python3
"""check_image_test.py: cmake/check_image.py on small images, each with one thing in it that it must find."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECKER = Path(__file__).parents[3] / "cmake" / "check_image.py"
FLAGS = ["-mcpu=cortex-m4", "-mthumb", "-O1", "-ffreestanding", "-fno-exceptions", "-fno-rtti", "-std=c++20",
         "-fstack-usage", "-fcallgraph-info=su"]
HARMLESS = "int volatile x; extern \"C\" void resetHandler() { x = x + 1; }"


class CheckImage(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def check(self, source, *budgets, flags=("-mfloat-abi=soft",)):
        """(exit status, all that was said) for an image of this source."""
        code, objects, elf = (self.folder / name for name in ("image.cpp", "image.o", "image.elf"))
        code.write_text(source)
        compiler = ["arm-none-eabi-g++", *FLAGS, *flags]
        subprocess.run([*compiler, "-c", code, "-o", objects], check=True)
        subprocess.run([*compiler, "-nostartfiles", "--specs=nosys.specs", "-Wl,-eresetHandler", "-Wl,--no-warnings",
                        objects, "-o", elf], check=True, capture_output=True)
        done = subprocess.run([sys.executable, CHECKER, *budgets, elf, "--objects", objects], capture_output=True,
                              text=True)
        return done.returncode, done.stdout + done.stderr

    def refused(self, what, source, *budgets, **options):
        status, said = self.check(source, *budgets, **options)
        self.assertIn(what, said)
        self.assertEqual(status, 1)

    def test_a_harmless_image_passes_with_its_figures(self):
        status, said = self.check(HARMLESS, "--flash", "2000", "--ram", "2000", "--stack", "100")
        self.assertEqual(status, 0, said)
        self.assertRegex(said, r"image: flash \d+ of 2000, ram 4 of 2000, stack \d+ of 100 bytes")

    def test_each_budget_is_enforced(self):
        self.refused("over the budget of 4", HARMLESS, "--flash", "4")
        self.refused("ram: 4 bytes, 1 over the budget of 3", HARMLESS, "--ram", "3")
        deep = "void use(int* p) { asm volatile(\"\" :: \"r\"(p)); } extern \"C\" void resetHandler() { int a[100]; use(a); }"
        self.refused("over the budget of 300", deep, "--stack", "300")

    def test_data_with_values_count_in_both_memories(self):
        source = "int volatile x[100] = {1}; extern \"C\" void resetHandler() { x[0] = x[1]; }"
        self.refused("over the budget of 399", source, "--flash", "399")
        self.refused("ram: 400 bytes, 1 over the budget of 399", source, "--ram", "399")
        self.refused("ram: 400 bytes", source.replace(" = {1}", ""), "--ram", "399")

    def test_every_fault_is_named(self):
        source = "int volatile x[100]; float volatile y; extern \"C\" void resetHandler() { y = y + x[0]; }"
        for what in ("flash: ", "ram: ", "floating point: __aeabi_fadd"):
            self.refused(what, source, "--flash", "4", "--ram", "4")

    def test_stack_adds_up_along_calls_and_with_an_interrupt_on_top(self):
        source = """template <int N> [[gnu::noinline]] void frame() { int a[N]; asm volatile("" :: "r"(a) : "memory"); }
            [[gnu::noinline]] void outer() { int a[50]; asm volatile("" :: "r"(a) : "memory"); frame<25>(); asm volatile(""); }
            extern "C" void handler() { frame<10>(); asm volatile(""); }
            extern "C" void resetHandler() { outer(); asm volatile(""); asm volatile("" :: "r"(handler)); }"""
        _, alone = self.check(source)
        _, interrupted = self.check(source, "--interrupt", "handler")
        stack = lambda said: int(said.split("stack ")[1].split()[0])
        self.assertTrue(300 <= stack(alone) <= 340, alone)  # 200 + 100, and saved registers
        self.assertTrue(36 + 40 <= stack(interrupted) - stack(alone) <= 36 + 40 + 24, interrupted)

    def test_a_call_at_the_end_needs_no_frame_but_its_own(self):
        source = """asm(".syntax unified; .thumb; .type deep, %function; .type outer, %function; .global outer;"
                        "deep: sub sp, #240; add sp, #240; bx lr;"
                        "outer: push {r4, lr}; sub sp, #200; LAST; b.w deep");
            extern "C" void outer(); extern "C" void resetHandler() { outer(); asm volatile(""); }"""
        stack = lambda last: int(self.check(source.replace("LAST", last))[1].split("stack ")[1].split()[0])
        for last in ("add sp, #200; ldmia.w sp!, {r4, lr}", "add sp, #204; ldr.w lr, [sp], #4"):
            self.assertEqual(stack(last), 8 + 240)
        for last in ("nop", "add sp, #204; ldr.w r4, [sp], #4", "ldmia.w sp!, {r4, r5}"):
            self.assertEqual(stack(last), 8 + 208 + 240)

    def test_a_heap_is_found(self):
        self.refused("heap: malloc is linked", """#include <stdlib.h>
            void* volatile p; extern "C" void resetHandler() { p = malloc(3); }""")
        self.refused("heap: _Znwj is linked", """extern "C" void* __dso_handle = nullptr;
            int* volatile p; extern "C" void resetHandler() { p = new int; }""")

    def test_floating_point_is_found(self):
        for text, routine in (("float", "__aeabi_fmul"), ("double", "__aeabi_dmul")):
            self.refused(f"floating point: {routine} is linked, called by resetHandler",
                         f"{text} volatile x; extern \"C\" void resetHandler() {{ x = x * x; }}")
        self.refused("floating point: vmul.f32", "float volatile x; extern \"C\" void resetHandler() { x = x * x; }",
                     flags=("-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"))

    def test_conversions_to_floating_point_are_found(self):
        self.refused("__aeabi_i2f is linked", "int volatile i; float volatile x; extern \"C\" void resetHandler() { x = i; }")
        self.refused("__aeabi_d2iz is linked", "int volatile i; double volatile x; extern \"C\" void resetHandler() { i = x; }")

    def test_division_of_integers_is_none(self):
        status, said = self.check("long long volatile x, y; extern \"C\" void resetHandler() { x = x / y; }")
        self.assertEqual(status, 0, said)

    def test_recursion_is_found(self):
        self.refused("recursion: ", """int volatile x; int down(int n) { int a[4] = {n}; asm volatile("" :: "r"(a) : "memory");
            return n == 0 ? 0 : down(n - 1) + a[0]; } extern "C" void resetHandler() { x = down(x); }""")

    def test_recursion_of_two_is_found(self):
        self.refused("recursion: ", """int volatile x; int odd(int n);
            [[gnu::noinline]] int even(int n) { return n == 0 ? 1 : odd(n - 1) + x; }
            [[gnu::noinline]] int odd(int n) { return n == 0 ? 0 : even(n - 1) + x; }
            extern "C" void resetHandler() { x = even(x); }""")

    def test_a_frame_of_no_fixed_size_is_found(self):
        self.refused("stack frame of no fixed size: resetHandler", """int volatile n; extern "C" void resetHandler() {
            void* p = __builtin_alloca(n); asm volatile("" :: "r"(p) : "memory"); }""")

    def test_the_path_of_its_sources_is_found(self):
        source = "char const* volatile p; extern \"C\" void resetHandler() { p = __FILE__; }"
        self.refused(f"path of the sources: {self.folder}/image.cpp", source, "--sources", str(self.folder))
        mapped = ("-mfloat-abi=soft", "-g", f"-fmacro-prefix-map={self.folder}/=")
        status, said = self.check(source, "--sources", str(self.folder), flags=mapped)
        self.assertEqual(status, 0, said)

    def test_a_last_call_through_a_pointer_is_found(self):
        self.refused("call through a pointer in resetHandler",
                     "void (*volatile f)(); extern \"C\" void resetHandler() { f(); }",
                     flags=("-mfloat-abi=soft", "-O2"))  # which makes it a jump

    def test_a_call_through_a_pointer_is_found(self):
        self.refused("call through a pointer in resetHandler",
                     "void (*volatile f)(); extern \"C\" void resetHandler() { f(); f(); }")


if __name__ == "__main__":
    if not shutil.which("arm-none-eabi-g++"):
        print("skipped: arm-none-eabi-g++ is not installed; cmake/setup.sh installs it", file=sys.stderr)
        sys.exit(1 if os.environ.get("STRAINFINGER_REQUIRE_VCAN") == "1" else 77)
    unittest.main(verbosity=2)
