#pragma once
// Registers in ordinary memory, each of which may behave: what a peripheral's fake is made of.
//
// Which bit gives which peripheral its clock comes from ST's headers (st_literals.hpp), not from the
// drivers'.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "firmware/board/stm32g431/registers/register.hpp"
#include "tests/firmware/board/stm32g431/st_literals.hpp"

#include <CppUTest/TestHarness.h>

namespace strainfinger::doubles {

/// Registers that ignore accesses, or worse, until a bit of RCC is set and has been read back (RM0440 section
/// 7.2.17).
struct ClockGate {
  std::uint32_t first, bytes;
  std::uint32_t enableRegister, bit;
};
inline constexpr std::array kClockGates{
    ClockGate{st::DMA1_BASE, 0x400, st::RCC_AHB1ENR, st::RCC_AHB1ENR_DMA1EN},
    ClockGate{st::DMAMUX1_BASE, 0x400, st::RCC_AHB1ENR, st::RCC_AHB1ENR_DMAMUX1EN},
    ClockGate{st::GPIOA_BASE, 0x400, st::RCC_AHB2ENR, st::RCC_AHB2ENR_GPIOAEN},
    ClockGate{st::GPIOB_BASE, 0x400, st::RCC_AHB2ENR, st::RCC_AHB2ENR_GPIOBEN},
    ClockGate{st::GPIOC_BASE, 0x400, st::RCC_AHB2ENR, st::RCC_AHB2ENR_GPIOCEN},
    ClockGate{st::ADC1_BASE, 0x400, st::RCC_AHB2ENR, st::RCC_AHB2ENR_ADC12EN},
    ClockGate{st::TIM1_BASE, 0x400, st::RCC_APB2ENR, st::RCC_APB2ENR_TIM1EN},
    ClockGate{st::TIM2_BASE, 0x400, st::RCC_APB1ENR1, st::RCC_APB1ENR1_TIM2EN},
    ClockGate{st::TIM3_BASE, 0x400, st::RCC_APB1ENR1, st::RCC_APB1ENR1_TIM3EN},
    ClockGate{st::FDCAN1_BASE, 0x400, st::RCC_APB1ENR1, st::RCC_APB1ENR1_FDCANEN},
    ClockGate{st::SRAMCAN_BASE, 0x400, st::RCC_APB1ENR1, st::RCC_APB1ENR1_FDCANEN},
    ClockGate{st::PWR_BASE, 0x400, st::RCC_APB1ENR1, st::RCC_APB1ENR1_PWREN},
};

/// Knows only the registers it was told of. Using another one fails the test, as does using one without its
/// clock. Counts accesses, as a clock does.
class FakeRegisters {
 public:
  using Read = std::function<std::uint32_t(std::uint32_t stored)>;
  using Write =
      std::function<std::uint32_t(std::uint32_t before, std::uint32_t written)>;  ///< gives what is stored

  struct Access {
    std::uint32_t address;
    std::uint32_t value;
    bool operator==(const Access&) const = default;
  };

  /// Sees every access first; true: it has dealt with it (a write's word is then not stored).
  using Data =
      std::function<bool(bool isWrite, std::uint32_t address, std::uint32_t& stored, std::uint32_t written)>;

  std::uint32_t accesses = 0;  ///< reads and writes so far
  Data onData;                 ///< for memories behind the registers; none by default
  std::vector<Access> writes;

  template <typename Reg>
  void add(std::uint32_t value = 0) {
    words_[Reg::address] = value;
  }
  void addRange(std::uint32_t first, std::uint32_t bytes, std::uint32_t value = 0) {
    memories_.push_back({first, std::vector(bytes / 4, value)});
  }
  template <typename Reg>
  void onRead(Read behaviour) {
    reads_[Reg::address] = std::move(behaviour);
  }
  template <typename Reg>
  void onWrite(Write behaviour) {
    writeBehaviours_[Reg::address] = std::move(behaviour);
  }

  FakeRegisters() {
    for (const std::uint32_t enable : {st::RCC_AHB2ENR, st::RCC_APB1ENR1, st::RCC_APB2ENR})
      words_[enable] = 0;
    words_[st::RCC_AHB1ENR] = st::RCC_AHB1ENR_FLASHEN;  // its reset value
  }

  std::uint32_t& at(std::uint32_t address) {
    for (Memory& each : memories_)
      if (address >= each.first && (address - each.first) / 4 < each.words.size())
        return each.words[(address - each.first) / 4];
    const auto word = words_.find(address);
    if (word != words_.end()) return word->second;
    violate("there is no register", address);
    return nowhere_;
  }

  /// Something that the manual forbids: the test fails, and goes on, for drivers can't throw.
  static void violate(const char* what, std::uint32_t address) {
    struct GoOn : TestTerminator {
      void exitCurrentTest() const override {}
    };
    UtestShell& test = *UtestShell::getCurrent();
    if (!test.hasFailed())
      test.fail(StringFromFormat("0x%08X: %s", address, what).asCharString(), __FILE__, __LINE__, GoOn());
  }
  static void require(bool isAllowed, const char* what, std::uint32_t address) {
    if (!isAllowed) violate(what, address);
  }
  /// As the hardware sees it: no behaviour, no count.
  template <typename Reg>
  std::uint32_t& word() {
    return at(Reg::address);
  }
  template <typename FieldType>
  std::uint32_t field(FieldType field) {
    return field.in(at(FieldType::Of::address));
  }
  template <typename FieldType>
  void setField(FieldType field, std::uint32_t value) {
    std::uint32_t& stored = at(FieldType::Of::address);
    stored = (stored & ~FieldType::mask) | field(value).value;
  }

  std::uint32_t read(std::uint32_t address) {
    ++accesses;
    checkClock(address);
    if (isEnableRegister(address)) readBack_.insert(address);
    std::uint32_t& stored = at(address);
    if (onData && onData(false, address, stored, 0)) return stored;
    const auto behaviour = reads_.find(address);
    if (behaviour != reads_.end()) stored = behaviour->second(stored);
    return stored;
  }
  void write(std::uint32_t address, std::uint32_t value) {
    ++accesses;
    checkClock(address);
    if (isEnableRegister(address)) readBack_.erase(address);
    writes.push_back({address, value});
    std::uint32_t& stored = at(address);
    if (onData && onData(true, address, stored, value)) return;
    const auto behaviour = writeBehaviours_.find(address);
    stored = behaviour != writeBehaviours_.end() ? behaviour->second(stored, value) : value;
  }

  /// Memory that the driver gave to DMA.
  void* memory = nullptr;
  static constexpr std::uint32_t kMemoryAddress = 0x2000'0000;

  /// How many writes there were before the first one to Reg whose bits `mask` are `value`.
  template <typename Reg>
  std::size_t firstWrite(std::uint32_t mask, std::uint32_t value) const {
    std::size_t index = 0;
    while (index < writes.size() &&
           !(writes[index].address == Reg::address && (writes[index].value & mask) == value))
      ++index;
    return index;
  }

  /// As if the driver's start() had been called, for tests that don't.
  template <typename Reg>
  void giveClock(stm32g431::Bits<Reg> peripherals) {
    word<Reg>() |= peripherals.value;
    readBack_.insert(Reg::address);
  }

 private:
  static bool isEnableRegister(std::uint32_t address) {
    return address >= st::RCC_AHB1ENR && address <= st::RCC_APB2ENR;
  }

  void checkClock(std::uint32_t address) {
    for (const ClockGate& gate : kClockGates) {
      if (address < gate.first || address - gate.first >= gate.bytes) continue;
      require((at(gate.enableRegister) & gate.bit) != 0, "accessed without its clock", address);
      require(readBack_.contains(gate.enableRegister), "accessed before its clock runs", address);
    }
  }

  std::set<std::uint32_t> readBack_{st::RCC_AHB1ENR};  ///< read since they were written
  /// Words that follow each other.
  struct Memory {
    std::uint32_t first;
    std::vector<std::uint32_t> words;
  };
  std::vector<Memory> memories_;
  std::uint32_t nowhere_ = 0;
  std::map<std::uint32_t, std::uint32_t> words_;
  std::map<std::uint32_t, Read> reads_;
  std::map<std::uint32_t, Write> writeBehaviours_;
};

/// What drivers hold: a pointer to the registers.
class FakeBus {
 public:
  explicit FakeBus(FakeRegisters& registers) : registers_(&registers) {}

  std::uint32_t read(std::uint32_t address) const noexcept { return registers_->read(address); }
  void write(std::uint32_t address, std::uint32_t value) const noexcept { registers_->write(address, value); }
  std::uint32_t addressOf(void* memory) const noexcept {
    registers_->memory = memory;
    return FakeRegisters::kMemoryAddress;
  }

 private:
  FakeRegisters* registers_;
};

static_assert(stm32g431::RegisterBus<FakeBus>);

}  // namespace strainfinger::doubles
