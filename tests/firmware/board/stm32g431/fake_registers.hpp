#pragma once
// Registers in ordinary memory, each of which may behave: what a peripheral's fake is made of.

#include <CppUTest/TestHarness.h>

#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::doubles {

/// Knows only the registers it was told of; using another one fails the test. Counts accesses, as a clock
/// does.
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
    for (std::uint32_t offset = 0; offset < bytes; offset += 4) words_[first + offset] = value;
  }
  template <typename Reg>
  void onRead(Read behaviour) {
    reads_[Reg::address] = std::move(behaviour);
  }
  template <typename Reg>
  void onWrite(Write behaviour) {
    writeBehaviours_[Reg::address] = std::move(behaviour);
  }

  std::uint32_t& at(std::uint32_t address) {
    const auto word = words_.find(address);
    if (word == words_.end()) FAIL(StringFromFormat("no register at 0x%08X", address).asCharString());
    return word->second;
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
    std::uint32_t& stored = at(address);
    if (onData && onData(false, address, stored, 0)) return stored;
    const auto behaviour = reads_.find(address);
    if (behaviour != reads_.end()) stored = behaviour->second(stored);
    return stored;
  }
  void write(std::uint32_t address, std::uint32_t value) {
    ++accesses;
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

 private:
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
