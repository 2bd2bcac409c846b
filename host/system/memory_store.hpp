#pragma once
// Memory of this process as a hal::NonVolatile, with flash's rules.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "hal/non_volatile.hpp"

namespace strainfinger::system {

/// Starts erased and lasts as long as the object. The default page is an STM32G4's.
class MemoryStore {
 public:
  static constexpr std::size_t kUnit_bytes = 8;  ///< programmed at once
  static constexpr std::byte kErased{0xFF};

  explicit MemoryStore(std::size_t pages = 2, std::size_t pageSize_bytes = 2048)
      : pageSize_(pageSize_bytes), bytes_(pages * pageSize_bytes, kErased) {}

  std::size_t size() const noexcept { return bytes_.size(); }
  std::size_t pageSize() const noexcept { return pageSize_; }

  hal::StoreResult read(std::size_t offset, std::span<std::byte> to) const noexcept {
    if (!holds(offset, to.size())) return hal::StoreResult::kOutOfRange;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), to.size(), to.begin());
    return hal::StoreResult::kOk;
  }

  /// What write() of so many bytes would answer.
  hal::StoreResult canWrite(std::size_t offset, std::size_t length) const noexcept {
    if (!holds(offset, length) || offset % kUnit_bytes != 0 || length % kUnit_bytes != 0)
      return hal::StoreResult::kOutOfRange;
    const auto target = std::span(bytes_).subspan(offset, length);
    const bool erased = std::ranges::all_of(target, [](std::byte byte) { return byte == kErased; });
    return erased ? hal::StoreResult::kOk : hal::StoreResult::kNotErased;
  }

  hal::StoreResult write(std::size_t offset, std::span<const std::byte> from) noexcept {
    const auto result = canWrite(offset, from.size());
    if (result == hal::StoreResult::kOk)
      std::ranges::copy(from, bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
    return result;
  }

  hal::StoreErrors errors() const noexcept { return {}; }

  hal::StoreResult erase(std::size_t page) noexcept {
    if (page >= size() / pageSize_) return hal::StoreResult::kOutOfRange;
    std::ranges::fill(std::span(bytes_).subspan(page * pageSize_, pageSize_), kErased);
    return hal::StoreResult::kOk;
  }

 private:
  bool holds(std::size_t offset, std::size_t length) const {
    return offset <= size() && length <= size() - offset;
  }

  std::size_t pageSize_;
  std::vector<std::byte> bytes_;
};

static_assert(hal::NonVolatile<MemoryStore>);

}  // namespace strainfinger::system
