#pragma once
// What the flash's error correction finds: RM0440 section 5.3.2. Each 64 bits have 8 more with them, so that
// one wrong bit is put right and two are noticed, by a non-maskable interrupt (NMI).

#include <atomic>

#include "firmware/board/stm32g431/registers/flash.hpp"

namespace strainfinger::stm32g431 {

/// Errors met since the start; shared with the NMI's handler.
struct EccErrors {
  volatile std::uint32_t corrected = 0;
  volatile std::uint32_t unreadable = 0;
  /// Of the last unreadable double word, from kFlashBegin. For the report only: a reset while the memory is
  /// programmed or erased can leave another address in ECCR (an erratum of the family).
  volatile std::uint32_t lastOffset = 0;
  /// What is being read may be damaged, and whoever reads it will ask.
  volatile bool isExpected = false;
};

/// Counts what the flags say and clears them both: an error of two bits is only noticed while both are clear.
/// Not inlined: at a dozen places it would take more flash than the 10 kHz image has left.
[[gnu::noinline]] void noteEccErrors(const RegisterBus auto& bus, EccErrors& errors) noexcept {
  using EccR = Flash::EccR;
  const std::uint32_t status = bus.read(EccR::address);
  if ((status & (EccR::corrected.mask | EccR::detected.mask)) == 0) return;
  if (EccR::corrected.in(status) != 0) errors.corrected = errors.corrected + 1;
  if (EccR::detected.in(status) != 0) {
    errors.lastOffset = EccR::offset.in(status);
    errors.unreadable = errors.unreadable + 1;
  }
  write(bus, EccR::corrected(1) | EccR::detected(1));
}

/// By the NMI's handler. True: it can return, and the read goes on with bytes that mean nothing. That is
/// decided by what is being read and never by the address. An NMI without flags is taken for an error that
/// they don't show; if it is the crystal that has stopped, it comes again and again, until the watchdog
/// resets.
inline bool survivesNmi(const RegisterBus auto& bus, EccErrors& errors) noexcept {
  const std::uint32_t before = errors.unreadable;
  noteEccErrors(bus, errors);
  if (errors.isExpected && errors.unreadable == before) errors.unreadable = before + 1;
  return errors.isExpected;
}

/// Forgets what the data cache has of the memory. Only a cache that is off can be reset (RM0440
/// section 5.3.4).
inline void refreshDataCache(const RegisterBus auto& bus) noexcept {
  modify(bus, Flash::Acr::dataCache(0));
  modify(bus, Flash::Acr::resetDataCache(1));
  modify(bus, Flash::Acr::resetDataCache(0));
  modify(bus, Flash::Acr::dataCache(1));
}

/// As long as it lives, damaged words of flash are expected and counted, those too that the data cache has
/// already: they would raise nothing. Who reads words one after the other calls noteEccErrors() after each.
template <RegisterBus Bus>
class EccWatch {
 public:
  EccWatch(Bus bus, EccErrors& errors) noexcept : bus_(bus), errors_(errors) {
    refreshDataCache(bus_);
    noteEccErrors(bus_, errors_);
    before_ = errors_.unreadable;
    errors_.isExpected = true;
    std::atomic_signal_fence(std::memory_order_seq_cst);
  }
  ~EccWatch() {
    isClean();
    errors_.isExpected = false;
  }
  EccWatch(const EccWatch&) = delete;
  EccWatch& operator=(const EccWatch&) = delete;

  /// All that was read since it lives was readable, but for words that an error of one bit hid.
  bool isClean() const noexcept {
    std::atomic_signal_fence(std::memory_order_seq_cst);
    noteEccErrors(bus_, errors_);
    return errors_.unreadable == before_;
  }

 private:
  [[no_unique_address]] Bus bus_;
  EccErrors& errors_;
  std::uint32_t before_ = 0;
};

}  // namespace strainfinger::stm32g431
