#pragma once
// The flash memory and its controller as registers: locks, double words, ECC, caches. RM0440 chapter 5.

#include <functional>
#include <set>

#include "firmware/board/stm32g431/registers/flash.hpp"
#include "tests/firmware/board/stm32g431/fake_registers.hpp"

namespace strainfinger::doubles {

/// Pages from `firstPage` on. A read of a double word with two bad bits calls `nonMaskable`, as the NMI does.
class FakeFlash {
 public:
  FakeRegisters registers;
  std::function<void()> nonMaskable = [] {};
  bool stuckBusy = false;        ///< an operation that never ends
  std::uint32_t nextErrors = 0;  ///< bits of SR that the next operation sets
  bool weak = false;             ///< programming leaves a bit at 1; erasing leaves a bit at 0
  int violations = 0;            ///< what the manual forbids
  int cutAfter = -1;             ///< double words programmed until the power goes; -1: it stays

  FakeFlash(std::uint32_t firstPage, std::uint32_t pages)
      : begin_(stm32g431::kFlashBegin + firstPage * stm32g431::kFlashPageBytes),
        bytes_(pages * stm32g431::kFlashPageBytes) {
    registers.add<Flash::Acr>(Flash::Acr::dataCache(1).value | 4);
    registers.add<Flash::KeyR>();
    registers.add<Flash::Sr>();
    registers.add<Flash::Cr>(0xC000'0000);
    registers.add<Flash::EccR>();
    registers.addRange(begin_, bytes_, 0xFFFF'FFFF);
    registers.onWrite<Flash::KeyR>([this](std::uint32_t, std::uint32_t key) { return takeKey(key); });
    registers.onWrite<Flash::Cr>(
        [this](std::uint32_t before, std::uint32_t written) { return control(before, written); });
    registers.onRead<Flash::Sr>([this](std::uint32_t status) { return passTime(status); });
    registers.onWrite<Flash::Sr>([](std::uint32_t before, std::uint32_t ones) { return before & ~ones; });
    registers.onWrite<Flash::EccR>(
        [](std::uint32_t before, std::uint32_t ones) { return before & ~(ones & kEccFlags); });
    registers.onWrite<Flash::Acr>(
        [this](std::uint32_t before, std::uint32_t written) { return access(before, written); });
    registers.onData = [this](bool isWrite, std::uint32_t address, std::uint32_t& word,
                              std::uint32_t written) {
      if (!isInside(address)) return false;
      isWrite ? program(address, word, written) : load(address);
      return true;
    };
  }

  void damage(std::size_t offset) { damaged_.insert(static_cast<std::uint32_t>(offset) / 8); }
  std::uint32_t& wordAt(std::size_t offset) {
    return registers.at(begin_ + static_cast<std::uint32_t>(offset));
  }
  bool isLocked() { return registers.field(Flash::Cr::lock) != 0; }
  int cacheResets = 0;

 private:
  using Flash = stm32g431::Flash;
  static constexpr std::uint32_t kEccFlags = Flash::EccR::detected.mask | Flash::EccR::corrected.mask;
  static constexpr std::uint32_t kProgError = 1U << 3, kSequenceError = 1U << 7;

  bool isInside(std::uint32_t address) const { return address >= begin_ && address - begin_ < bytes_; }

  std::uint32_t takeKey(std::uint32_t key) {
    const bool right = keys_ == 0 ? key == Flash::firstKey : keys_ == 1 && key == Flash::secondKey;
    keys_ = right ? keys_ + 1 : 3;  // 3: locked until reset
    if (!right) ++violations;
    if (keys_ == 2) registers.setField(Flash::Cr::lock, 0);
    return 0;
  }

  std::uint32_t control(std::uint32_t before, std::uint32_t written) {
    if (Flash::Cr::lock.in(before) != 0) {
      if ((before ^ written) & ~Flash::Cr::lock.mask) ++violations;
      return before;
    }
    if (Flash::Cr::lock.in(written) != 0) keys_ = 0;
    if (Flash::Cr::start.in(written) != 0) startErase(written);
    return written & ~Flash::Cr::start.mask;
  }

  void startErase(std::uint32_t control) {
    if (Flash::Cr::pageErase.in(control) == 0) return begin(kSequenceError);
    const std::uint32_t page =
        stm32g431::kFlashBegin + Flash::Cr::page.in(control)*stm32g431::kFlashPageBytes;
    if (!isInside(page)) ++violations;
    for (std::uint32_t offset = 0; isInside(page) && offset < stm32g431::kFlashPageBytes; offset += 4) {
      registers.at(page + offset) = weak && offset == 64 ? 0xFFFF'FFFE : 0xFFFF'FFFF;
      damaged_.erase((page - begin_ + offset) / 8);
    }
    begin(0);
  }

  void begin(std::uint32_t errors) {
    registers.setField(Flash::Sr::busy, 1);
    errors_ = errors | nextErrors;
    nextErrors = 0;
    readsLeft_ = 5;
  }

  std::uint32_t passTime(std::uint32_t status) {
    if (Flash::Sr::busy.in(status) == 0 || stuckBusy || readsLeft_-- > 0) return status;
    return (status & ~Flash::Sr::busy.mask) | errors_ | (errors_ == 0 ? Flash::Sr::endOfOperation.mask : 0);
  }

  /// The cache may only be reset while it is off.
  std::uint32_t access(std::uint32_t before, std::uint32_t written) {
    if (Flash::Acr::resetDataCache.in(written) != 0) {
      ++cacheResets;
      if (Flash::Acr::dataCache.in(before) != 0) ++violations;
    }
    return written;
  }

  void load(std::uint32_t address) {
    const std::uint32_t unit = (address - begin_) / 8;
    if (damaged_.count(unit) == 0) return;
    registers.word<Flash::EccR>() = Flash::EccR::detected(1).value |
                                    Flash::EccR::offset(begin_ - stm32g431::kFlashBegin + 8 * unit).value;
    nonMaskable();
  }

  /// Both words of an erased unit, the lower first, with PG set.
  void program(std::uint32_t address, std::uint32_t& word, std::uint32_t written) {
    const bool lower = address % 8 == 0;
    const bool allowed = registers.field(Flash::Cr::program) != 0 && registers.field(Flash::Sr::busy) == 0 &&
                         (lower || address == halfAt_ + 4);
    if (!allowed) {
      ++violations;
      return begin(kSequenceError);
    }
    if (lower) {
      halfAt_ = address;
      half_ = written;
      return;
    }
    if (word != 0xFFFF'FFFF || registers.at(address - 4) != 0xFFFF'FFFF) return begin(kProgError);
    if (cutAfter-- == 0) damage(address - begin_);
    word = weak ? written | 1 : written;
    registers.at(address - 4) = half_;
    begin(0);
  }

  std::uint32_t begin_;
  std::uint32_t bytes_;
  std::set<std::uint32_t> damaged_;  ///< double words
  int keys_ = 0;
  int readsLeft_ = 0;
  std::uint32_t errors_ = 0;
  std::uint32_t halfAt_ = 0;
  std::uint32_t half_ = 0;
};

}  // namespace strainfinger::doubles
