#pragma once
// The flash memory and its controller as registers: locks, double words, ECC, caches. RM0440 chapter 5.

#include <functional>
#include <vector>

#include "firmware/board/stm32g431/registers/flash.hpp"
#include "tests/firmware/board/stm32g431/fake_registers.hpp"

namespace strainfinger::doubles {

/// What FLASH_ECCR says of the place of an error: after a reset during programming it may be anything.
enum class EccAddress { kRight, kWrong, kStale };

/// What the double word in work, or the page, is after the power went.
enum class Torn { kUntouched, kUnreadable, kDone };

/// Pages from `firstPage` on. A double word with two bad bits calls `nonMaskable` when it is read from the
/// memory, as the NMI does, but not when the data cache has it; nor while a flag of an earlier error stands.
/// What the manual forbids fails the test.
class FakeFlash {
 public:
  FakeRegisters registers;
  std::function<void()> nonMaskable = [] {};
  EccAddress eccAddress = EccAddress::kRight;
  bool stuckBusy = false;        ///< an operation that never ends
  std::uint32_t nextErrors = 0;  ///< bits of SR that the next operation sets
  bool weak = false;             ///< programming leaves a bit at 1; erasing leaves a bit at 0
  int cacheResets = 0;

  FakeFlash(std::uint32_t firstPage, std::uint32_t pages)
      : begin_(st::FLASH_BASE + firstPage * st::FLASH_PAGE_SIZE),
        bytes_(pages * st::FLASH_PAGE_SIZE),
        damaged_(bytes_ / 8),
        weakened_(bytes_ / 8),
        cached_(bytes_ / 8) {
    registers.add<Flash::Acr>(st::FLASH_ACR_DCEN | st::FLASH_ACR_LATENCY_4WS);
    registers.add<Flash::KeyR>();
    registers.add<Flash::Sr>();
    registers.add<Flash::Cr>();
    registers.add<Flash::EccR>();
    reset();
    registers.addRange(begin_, bytes_, 0xFFFF'FFFF);
    registers.onWrite<Flash::KeyR>([this](std::uint32_t, std::uint32_t key) { return takeKey(key); });
    registers.onWrite<Flash::Cr>(
        [this](std::uint32_t before, std::uint32_t written) { return control(before, written); });
    registers.onRead<Flash::Sr>([this](std::uint32_t status) { return passTime(status); });
    registers.onWrite<Flash::Sr>([](std::uint32_t before, std::uint32_t ones) { return before & ~ones; });
    registers.onWrite<Flash::EccR>([](std::uint32_t before, std::uint32_t ones) {
      return (before & ~kEccFlags & ~st::FLASH_ECCR_ECCIE) | (before & kEccFlags & ~ones) |
             (ones & st::FLASH_ECCR_ECCIE);
    });
    registers.onWrite<Flash::Acr>(
        [this](std::uint32_t before, std::uint32_t written) { return access(before, written); });
    registers.onData = [this](bool isWrite, std::uint32_t address, std::uint32_t& word,
                              std::uint32_t written) {
      if (!isInside(address)) return false;
      isWrite ? program(address, word, written) : load(address);
      return true;
    };
  }

  /// Two bits of the double word that holds `offset` are wrong; one bit is.
  void damage(std::size_t offset) { damaged_[offset / 8] = true; }
  void weaken(std::size_t offset) { weakened_[offset / 8] = true; }

  /// The power goes at the operation (a page erased, a double word programmed) after so many others.
  void cutPowerAfter(int operations, Torn torn) {
    operationsLeft_ = operations;
    torn_ = torn;
  }
  bool hasPower() const { return operationsLeft_ >= 0; }
  int operations() const { return operations_; }  ///< so far

  /// The power is back, or something else has reset the controller.
  void reset() {
    operationsLeft_ = kNever;
    registers.word<Flash::Sr>() = 0;
    registers.word<Flash::Cr>() = st::FLASH_CR_LOCK | st::FLASH_CR_OPTLOCK;
    registers.word<Flash::EccR>() &= ~kEccFlags;
    keys_ = 0;
    cached_.assign(cached_.size(), false);
  }

  std::uint32_t& wordAt(std::size_t offset) {
    return registers.at(begin_ + static_cast<std::uint32_t>(offset));
  }
  bool isLocked() { return (registers.word<Flash::Cr>() & st::FLASH_CR_LOCK) != 0; }
  /// Someone wrote nonsense instead of a key: locked until the next reset.
  void lockUntilReset() { keys_ = kLockedUntilReset; }

 private:
  using Flash = stm32g431::Flash;
  static constexpr std::uint32_t kEccFlags = st::FLASH_ECCR_ECCD | st::FLASH_ECCR_ECCC;
  static constexpr int kLockedUntilReset = 3;
  static constexpr int kNever = 1'000'000'000;

  bool isInside(std::uint32_t address) const { return address >= begin_ && address - begin_ < bytes_; }

  std::uint32_t takeKey(std::uint32_t key) {
    const bool right = keys_ == 0 ? key == st::FLASH_KEY1 : keys_ == 1 && key == st::FLASH_KEY2;
    if (keys_ != kLockedUntilReset)
      FakeRegisters::require(right, "not the key that is due", Flash::KeyR::address);
    keys_ = right ? keys_ + 1 : kLockedUntilReset;
    if (keys_ == 2) registers.word<Flash::Cr>() &= ~st::FLASH_CR_LOCK;
    return 0;
  }

  std::uint32_t control(std::uint32_t before, std::uint32_t written) {
    if (before & st::FLASH_CR_LOCK) {
      FakeRegisters::require(((before ^ written) & ~st::FLASH_CR_LOCK) == 0, "written while locked",
                             Flash::Cr::address);
      return before;
    }
    FakeRegisters::require((registers.word<Flash::Sr>() & st::FLASH_SR_BSY) == 0 || stuckBusy,
                           "written while busy", Flash::Cr::address);
    if (written & st::FLASH_CR_LOCK) keys_ = 0;
    if (written & st::FLASH_CR_STRT) startErase(written);
    return written & ~st::FLASH_CR_STRT;
  }

  void startErase(std::uint32_t control) {
    if ((control & st::FLASH_CR_PER) == 0) return begin(st::FLASH_SR_PGSERR);
    const std::uint32_t number = (control & st::FLASH_CR_PNB) / (st::FLASH_CR_PNB & -st::FLASH_CR_PNB);
    const std::uint32_t page = st::FLASH_BASE + number * st::FLASH_PAGE_SIZE;
    FakeRegisters::require(isInside(page), "a page erased that is none of these", page);
    const Torn torn = operate();
    if (!isInside(page) || torn == Torn::kUntouched) return begin(st::FLASH_SR_OPERR);
    for (std::uint32_t offset = 0; offset < st::FLASH_PAGE_SIZE; offset += 4) {
      registers.at(page + offset) = weak && offset == 64 ? 0xFFFF'FFFE : 0xFFFF'FFFF;
      forget((page - begin_ + offset) / 8);
    }
    for (std::uint32_t offset = 0; torn == Torn::kUnreadable && offset < st::FLASH_PAGE_SIZE; offset += 64)
      damage(page - begin_ + offset);
    begin(0);
  }

  void forget(std::uint32_t unit) {
    damaged_[unit] = false;
    weakened_[unit] = false;
  }

  /// Counts an operation. Whether it is done, by the power.
  Torn operate() {
    if (operationsLeft_ < 0) return Torn::kUntouched;
    ++operations_;
    return operationsLeft_-- == 0 ? torn_ : Torn::kDone;
  }

  void begin(std::uint32_t errors) {
    registers.word<Flash::Sr>() |= st::FLASH_SR_BSY;
    errors_ = errors | nextErrors;
    nextErrors = 0;
    readsLeft_ = 5;
  }

  std::uint32_t passTime(std::uint32_t status) {
    if ((status & st::FLASH_SR_BSY) == 0 || stuckBusy || readsLeft_-- > 0) return status;
    return (status & ~st::FLASH_SR_BSY) | errors_ | (errors_ == 0 ? st::FLASH_SR_EOP : 0);
  }

  /// The cache may only be reset while it is off.
  std::uint32_t access(std::uint32_t before, std::uint32_t written) {
    if (written & st::FLASH_ACR_DCRST) {
      ++cacheResets;
      cached_.assign(cached_.size(), false);
      FakeRegisters::require((before & st::FLASH_ACR_DCEN) == 0, "cache reset while it is on",
                             Flash::Acr::address);
    }
    return written;
  }

  /// What the cache has raises nothing again; nor does anything while a flag stands, and then its address
  /// stays.
  void load(std::uint32_t address) {
    const std::uint32_t unit = (address - begin_) / 8;
    const bool isBad = damaged_[unit];
    const bool isCached = cached_[unit] && (registers.word<Flash::Acr>() & st::FLASH_ACR_DCEN) != 0;
    cached_[unit] = true;
    if ((!isBad && !weakened_[unit]) || isCached || (registers.word<Flash::EccR>() & kEccFlags) != 0) return;
    registers.word<Flash::EccR>() = (isBad ? st::FLASH_ECCR_ECCD : st::FLASH_ECCR_ECCC) | toldAddress(unit);
    if (isBad) nonMaskable();
  }

  std::uint32_t toldAddress(std::uint32_t unit) {
    switch (eccAddress) {
      case EccAddress::kRight:
        return begin_ - st::FLASH_BASE + 8 * unit;
      case EccAddress::kWrong:
        return 0x1238;  // in the image's code
      case EccAddress::kStale:
        return registers.word<Flash::EccR>() & st::FLASH_ECCR_ADDR_ECC;
    }
    return 0;
  }

  /// Both words of an erased unit, the lower first, with PG set.
  void program(std::uint32_t address, std::uint32_t& word, std::uint32_t written) {
    const bool lower = address % 8 == 0;
    const bool allowed = (registers.word<Flash::Cr>() & st::FLASH_CR_PG) != 0 &&
                         (registers.word<Flash::Sr>() & st::FLASH_SR_BSY) == 0 &&
                         (lower || address == halfAt_ + 4);
    FakeRegisters::require(allowed || stuckBusy, "programmed out of order", address);
    if (!allowed) return begin(st::FLASH_SR_PGSERR);
    if (lower) {
      halfAt_ = address;
      half_ = written;
      return;
    }
    if (word != 0xFFFF'FFFF || registers.at(address - 4) != 0xFFFF'FFFF) return begin(st::FLASH_SR_PROGERR);
    const Torn torn = operate();
    if (torn == Torn::kUnreadable) damage(address - begin_);
    if (torn == Torn::kUntouched) return begin(st::FLASH_SR_OPERR);
    word = weak ? written | 1 : written;
    registers.at(address - 4) = half_;
    begin(0);
  }

  std::uint32_t begin_;
  std::uint32_t bytes_;
  std::vector<bool> damaged_, weakened_, cached_;  ///< of each double word
  int keys_ = 0;
  int readsLeft_ = 0;
  int operations_ = 0;
  int operationsLeft_ = kNever;  ///< -1: the power is gone
  Torn torn_ = Torn::kDone;
  std::uint32_t errors_ = 0;
  std::uint32_t halfAt_ = 0;
  std::uint32_t half_ = 0;
};

}  // namespace strainfinger::doubles
