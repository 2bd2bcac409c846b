#!/usr/bin/env python3
"""seeded_overflows_test.py COMPILER FOLDER LINKED...: the proof of ranges fails for the firmware with an overflow in it.

Each seed changes a copy of one of the firmware's files, which stands before it. LINKED: what CppUTest is linked with."""
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
    proof: str  # the proof that finds it
    file: str  # of firmware/core
    text: str
    instead: str
    test: str


# Files that are compiled with bounds: the proof's own tests fail ..
PROVED = [
    Seed("NormalEquations", "normal_equations.cpp", "dot(column, columns[index(j)].data(), rows) - product(",
         "4 * dot(column, columns[index(j)].data(), rows) - product(", "ADecompositionOverflowsNothing"),
    Seed("NormalEquations", "normal_equations.cpp", "sum += Wide{lower_q20[m]}", "sum += 4 * Wide{lower_q20[m]}",
         "ADecompositionOverflowsNothing"),
    Seed("NormalEquations", "normal_equations.cpp", "kInverseLimitBits = 29", "kInverseLimitBits = 30",
         "VariancesOverflowNothing"),
    Seed("NormalEquations", "normal_equations.cpp", "limited(Wide{wanted} - taken, 1 << 24)",
         "limited(Wide{wanted} - taken, 1 << 29)", "AStepOfDeterminedUnknownsOverflowsNothing"),
    Seed("NormalEquations", "normal_equations.cpp", "Wide{1} << 34", "Wide{1} << 40",
         "AStepOfDeterminedUnknownsOverflowsNothing"),
    Seed("NormalEquations", "normal_equations.cpp", "kSpareBits = 10", "kSpareBits = 2", "VariancesOverflowNothing"),
    Seed("Response", "response.hpp", "patch[2] * (1 << 15) +", "2 * patch[2] * (1 << 15) +", "APatchOverflowsNothing"),
    Seed("Response", "response.hpp", "along_q30 + curved,", "along_q30 + 2 * curved,", "APatchOverflowsNothing"),
    Seed("Response", "response.hpp", "moment_q20 - middle", "4096 * moment_q20 - middle", "CellsOfAnyWidthOverflowNothing"),
    Seed("Response", "response.hpp", "(to - from) * point.along_q15", "(to - from) * 512 * point.along_q15",
         "AShapeOfAnyPointsOverflowsNothing"),
    Seed("Fit", "fit.cpp", "limited(scaled<GaugeDepths::kStepsBits>(normal, depth), kMostValue)",
         "scaled<GaugeDepths::kStepsBits>(normal, depth)", "ReadingsOfAContactOverflowNothing"),
    Seed("Fit", "fit.cpp", "bitWidth(most) - 15", "bitWidth(most) - 17", "SlipOverflowsNothing"),
    Seed("Fit", "fit.cpp", "bitWidth(bits) - kFactorBits", "bitWidth(bits) - kFactorBits - 3",
         "ReadingsOfAContactOverflowNothing"),
    Seed("Fit", "fit.cpp", "kAngleBits = 10", "kAngleBits = 13", "ReadingsOfAContactOverflowNothing"),
    Seed("Fit", "fit.cpp", "kMostTurn_q32 >> 15", "kMostTurn_q32 >> 7", "AStepThatIsTakenOverflowsNothing"),
    Seed("Fit", "fit.cpp", "limited(from + (step.x_q14", "limited(from + 16 * (step.x_q14", "AStepThatIsTakenOverflowsNothing"),
    Seed("Fit", "fit.cpp", "reduction * reduction", "reduction * reduction * 4",
         "ConvergenceOfAnyReductionOverflowsNothing"),
    Seed("Fit", "fit.cpp", "magnitude(to.normal - from.normal)", "magnitude((to.normal - from.normal) * 2048)",
         "ConvergenceOfAnyStepOverflowsNothing"),
    Seed("Readings", "hypothesis.hpp", "error * error + noise", "error * error * error * error + noise",
         "AnyStrainsNoiseAndShiftOverflowNothing"),
    Seed("Readings", "condition.hpp", "code * (1 << kCodeBits) - zero", "code * (1 << kCodeBits) - 2 * zero",
         "AnyCodesZerosAndGainsOverflowNothing"),
    Seed("Readings", "units.hpp", "saturate<Number>((", "static_cast<Number>((", "UnitsOverflowNothing"),
]
# .. and those of which it has a model: that is no longer what they do.
MODELLED = [
    Seed("", "integers.hpp", "sum += a[i] * b[i];", "sum += 4 * a[i] * b[i];", "AreWhatTheFirmwareDoesAtEveryCorner"),
    Seed("", "integers.hpp", "return {static_cast<std::int32_t>(mantissa >> 1)", "return {static_cast<std::int32_t>(mantissa)",
         "AreWhatTheFirmwareDoesAtEveryCorner"),
]


def compiled(source, name, *options):
    """The object of a source, by its path from the root."""
    done = FOLDER / f"{name}.o"
    subprocess.run([COMPILER, "-std=c++20", "-O0", "-DCPPUTEST_USE_MEM_LEAK_DETECTION=0", *options, f"-I{ROOT}",
                    "-c", ROOT / source, "-o", done], check=True)
    return done


def proof_of(proof, *folders):
    """A proof with the files of these folders before the firmware's."""
    return compiled(RANGES / f"{proof}RangesTest.cpp", proof, *(f"-I{folder}" for folder in folders), f"-I{RANGES}")


def shipped(*folders):
    return compiled(RANGES / "primitives/shipped.cpp", "shipped", "-Dfirmware=shipped",
                    *(f"-I{folder}" for folder in folders))


class SeededOverflows(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        FOLDER.mkdir(parents=True, exist_ok=True)
        cls.main = compiled("tests/main.cpp", "main")
        cls.models = compiled(RANGES / "primitives/PrimitivesTest.cpp", "models", f"-I{RANGES}")
        cls.equations = compiled("firmware/core/normal_equations.cpp", "equations", f"-I{RANGES}")

    def seeded(self, seed):
        """A folder with the changed file in it."""
        name = f"firmware/core/{seed.file}"
        text = (ROOT / name).read_text()
        if seed.text not in text:
            self.fail(f"no `{seed.text}` in {name} any more: say here what to change in it now")
        file = FOLDER / "seeded" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        for other in file.parent.iterdir():
            other.unlink()
        file.write_text(text.replace(seed.text, seed.instead))
        return FOLDER / "seeded"

    def needed(self, proof):
        """What a proof is linked with: the fit calls the normal equations."""
        return [self.equations] if proof == "Fit" else []

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
                      f"passes with `{seed.instead}` for `{seed.text}` in {seed.file}")

    def test_none_is_found_where_none_is(self):
        for proof in sorted({seed.proof for seed in PROVED}):
            unchanged = proof_of(proof)
            for test in sorted({seed.test for seed in PROVED if seed.proof == proof}):
                self.assertIn("\nOK (", self.said(f"{proof}Ranges", test, unchanged, *self.needed(proof)))
        for seed in MODELLED:
            self.assertIn("\nOK (", self.said("Primitives", seed.test, self.models, shipped()))

    def test_those_of_what_is_proved_are_found(self):
        for seed in PROVED:
            with self.subTest(seed.file, instead=seed.instead):
                self.fails(seed, f"{seed.proof}Ranges", proof_of(seed.proof, self.seeded(seed)), *self.needed(seed.proof))

    def test_those_of_what_the_proof_has_a_model_of_are_found(self):
        for seed in MODELLED:
            with self.subTest(seed.file, instead=seed.instead):
                self.fails(seed, "Primitives", self.models, shipped(self.seeded(seed)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
