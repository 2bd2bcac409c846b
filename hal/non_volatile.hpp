#pragma once
// Memory that survives a reset, as the firmware sees it.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

namespace strainfinger::hal {

// clang-format off
enum class [[nodiscard]] StoreResult : std::uint8_t {
  kOk = 0,
  kOutOfRange = 1,  ///< nothing was touched
  kUnreadable = 2,  ///< the memory reports the bytes damaged (ECC); the destination is unspecified
  kNotErased = 3,   ///< write onto bytes that were not erased; nothing was touched
  kFailed = 4,      ///< the memory refused or verification after writing failed
};
// clang-format on

/// Units of the memory, counted at each read since the start, that were not as they were written.
struct StoreErrors {
  std::uint32_t corrected = 0;   ///< but could be put right
  std::uint32_t unreadable = 0;  ///< and could not
};

/// What is written at once.
inline constexpr std::size_t kStoreUnit_bytes = 8;

/// Contract of a store of `size()` bytes in pages of `pageSize()`:
///  - `erase(page)` sets a whole page, counted from 0, to 0xFF. Interrupted by a power cut, the page may read
///    as anything or not at all until it is erased again.
///  - `write(offset, bytes)` programs erased bytes; offset and length are multiples of kStoreUnit_bytes (else
///    kOutOfRange). Interrupted by a power cut, any number of units from the start may have been written, and
///    the next may be unreadable.
///  - `read(offset, bytes)` reads any range.
///  - `errors()` only grow.
// clang-format off
template <typename T>
concept NonVolatile = requires(T store, const T constStore, std::size_t position,
                               std::span<const std::byte> from, std::span<std::byte> to) {
  { constStore.size() } noexcept -> std::same_as<std::size_t>;
  { constStore.pageSize() } noexcept -> std::same_as<std::size_t>;
  { constStore.read(position, to) } noexcept -> std::same_as<StoreResult>;
  { store.write(position, from) } noexcept -> std::same_as<StoreResult>;
  { store.erase(position) } noexcept -> std::same_as<StoreResult>;
  { constStore.errors() } noexcept -> std::same_as<StoreErrors>;
};
// clang-format on

/// For boards without such memory: every access is out of range.
struct NoStore {
  std::size_t size() const noexcept { return 0; }
  std::size_t pageSize() const noexcept { return 0; }
  StoreResult read(std::size_t, std::span<std::byte>) const noexcept { return StoreResult::kOutOfRange; }
  StoreResult write(std::size_t, std::span<const std::byte>) noexcept { return StoreResult::kOutOfRange; }
  StoreResult erase(std::size_t) noexcept { return StoreResult::kOutOfRange; }
  StoreErrors errors() const noexcept { return {}; }
};
static_assert(NonVolatile<NoStore>);
inline NoStore noStore;

}  // namespace strainfinger::hal
