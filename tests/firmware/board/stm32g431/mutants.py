#!/usr/bin/env python3
"""Wrong drivers, and whether the tests beside this script notice.

usage: mutants.py --root SOURCES --build DIR [--compiler G++] [--part N SEED | --only NUMBER...]

Each mutant is a driver with one mistake: a text of a file replaced by another. The test programs that see the file are compiled
with it (in DIR) and run; a mutant is killed if one of them fails, or does not compile. With --part only one in N is tried,
chosen by SEED. Exit status: 1 if less than 95 % are killed, or if one survives that is not excused.
"""
import argparse
import collections
import pathlib
import random
import re
import subprocess
import sys

TESTS = "tests/firmware/board/stm32g431"
BOARD = "firmware/board/stm32g431"

# Which tests see which file; the first is the likeliest to notice.
SEEN_BY = {
    "registers/": ["RegistersTest"],
    "gauge_converter.hpp": ["GaugeConverterTest"],
    "sampling.hpp": ["GaugeConverterTest"],
    "pinout.hpp": ["PinoutTest", "GaugeConverterTest", "SystemTest"],
    "clock_tree.hpp": ["ClockTreeTest"],
    "fdcan_port.hpp": ["FdcanPortTest"],
    "bit_timing.hpp": ["BitTimingTest"],
    "flash_store.hpp": ["FlashStoreTest"],
    "flash_ecc.hpp": ["FlashStoreTest"],
    "watchdog.hpp": ["SystemTest"],
    "microsecond_clock.hpp": ["SystemTest"],
    "unique_id.hpp": ["SystemTest"],
    "registers/clocks.hpp": ["RegistersTest", "ClockTreeTest"],
    "registers/gpio.hpp": ["RegistersTest", "SystemTest"],
    "registers/register.hpp": ["ClockTreeTest", "SystemTest"],
}

SLOW_TEST = "CountsOnWhenTheCountersWrap"  # 65,536 sets, and nothing that it alone would notice

COMMON_HEADERS = ["algorithm", "array", "cstdint", "cstring", "deque", "functional", "map", "optional", "set", "span", "string",
                  "utility", "vector", "CppUTest/TestHarness.h"]

def swapped(file, first, second, *excuse):
    """The second before the first."""
    return file, f"{first} {second}", f"{second} {first}", *excuse


# By what is wrong with them: [file, what is there, what the mistake puts there; a fourth: why no test can notice].
MUTANTS = {
    "clocks not enabled, or the wrong ones": [
        ("gauge_converter.hpp", "Rcc::Ahb1Enr::dma1(1) | Rcc::Ahb1Enr::dmamux(1)", "Rcc::Ahb1Enr::dmamux(1)"),
        ("gauge_converter.hpp", "Rcc::Ahb1Enr::dma1(1) | Rcc::Ahb1Enr::dmamux(1)", "Rcc::Ahb1Enr::dma1(1)"),
        ("gauge_converter.hpp", "Rcc::Ahb2Enr::adc12(1) | ", ""),
        ("gauge_converter.hpp", "Rcc::Ahb2Enr::gpioA(1) | ", ""),
        ("gauge_converter.hpp", " |\n                          Rcc::Ahb2Enr::gpioC(1)", ""),
        ("gauge_converter.hpp", "enableClock(bus_, Rcc::Apb1Enr1::tim3(1));", "enableClock(bus_, Rcc::Apb1Enr1::tim2(1));"),
        ("gauge_converter.hpp", "    enableClock(bus_, Rcc::Apb2Enr::tim1(1));\n", ""),
        ("fdcan_port.hpp", "    enableClock(bus_, Rcc::Apb1Enr1::fdcan(1));\n", ""),
        ("microsecond_clock.hpp", "    enableClock(bus_, Rcc::Apb1Enr1::tim2(1));\n", ""),
        ("clock_tree.hpp", "    enableClock(bus_, Rcc::Apb1Enr1::pwr(1));\n", ""),
        ("pinout.hpp", "  enableClock(bus, Rcc::Ahb2Enr::gpioA(1));\n", ""),
        ("registers/clocks.hpp", "  static_cast<void>(bus.read(EnableRegister::address));\n", ""),
    ],
    "bases": [
        ("registers/adc.hpp", "Adc<0x5000'0000>", "Adc<0x5000'0100>"),
        ("registers/adc.hpp", "base = 0x5000'0300", "base = 0x5000'0200"),
        ("registers/adc.hpp", "base = 0x4002'0000", "base = 0x4002'0400"),
        ("registers/adc.hpp", "Register<0x4002'0800>", "Register<0x4002'0804>"),
        ("registers/fdcan.hpp", "base = 0x4000'6400", "base = 0x4000'6800"),
        ("registers/fdcan.hpp", "base = 0x4000'A400", "base = 0x4000'A000"),
        ("registers/system.hpp", "base = 0x4000'3000", "base = 0x4000'2C00"),
        ("registers/system.hpp", "base = 0x1FFF'7590", "base = 0x1FFF'7A10"),
        ("registers/system.hpp", "Register<0xE004'2008>", "Register<0xE004'200C>"),
    ],
    "offsets": [
        ("registers/adc.hpp", "Register<kBase + 0x14>", "Register<kBase + 0x18>"),
        ("registers/adc.hpp", "struct Cndtr1 : Register<base + 0x0C>", "struct Cndtr1 : Register<base + 0x10>"),
        ("registers/clocks.hpp", "struct Apb1Enr1 : Register<base + 0x58>", "struct Apb1Enr1 : Register<base + 0x5C>"),
        ("registers/clocks.hpp", "struct Cr5 : Register<base + 0x80>", "struct Cr5 : Register<base + 0x90>"),
        ("registers/fdcan.hpp", "base + 0x278", "base + 0x188"),
        ("registers/fdcan.hpp", "base + 0xB0 +", "base + 0x188 +"),
        ("registers/fdcan.hpp", "struct Rxgfc : Register<base + 0x80>", "struct Rxgfc : Register<base + 0x84>"),
        ("registers/gpio.hpp", "portStride = 0x400", "portStride = 0x800"),
        ("registers/gpio.hpp", "alternate = 0x20", "alternate = 0x24"),
    ],
    "fields": [
        ("registers/adc.hpp", "Field<Cfgr, 5, 5> trigger", "Field<Cfgr, 6, 4> trigger"),
        ("registers/adc.hpp", "Field<Isr, 4> overrun", "Field<Isr, 3> overrun"),
        ("registers/clocks.hpp", "Field<PllCfgr, 8, 7> multiply", "Field<PllCfgr, 8, 8> multiply"),
        ("registers/clocks.hpp", "Field<Ccipr, 24, 2> fdcanClock", "Field<Ccipr, 26, 2> fdcanClock"),
        ("registers/fdcan.hpp", "Field<Nbtp, 25, 7> jump", "Field<Nbtp, 24, 7> jump"),
        ("registers/fdcan.hpp", "Field<Element0, 18, 11> standardId", "Field<Element0, 0, 11> standardId"),
        ("registers/flash.hpp", "Field<Cr, 3, 6> page", "Field<Cr, 2, 6> page"),
    ],
    "values": [
        ("registers/adc.hpp", "kRegularSimultaneous = 6", "kRegularSimultaneous = 7"),
        ("registers/adc.hpp", "kBothInAWord = 2", "kBothInAWord = 3"),
        ("registers/flash.hpp", "firstKey = 0x4567'0123", "firstKey = 0x0819'2A3B"),
        ("registers/flash.hpp", "errors = 0x0000'03FA", "errors = 0x0000'03F8"),
        ("registers/register.hpp", "(bus.read(Reg::address) & ~bits.mask) | bits.value", "bits.value"),
        ("gauge_converter.hpp", "Cfgr::overwrite(1)", "Cfgr::overwrite(0)"),
        ("clock_tree.hpp", " ? Rcc::kFdcanFromHse : Rcc::kFdcanFromPclk1", " ? Rcc::kFdcanFromPclk1 : Rcc::kFdcanFromHse"),
        ("fdcan_port.hpp", "Rxgfc::otherStandard(ids.empty() ? Fdcan::kToFifo0 : Fdcan::kReject)",
         "Rxgfc::otherStandard(Fdcan::kToFifo0)"),
        ("flash_store.hpp", "Flash::Cr::page(number)", "Flash::Cr::page(static_cast<std::uint32_t>(page))"),
        ("flash_ecc.hpp", "EccR::corrected(1) | EccR::detected(1)", "EccR::detected(1)"),
        ("watchdog.hpp", "kDivideBy16 = 2", "kDivideBy16 = 3"),
        ("pinout.hpp", "kCanFunction = 9", "kCanFunction = 10"),
        ("pinout.hpp", "{{Port::kB, 12}, 11}", "{{Port::kB, 12}, 12}"),
    ],
    "trigger and request sources": [
        ("registers/adc.hpp", "kTim1Trgo = 9", "kTim1Trgo = 10"),
        ("registers/adc.hpp", "kAdc1 = 5", "kAdc1 = 36"),
        ("registers/timers.hpp", "kItr0 = 0", "kItr0 = 1"),
        ("registers/timers.hpp", "kCountInput = 7", "kCountInput = 4"),
        ("registers/timers.hpp", "kAtUpdate = 2", "kAtUpdate = 1"),
        ("gauge_converter.hpp", " | Cfgr::triggerEdge(trigger != kSlave)", ""),
        ("gauge_converter.hpp", "    write(bus_, Dmamux::C0cr::request(Dmamux::kAdc1));\n", ""),
        ("gauge_converter.hpp", "Adc12::Cdr::address);\n    bus_.write", "Adc12::Ccr::address);\n    bus_.write"),
    ],
    "lengths and dividers": [
        ("registers/fdcan.hpp", "elementBytes = 18 * 4", "elementBytes = 16 * 4"),
        ("gauge_converter.hpp", "Cfgr2::ratio(plan.oversamplingLog2 - 1)", "Cfgr2::ratio(plan.oversamplingLog2)"),
        ("gauge_converter.hpp", "Cfgr2::shift(plan.oversamplingLog2 - 4)", "Cfgr2::shift(plan.oversamplingLog2 - 3)"),
        ("gauge_converter.hpp", "(kPairs - 1) | sequence(inputs, 0, 4, 6)", "kPairs | sequence(inputs, 0, 4, 6)"),
        ("gauge_converter.hpp", "kWords = 2 * kPairs", "kWords = kPairs"),
        ("gauge_converter.hpp", "plan.period_us() - 1", "plan.period_us()"),
        ("clock_tree.hpp", "PllCfgr::divideIn(plan.divideIn - 1)", "PllCfgr::divideIn(plan.divideIn)"),
        ("clock_tree.hpp", "PllCfgr::divideOut(plan.divideOut / 2 - 1)", "PllCfgr::divideOut(plan.divideOut / 2)"),
        ("fdcan_port.hpp", "Fdcan::Nbtp::prescaler(timing.prescaler - 1U)", "Fdcan::Nbtp::prescaler(timing.prescaler)"),
        ("fdcan_port.hpp", "bus_.write(element + 4, Element1::length(frame.length).value)", "bus_.write(element + 4, 0)"),
        ("watchdog.hpp", "kUpdate_ms = 6 * 256 * 10 / 295 + 1", "kUpdate_ms = 1"),
        ("microsecond_clock.hpp", "kCore_hz / 1'000'000 - 1", "kCore_hz / 1'000'000"),
    ],
    "orders": [
        ("gauge_converter.hpp", "sequence(inputs, 4, 4, 0)", "sequence(inputs, 4, 4, 6)"),
        ("gauge_converter.hpp", "configure<Adc2>(plan, kOddGauges, kSlave)", "configure<Adc2>(plan, kEvenGauges, kSlave)"),
        ("gauge_converter.hpp", "(sets & 1) != 0 ? 0 : kPairs", "(sets & 1) != 0 ? kPairs : 0"),
        swapped("gauge_converter.hpp", "modify(bus_, Adc12::Ccr::dmaMode(Adc12::kBothInAWord));",
                "write(bus_, regulated<Adc1>() | Adc1::Cr::start(1));"),
        swapped("gauge_converter.hpp",
                "if (!calibrate<Adc1>() || !calibrate<Adc2>()) return false; "
                "waitCycles<Adc1::Isr>(bus_, kAfterCalibration_cycles);",
                "if (!enable<Adc1>() || !enable<Adc2>()) return false;"),
        swapped("gauge_converter.hpp", "write(bus_, regulated<Adc1>() | Adc1::Cr::start(1));",
                "waitCycles<Adc1::Isr>(bus_, kAfterStart_cycles);"),
        swapped("gauge_converter.hpp", "modify(bus_, Adc12::Ccr::dmaMode(Adc12::kNoDma));", "write(bus_, Dma1::Ccr1::enable(0));",
                "both are off before anything runs again"),
        swapped("clock_tree.hpp", "modify(bus_, Rcc::Cfgr::ahbPrescaler(Rcc::kHalf));", "modify(bus_, Pwr::Cr5::normalMode(0));"),
        swapped("clock_tree.hpp", "enableClock(bus_, Rcc::Apb1Enr1::pwr(1));", "modify(bus_, Pwr::Cr1::voltageRange(1));"),
        swapped("clock_tree.hpp", "waitCycles<Rcc::Cfgr>(bus_, kCore_hz / 1'000'000);",
                "modify(bus_, Rcc::Cfgr::ahbPrescaler(Rcc::kWhole));"),
        swapped("flash_store.hpp", "bus_.write(Flash::KeyR::address, Flash::firstKey);",
                "bus_.write(Flash::KeyR::address, Flash::secondKey);"),
        swapped("flash_store.hpp", "modify(bus_, Flash::Cr::pageErase(1) | Flash::Cr::page(number));",
                "modify(bus_, Flash::Cr::start(1));"),
        swapped("flash_store.hpp", "bus_.write(addressAt(offset), wordOf(unit));",
                "bus_.write(addressAt(offset) + 4, wordOf(unit.subspan(4)));"),
        swapped("watchdog.hpp", "write(Iwdg::kUnlock);", "bus_.write(Iwdg::Pr::address, kDivideBy16);"),
        swapped("microsecond_clock.hpp", "bus_.write(Tim2::Psc::address, kCore_hz / 1'000'000 - 1);",
                "bus_.write(Tim2::Arr::address, 0xFFFF'FFFF); write(bus_, Tim2::Egr::update(1));"),
        swapped("microsecond_clock.hpp", "enableClock(bus_, Rcc::Apb1Enr1::tim2(1));",
                "bus_.write(Tim2::Psc::address, kCore_hz / 1'000'000 - 1);"),
    ],
    "steps left out": [
        ("gauge_converter.hpp", "    write(bus_, Adc1::Cr::deepPowerDown(0));\n", ""),
        ("gauge_converter.hpp", "    waitCycles<Adc1::Isr>(bus_, kRegulator_cycles);\n", ""),
        ("gauge_converter.hpp", "!calibrate<Adc1>() || !calibrate<Adc2>()", "!calibrate<Adc1>()"),
        ("gauge_converter.hpp", "    waitCycles<Adc1::Isr>(bus_, kAfterCalibration_cycles);\n", ""),
        ("gauge_converter.hpp", "!enable<Adc1>() || !enable<Adc2>()", "!enable<Adc1>()"),
        ("gauge_converter.hpp", "Ccr::dual(Adc12::kRegularSimultaneous) | ", ""),
        ("gauge_converter.hpp", "Ccr::dmaCircular(1) | ", ""),
        ("gauge_converter.hpp", " |\n               Ccr::prescaler(Adc12::kDivideBy8)", ""),
        ("gauge_converter.hpp", "Ccr::circular(1) | ", ""),
        ("gauge_converter.hpp", "Ccr::incrementMemory(1) | ", ""),
        ("gauge_converter.hpp", "    write(bus_, Tim1::Egr::update(1));\n", ""),
        ("gauge_converter.hpp", "    waitCycles<Adc1::Isr>(bus_, kAfterStart_cycles);\n", ""),
        ("gauge_converter.hpp", "    write(bus_, Tim3::Cr1::enable(1));\n", ""),
        ("gauge_converter.hpp", "    write(bus_, Tim3::Cnt::count16(0));\n", ""),
        ("gauge_converter.hpp", "    write(bus_, regulated<Adc1>() | Adc1::Cr::stop(1));\n", ""),
        ("gauge_converter.hpp", "    write(bus_, Dma1::Ccr1::enable(0));\n", ""),
        ("gauge_converter.hpp", "    static_cast<void>(bus_.read(Adc12::Cdr::address));\n", "",
         "an old result in the data register does no harm once the DMA mode is off: the read is for the flags' sake"),
        ("clock_tree.hpp", "    if (!returnToInternal()) return std::nullopt;\n", ""),
        ("clock_tree.hpp", "    modify(bus_, Pwr::Cr5::normalMode(0));\n", ""),
        ("clock_tree.hpp", "    modify(bus_, Rcc::Cfgr::ahbPrescaler(Rcc::kHalf));\n", ""),
        ("clock_tree.hpp", "    waitCycles<Rcc::Cfgr>(bus_, kCore_hz / 1'000'000);\n", ""),
        ("clock_tree.hpp", "    modify(bus_, Rcc::Cfgr::ahbPrescaler(Rcc::kWhole));\n", ""),
        ("clock_tree.hpp", " |\n                    PllCfgr::outputOn(1)", ""),
        ("clock_tree.hpp", "    modify(bus_, Rcc::Cr::hseOn(0));\n", ""),
        ("clock_tree.hpp", " | Rcc::Cr::clockSecurity(1)", ""),
        ("clock_tree.hpp", "Flash::Acr::latency(kWaitStates) | ", ""),
        ("fdcan_port.hpp", "    modify(bus_, Cccr::configurable(1));\n    const bool fd", "    const bool fd"),
        ("fdcan_port.hpp", "    write(bus_, Fdcan::Txbc::queue(1));\n", ""),
        ("flash_store.hpp", "      bus_.write(Flash::KeyR::address, Flash::firstKey);\n", ""),
        ("flash_store.hpp", "    modify(bus_, Flash::Cr::start(1));\n", ""),
        ("flash_store.hpp", "    modify(bus_, Flash::Cr::program(1));\n", ""),
        ("flash_store.hpp", "    modify(bus_, Flash::Cr::lock(1));\n", ""),
        ("flash_store.hpp", "    modify(bus_, Flash::Cr::program(0));\n", ""),
        ("flash_ecc.hpp", "    refreshDataCache(bus_);\n", ""),
        ("flash_ecc.hpp", "  modify(bus, Flash::Acr::dataCache(0));\n", ""),
        ("watchdog.hpp", "    write(Iwdg::kUnlock);\n", ""),
        ("watchdog.hpp", "    write(Iwdg::kStart);\n", ""),
        ("watchdog.hpp", "  modify(bus, Csr::remove(1));\n", ""),
        ("microsecond_clock.hpp", "    write(bus_, Tim2::Egr::update(1));", "    "),
    ],
    "reactions left out": [
        ("gauge_converter.hpp", "get(bus_, Adc1::Isr::overrun) != 0 || ", ""),
        ("gauge_converter.hpp", "get(bus_, Adc2::Isr::overrun) != 0 ||", ""),
        ("gauge_converter.hpp", "get(bus_, Dma1::Isr::error1) != 0 || ", ""),
        ("gauge_converter.hpp", " || static_cast<std::int16_t>(sets - taken_) < 0", ""),
        ("gauge_converter.hpp", "    write(bus_, Adc2::Isr::overrun(1));\n", ""),
        ("gauge_converter.hpp", "    taken_ = 0;\n    isFirst_ = true;\n", "    taken_ = 0;\n"),
        ("fdcan_port.hpp", "      write(bus_, Fdcan::Rxf0a::index(index));\n", ""),
        ("fdcan_port.hpp", "    write(bus_, Fdcan::Ir::fifo0Lost(1));\n", ""),
        ("fdcan_port.hpp", "if (attempt_ + 1U < kBackOff_us.size()) ++attempt_;", ""),
        ("fdcan_port.hpp", "if (rule.background) since_us_ = clock_.now_us();", "since_us_ = clock_.now_us();"),
        ("flash_store.hpp", " &&\n           (bus_.read(Flash::Sr::address) & Flash::Sr::errors) == 0", ""),
        ("flash_ecc.hpp", "    errors_.isExpected = true;\n", ""),
        ("flash_ecc.hpp", "    errors_.isExpected = false;\n", ""),
        ("gauge_converter.hpp", "    ++resynchronisations_;\n", ""),
        ("gauge_converter.hpp", "if (resynchronisations_ != 0) ++overruns_;", ""),
        ("flash_store.hpp", "noteEccErrors(bus_, errors_);\n    return word;", "return word;"),
    ],
}


ALL = [(kind, mutant) for kind, mutants in MUTANTS.items() for mutant in mutants]


def tests_of(file):
    for name in (file, file.split("/")[0] + "/"):
        if name in SEEN_BY:
            return SEEN_BY[name]
    raise KeyError(file)


def compiler(options):
    return [options.compiler, "-std=c++20", "-O0", "-w", "-DCPPUTEST_USE_MEM_LEAK_DETECTION=0"]


def build_common(options):
    """What every test needs, once: its main(), and the libraries' headers as a precompiled one."""
    subprocess.run([*compiler(options), "-c", options.root / "tests/main.cpp", "-o", options.build / "main.o"], check=True)
    headers = options.build / "common.hpp"
    headers.write_text("".join(f"#include <{name}>\n" for name in COMMON_HEADERS), encoding="utf-8")
    subprocess.run([*compiler(options), "-x", "c++-header", headers, "-o", f"{headers}.gch"], check=True)


def build(options, test, overlay, program):
    """The test with the overlay's files in place of the project's."""
    command = [*compiler(options), "-include", options.build / "common.hpp", f'-DSTRAINFINGER_ROOT="{options.root}"',
               *([f"-I{overlay}"] if overlay else []), f"-I{options.root}", f"{options.root}/{TESTS}/{test}.cpp",
               options.build / "main.o", "-lCppUTest", "-o", program]
    return subprocess.run(command, capture_output=True, text=True)


def passes(program):
    return subprocess.run([program, "-xn", SLOW_TEST], capture_output=True, timeout=60).returncode == 0


def verdict(options, mutant, number):
    """What the tests make of a mutant: "killed by ..." or "survived"."""
    file, before, after = mutant[:3]
    source = (options.root / BOARD / file).read_text(encoding="utf-8")
    overlay = options.build / f"mutant_{number}"
    copy = overlay / BOARD / file
    copy.parent.mkdir(parents=True, exist_ok=True)
    copy.write_text(re.sub(pattern_of(before), lambda _: after, source), encoding="utf-8")
    for test in tests_of(file):
        program = overlay / test
        if build(options, test, overlay, program).returncode != 0:
            return "killed by the compiler"
        try:
            if not passes(program):
                return f"killed by {test}"
        except subprocess.TimeoutExpired:
            return f"killed by {test}: it does not end"
        finally:
            program.unlink()
    return "survived"


def pattern_of(text):
    """The text, however it is broken into lines."""
    return r"\s+".join(re.escape(word) for word in text.split())


def check_mutants(options):
    """Each replaces one text, and none does what another does."""
    if len({mutant[:3] for _, mutant in ALL}) != len(ALL):
        sys.exit("mutants.py: a mutant is there twice")
    for number, (_, mutant) in enumerate(ALL):
        found = len(re.findall(pattern_of(mutant[1]), (options.root / BOARD / mutant[0]).read_text(encoding="utf-8")))
        if found != 1:
            sys.exit(f"mutants.py: {mutant[0]} has {found} times what mutant {number} replaces: {mutant[1]!r}. Mend MUTANTS.")


def check_unchanged(options, mutants):
    """The tests that see these pass without them."""
    for test in sorted({test for _, (_, mutant) in mutants for test in tests_of(mutant[0])}):
        program = options.build / test
        result = build(options, test, None, program)
        if result.returncode != 0 or not passes(program):
            sys.exit(f"mutants.py: {test} fails without a mutant\n{result.stderr}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--only", nargs="+", type=int, metavar="NUMBER", help="these mutants and no others")
    parser.add_argument("--part", nargs=2, type=int, metavar=("N", "SEED"), default=(1, 0))
    options = parser.parse_args()
    options.root, options.build = options.root.resolve(), options.build.resolve()
    options.build.mkdir(parents=True, exist_ok=True)
    check_mutants(options)
    build_common(options)
    parts, seed = options.part
    chosen = list(enumerate(ALL))
    if options.only:
        chosen = [chosen[number] for number in options.only]
    elif parts > 1:
        random.Random(seed).shuffle(chosen)
        chosen = chosen[:len(ALL) // parts]
    check_unchanged(options, chosen)
    tried, killed, unexcused = collections.Counter(), collections.Counter(), 0
    for number, (kind, mutant) in chosen:
        said = verdict(options, mutant, number)
        tried[kind] += 1
        killed[kind] += said != "survived"
        excuse = mutant[3] if len(mutant) > 3 else ""
        unexcused += said == "survived" and not excuse
        if said == "survived" or parts == 1:
            print(f"{number:3} {mutant[0]}: {' '.join(mutant[1].split())} -> {' '.join(mutant[2].split()) or 'nothing'}: "
                  f"{said}{', for ' + excuse if said == 'survived' and excuse else ''}", flush=True)
    for kind in tried:
        print(f"{kind}: {killed[kind]} of {tried[kind]} killed")
    print(f"{killed.total()} of {len(chosen)} mutants killed ({len(ALL)} in all, seed {seed})")
    return 0 if unexcused == 0 and killed.total() >= 0.95 * len(chosen) else 1


if __name__ == "__main__":
    sys.exit(main())
