#!/usr/bin/env python3
"""seeded_overflows_test.py COMPILER FOLDER LINKED...: the proof of ranges fails for the firmware with an overflow in it.

Each seed changes a copy of one header, which stands before the firmware's. LINKED: what CppUTest is linked with."""
import subprocess
import sys
import unittest
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[3]
RANGES = ROOT / "tests/firmware/ranges"
COMPILER, FOLDER, *LINKED = sys.argv[1:]
FOLDER = Path(FOLDER)


class Seed(NamedTuple):
    header: str  # of firmware/core
    text: str
    instead: str
    test: str


# Headers that are compiled with bounds: the proof's own tests fail ..
PROVED = [
    Seed("vector3", ">> 15", ">> 5", "AStepOfThreeReadingsAndItsAmplitudesOverflowNothing"),
    Seed("vector3", ">> 13", ">> 3", "AStepOfThreeReadingsAndItsAmplitudesOverflowNothing"),
    Seed("triple_step", "kLeastVolume = 1 << 16", "kLeastVolume = 1 << 14",
         "WhatThreeReadingsWeighInAnErrorOverflowsNothing"),
    Seed("told_start", "nonZero(low(even[0]))", "low(even[0])", "AToldStartOverflowsNothing"),
    Seed("near_triple", "nonZero(fall >> 8)", "fall >> 8", "TheThreeNearestReadingsBetweenNearRowsOverflowNothing"),
    Seed("quotients", "divisor <= 0 ? Number{0} : ", "", "AStepOverflowsNothing"),
    Seed("fit_step", "clipped<28>(slope)", "slope", "AStepOverflowsNothing"),
    Seed("error_products", "Wide{slope} * offset_sigma", "Wide{slope * offset_sigma}", "ErrorsOfLoadsOverflowNothing"),
]
# .. and those of which it has a model: that is no longer what they do.
MODELLED = [
    Seed("packed", "sum + dot(a, b)", "sum + dot(a, b) * 4", "AreWhatTheFirmwareDoesAtEveryCorner"),
    Seed("wide", "(value * value); }\nconstexpr Natural squared", "(value * value * 64); }\nconstexpr Natural squared",
         "AreWhatTheFirmwareDoesAtEveryCorner"),
]


def compiled(source, name, *options):
    """The object of a source, by its path from the root."""
    done = FOLDER / f"{name}.o"
    subprocess.run([COMPILER, "-std=c++20", "-O0", "-DCPPUTEST_USE_MEM_LEAK_DETECTION=0", *options, f"-I{ROOT}",
                    "-c", ROOT / source, "-o", done], check=True)
    return done


def proof_of(*folders):
    """The proof with headers of these folders before the firmware's."""
    return compiled(RANGES / "RangesTest.cpp", "ranges", f"-I{RANGES}", *(f"-I{folder}" for folder in folders))


def shipped(*folders):
    return compiled(RANGES / "primitives/shipped.cpp", "shipped", "-Dfirmware=shipped",
                    *(f"-I{folder}" for folder in folders))


class SeededOverflows(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        FOLDER.mkdir(parents=True, exist_ok=True)
        cls.main = compiled("tests/main.cpp", "main")
        cls.models = compiled(RANGES / "primitives/PrimitivesTest.cpp", "models", f"-I{RANGES}")

    def seeded(self, seed):
        """A folder with the changed header in it."""
        name = f"firmware/core/{seed.header}.hpp"
        text = (ROOT / name).read_text()
        if seed.text not in text:
            self.fail(f"no `{seed.text}` in {name} any more: say here what to change in it now")
        header = FOLDER / "seeded" / name
        header.parent.mkdir(parents=True, exist_ok=True)
        for other in header.parent.iterdir():
            other.unlink()
        header.write_text(text.replace(seed.text, seed.instead))
        return FOLDER / "seeded"

    def said(self, group, test, *objects):
        """What a test says; that it is there and ran."""
        program = FOLDER / "tests"
        subprocess.run([COMPILER, *objects, self.main, "-o", program, *LINKED], check=True)
        run = subprocess.run([program, "-sg", group, "-sn", test], capture_output=True, text=True)
        self.assertIn(" 1 ran", run.stdout, f"no test {group}.{test}")
        return run.stdout

    def fails(self, seed, group, *objects):
        said = self.said(group, seed.test, *objects)
        self.assertIn(f"Failure in TEST({group}, {seed.test})", said,
                      f"passes with `{seed.instead}` for `{seed.text}` in {seed.header}.hpp")

    def test_none_is_found_where_none_is(self):
        proof, primitives = proof_of(), shipped()
        for seed in PROVED:
            self.assertIn("\nOK (", self.said("Ranges", seed.test, proof))
        for seed in MODELLED:
            self.assertIn("\nOK (", self.said("Primitives", seed.test, self.models, primitives))

    def test_those_of_what_is_proved_are_found(self):
        for seed in PROVED:
            with self.subTest(seed.header, instead=seed.instead):
                self.fails(seed, "Ranges", proof_of(self.seeded(seed)))

    def test_those_of_what_the_proof_has_a_model_of_are_found(self):
        for seed in MODELLED:
            with self.subTest(seed.header, instead=seed.instead):
                self.fails(seed, "Primitives", self.models, shipped(self.seeded(seed)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
