#pragma once
// hal::NonVolatile on pages of the flash memory: RM0440 chapter 5.

#include <algorithm>
#include <cstring>

#include "firmware/board/stm32g431/flash_ecc.hpp"
#include "hal/non_volatile.hpp"

namespace strainfinger::stm32g431 {

/// Contract: hal/non_volatile.hpp. The processor stands still while the memory is written (0.1 ms for each 8
/// bytes) or erased (25 ms a page): there is one bank, and the code is in it. Samples of that time are lost
/// and counted.
template <RegisterBus Bus>
class FlashStore {
 public:
  /// The store is `pages` pages from number `firstPage` of the memory on.
  FlashStore(Bus bus, EccErrors& errors, std::uint32_t firstPage, std::uint32_t pages)
      : bus_(bus), errors_(errors), firstPage_(firstPage), pages_(pages) {}

  std::size_t size() const noexcept { return pages_ * pageSize(); }
  std::size_t pageSize() const noexcept { return kFlashPageBytes; }

  hal::StoreResult read(std::size_t offset, std::span<std::byte> to) const noexcept {
    if (!isInside(offset, to.size())) return hal::StoreResult::kOutOfRange;
    const EccWatch watch(bus_, errors_);
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] = static_cast<std::byte>(wordAt((offset + i) & ~std::size_t{3}) >> (8 * ((offset + i) & 3)));
    return watch.isClean() ? hal::StoreResult::kOk : hal::StoreResult::kUnreadable;
  }

  /// Of the whole flash memory.
  hal::StoreErrors errors() const noexcept {
    return {.corrected = errors_.corrected, .unreadable = errors_.unreadable};
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
  static constexpr std::size_t kUnit_bytes = hal::kStoreUnit_bytes;  ///< double words: each has its ECC
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

  /// Its error is noted at once, so that it hides none of the words that are read next.
  std::uint32_t wordAt(std::size_t offset) const noexcept {
    const std::uint32_t word = bus_.read(addressAt(offset));
    noteEccErrors(bus_, errors_);
    return word;
  }

  /// False for what can't be read, too: programming would fail or make it worse.
  bool isErased(std::size_t offset, std::size_t length) const noexcept {
    const EccWatch watch(bus_, errors_);
    std::uint32_t all = 0xFFFF'FFFF;
    for (std::size_t i = 0; i < length; i += 4) all &= wordAt(offset + i);
    return watch.isClean() && all == 0xFFFF'FFFF;
  }

  bool holds(std::size_t offset, std::span<const std::byte> bytes) const noexcept {
    const EccWatch watch(bus_, errors_);
    bool same = true;
    for (std::size_t i = 0; i < bytes.size(); i += 4) same &= wordAt(offset + i) == wordOf(bytes.subspan(i));
    return watch.isClean() && same;
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

  void lock() noexcept {
    modify(bus_, Flash::Cr::lock(1));
    refreshDataCache(bus_);
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
  EccErrors& errors_;
  std::uint32_t firstPage_;
  std::uint32_t pages_;
};

}  // namespace strainfinger::stm32g431
