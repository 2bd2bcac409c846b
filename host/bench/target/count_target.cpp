// What a fit costs, in instructions, by every method of the benchmark (see instruction_counter.hpp for how to
// run it). Writes to UART0: method;level of noise;instructions.
#include "firmware/board/cortex_m/startup.hpp"
#include "firmware/board/mps2/console.hpp"
#include "firmware/board/mps2/instruction_counter.hpp"
#include "firmware/board/mps2/semihosting.hpp"
#include "host/bench/methods/catalogue.hpp"
#include "host/bench/methods/keep.hpp"

// What bench_bundle made, from one of the assembler's include paths.
asm(".section .rodata\n.balign 8\nbench_bundle:\n.incbin \"bundle.bin\"\n.text\n");
extern "C" const strainfinger::bench::Bundle bench_bundle;

namespace strainfinger::board {
namespace {

using bench::Method;
using bench::Sample;

/// As memory that may change: or parts of a fit could move to where nobody counts.
const bench::Bundle& theBundle() {
  const bench::Bundle* bundle = &bench_bundle;
  asm volatile("" : "+r"(bundle));
  return *bundle;
}

/// For Eigen's workspaces; nothing is given back to it.
alignas(8) std::array<char, 1 << 20> heap;
std::size_t heapUsed = 0;

class Counting {
 public:
  template <typename Fit>
  void count(std::uint32_t level, const Method& method, Fit fit) {
    const auto& samples = theBundle().levels[level].samples;
    for (std::size_t i = 0; i < samples.size(); i += static_cast<std::size_t>(method.stride)) {
      const std::uint32_t instructions = counter_.of([&] { bench::keep(fit(samples[i])); });
      console_ << method.name << ";" << level << ";" << instructions << "\n";
    }
  }

 private:
  mps2::Console console_;
  mps2::InstructionCounter counter_;
};

/// Its own function, so that nothing of it runs before the floating-point unit does.
[[gnu::noinline]] void countAll() {
  if (theBundle().bytes != sizeof(bench::Bundle)) mps2::endEmulator(2);
  Counting counting;
  for (std::uint32_t level = 0; level < bench::kLevels; ++level) {
    const auto count = [&](const Method& method, auto fit) { counting.count(level, method, fit); };
    bench::visitOurs(theBundle().levels[level].tables, count);
    bench::visitOthers(theBundle().knowledge, count);
  }
}

/// Coprocessor access control, Armv7-M ARM, B3.2.20.
void switchFloatingPointOn() {
#ifdef __ARM_FP
  *reinterpret_cast<std::uint32_t volatile*>(0xE000ED88) = 0xFu << 20;
  asm volatile("dsb\n isb" ::: "memory");
#endif
}

}  // namespace

void runBoard() {
  switchFloatingPointOn();
  countAll();
  mps2::endEmulator(0);
}

}  // namespace strainfinger::board

/// The C library's.
extern "C" void* _sbrk(std::ptrdiff_t bytes) {
  using namespace strainfinger::board;
  const std::size_t before = heapUsed;
  if (before + static_cast<std::size_t>(bytes) > heap.size()) strainfinger::mps2::endEmulator(3);
  heapUsed += static_cast<std::size_t>(bytes);
  return &heap[before];
}
