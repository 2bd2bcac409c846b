#pragma once
// hal::NonVolatile on pages of the flash memory: RM0440 chapter 5.

#include <algorithm>
#include <cstring>

#include "firmware/board/stm32g431/registers/flash.hpp"
#include "hal/non_volatile.hpp"

namespace strainfinger::stm32g431 {

/// Double ECC errors met so far. The flash raises NMI while it is being read, so they come from the NMI's
/// handler.
struct EccFaults {
  volatile std::uint32_t count = 0;
  volatile std::uint32_t lastOffset = 0;  ///< from kFlashBegin
};

/// To be called by the NMI's handler. True: it was a double ECC error; it is noted, the flag is cleared, and
/// the handler can return. The read then goes on with bytes that mean nothing.
inline bool takeEccFault(const RegisterBus auto& bus, EccFaults& faults) noexcept {
  const std::uint32_t status = bus.read(Flash::EccR::address);
  if (Flash::EccR::detected.in(status) == 0) return false;
  faults.lastOffset = Flash::EccR::offset.in(status);
  faults.count = faults.count + 1;
  modify(bus, Flash::EccR::detected(1) | Flash::EccR::corrected(0));
  return true;
}

/// Contract: hal/non_volatile.hpp. The processor stands still while the memory is written (0.1 ms for each 8
/// bytes) or erased (25 ms a page): there is one bank, and the code is in it. Samples of that time are lost
/// and counted.
template <RegisterBus Bus>
class FlashStore {
 public:
  /// The store is `pages` pages from number `firstPage` of the memory on.
  FlashStore(Bus bus, const EccFaults& faults, std::uint32_t firstPage, std::uint32_t pages)
      : bus_(bus), faults_(faults), firstPage_(firstPage), pages_(pages) {}

  std::size_t size() const noexcept { return pages_ * pageSize(); }
  std::size_t pageSize() const noexcept { return kFlashPageBytes; }

  hal::StoreResult read(std::size_t offset, std::span<std::byte> to) const noexcept {
    if (!isInside(offset, to.size())) return hal::StoreResult::kOutOfRange;
    const std::uint32_t before = faults_.count;
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = static_cast<std::byte>(wordAt((offset + i) & ~std::size_t{3}) >> (8 * ((offset + i) & 3)));
    return faults_.count == before ? hal::StoreResult::kOk : hal::StoreResult::kUnreadable;
  }

  hal::StoreResult write(std::size_t offset, std::span<const std::byte> from) noexcept {
    if (offset % kUnit_bytes != 0 || from.size() % kUnit_bytes != 0 || !isInside(offset, from.size()))
      return hal::StoreResult::kOutOfRange;
    if (!isErased(offset, from.size())) return hal::StoreResult::kNotErased;
    if (!unlock()) return hal::StoreResult::kFailed;
    bool done = true;
    for (std::size_t i = 0; i < from.size() && done; i += kUnit_bytes)
      done = program(offset + i, from.subspan(i).template first<kUnit_bytes>());
    lock();
    return done && holds(offset, from) ? hal::StoreResult::kOk : hal::StoreResult::kFailed;
  }

  hal::StoreResult erase(std::size_t page) noexcept {
    if (page >= pages_) return hal::StoreResult::kOutOfRange;
    if (!unlock()) return hal::StoreResult::kFailed;
    const auto number = static_cast<std::uint32_t>(page) + firstPage_;
    modify(bus_, Flash::Cr::pageErase(1) | Flash::Cr::page(number));
    modify(bus_, Flash::Cr::start(1));
    const bool done = finish(kErasePolls);
    modify(bus_, Flash::Cr::pageErase(0));
    lock();
    return done && isErased(page * pageSize(), pageSize()) ? hal::StoreResult::kOk
                                                           : hal::StoreResult::kFailed;
  }

 private:
  static constexpr std::size_t kUnit_bytes = 8;
  /// A poll takes 6 cycles of 170 MHz at least. Erasing a page takes 24.5 ms at most, programming 0.09
  /// (DS12589).
  static constexpr std::uint32_t kErasePolls = 1'000'000;
  static constexpr std::uint32_t kProgramPolls = 10'000;

  bool isInside(std::size_t offset, std::size_t length) const noexcept {
    return offset <= size() && length <= size() - offset;
  }

  std::uint32_t addressAt(std::size_t offset) const noexcept {
    return kFlashBegin + firstPage_ * kFlashPageBytes + static_cast<std::uint32_t>(offset);
  }

  std::uint32_t wordAt(std::size_t offset) const noexcept { return bus_.read(addressAt(offset)); }

  /// False for what can't be read, too: programming would fail or make it worse.
  bool isErased(std::size_t offset, std::size_t length) const noexcept {
    const std::uint32_t before = faults_.count;
    std::uint32_t all = 0xFFFF'FFFF;
    for (std::size_t i = 0; i < length; i += 4) all &= wordAt(offset + i);
    return all == 0xFFFF'FFFF && faults_.count == before;
  }

  bool holds(std::size_t offset, std::span<const std::byte> bytes) const noexcept {
    const std::uint32_t before = faults_.count;
    bool same = true;
    for (std::size_t i = 0; i < bytes.size(); i += 4) same &= wordAt(offset + i) == wordOf(bytes.subspan(i));
    return same && faults_.count == before;
  }

  static std::uint32_t wordOf(std::span<const std::byte> bytes) noexcept {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data(), sizeof word);
    return word;
  }

  /// RM0440 section 5.3.5. A wrong key would keep the memory locked until the next reset.
  bool unlock() noexcept {
    if (!waitFor(bus_, Flash::Sr::busy, 0, kErasePolls)) return false;
    if (get(bus_, Flash::Cr::lock) != 0) {
      bus_.write(Flash::KeyR::address, Flash::firstKey);
      bus_.write(Flash::KeyR::address, Flash::secondKey);
    }
    bus_.write(Flash::Sr::address, Flash::Sr::errors | Flash::Sr::endOfOperation.mask);
    return get(bus_, Flash::Cr::lock) == 0;
  }

  /// Locks, and forgets what the data cache has of the old contents (RM0440 section 5.3.4).
  void lock() noexcept {
    modify(bus_, Flash::Cr::lock(1));
    modify(bus_, Flash::Acr::dataCache(0));
    modify(bus_, Flash::Acr::resetDataCache(1));
    modify(bus_, Flash::Acr::resetDataCache(0));
    modify(bus_, Flash::Acr::dataCache(1));
  }

  /// RM0440 section 5.3.7: both words of a unit, the lower first.
  bool program(std::size_t offset, std::span<const std::byte, kUnit_bytes> unit) noexcept {
    modify(bus_, Flash::Cr::program(1));
    bus_.write(addressAt(offset), wordOf(unit));
    bus_.write(addressAt(offset) + 4, wordOf(unit.subspan(4)));
    const bool done = finish(kProgramPolls);
    modify(bus_, Flash::Cr::program(0));
    return done;
  }

  bool finish(std::uint32_t polls) noexcept {
    return waitFor(bus_, Flash::Sr::busy, 0, polls) &&
           (bus_.read(Flash::Sr::address) & Flash::Sr::errors) == 0;
  }

  [[no_unique_address]] Bus bus_;
  const EccFaults& faults_;
  std::uint32_t firstPage_;
  std::uint32_t pages_;
};

}  // namespace strainfinger::stm32g431
