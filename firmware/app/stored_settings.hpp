#pragma once
// What a finger keeps of its configuration when power goes: which node it is and how often it tells.
//
// One record a page, in two pages taken in turn: while one is erased and written, the other still holds what
// was there before, so that a power cut loses the new settings at worst and never the old ones.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/commands.hpp"
#include "common/crc32.hpp"
#include "hal/non_volatile.hpp"

namespace strainfinger::firmware {

struct StoredSettings {
  std::uint8_t node = kFirstNode;
  std::uint16_t contactRate_hz = 0;
  bool operator==(const StoredSettings&) const = default;
};

/// What a store has. `damaged`: there are bytes in it that are neither erased nor a record, or that can't be
/// read.
struct SettingsFound {
  std::optional<StoredSettings> settings;
  bool damaged = false;
};

/// `settings` as a board starts with them: what the store has takes the place of the image's.
template <typename Settings>
constexpr Settings startedWith(Settings settings, const SettingsFound& found) {
  if (found.settings) {
    settings.node = found.settings->node;
    settings.contactRate_hz = found.settings->contactRate_hz;
  }
  settings.standingFaults.set(FingerFault::kConfiguration, found.damaged && !found.settings);
  return settings;
}

/// Settings in a hal::NonVolatile of at least two pages. Both calls take bounded time; save() stops the board
/// for as long as its memory takes to erase a page.
template <hal::NonVolatile Store>
class SettingsStore {
 public:
  explicit SettingsStore(Store& store) : store_(store) {}

  SettingsFound load() const {
    SettingsFound found;
    if (const auto record = newest(found.damaged)) found.settings = settingsOf(*record);
    return found;
  }

  /// Writes nothing when the store has these settings already.
  hal::StoreResult save(const StoredSettings& settings) {
    bool damaged = false;
    const auto before = newest(damaged);
    if (before && settingsOf(*before) == settings) return hal::StoreResult::kOk;
    const std::uint32_t sequence = before ? (*before)[kSequence] + 1 : 0;
    const std::size_t page = sequence % kPages;  // never that of `before`
    if (const auto erased = store_.erase(page); erased != hal::StoreResult::kOk) return erased;
    const Record record = recordOf(settings, sequence);
    return store_.write(page * store_.pageSize(), std::as_bytes(std::span(record)));
  }

 private:
  enum Word : std::uint8_t { kMagicWord, kSequence, kValues, kCheck, kWords };
  using Record = std::array<std::uint32_t, kWords>;
  static_assert(sizeof(Record) % 8 == 0, "a store is written in units of 8 bytes");
  static constexpr std::size_t kPages = 2;
  static constexpr std::uint32_t kMagic = 0x31474643;  ///< "CFG1"; another layout gets another number

  static std::uint32_t checkOf(const Record& record) {
    return crc32(std::as_bytes(std::span(record).first(kCheck)));
  }

  static Record recordOf(const StoredSettings& settings, std::uint32_t sequence) {
    Record record{kMagic, sequence, settings.node | std::uint32_t{settings.contactRate_hz} << 16};
    record[kCheck] = checkOf(record);
    return record;
  }

  static StoredSettings settingsOf(const Record& record) {
    return {static_cast<std::uint8_t>(record[kValues] & 0xFF),
            static_cast<std::uint16_t>(record[kValues] >> 16)};
  }

  std::optional<Record> recordIn(std::size_t page, bool& damaged) const {
    Record record{};
    const auto result = store_.read(page * store_.pageSize(), std::as_writable_bytes(std::span(record)));
    const bool whole = result == hal::StoreResult::kOk && record[kMagicWord] == kMagic &&
                       record[kCheck] == checkOf(record) && record[kSequence] % kPages == page &&
                       isPossible(settingsOf(record));
    if (whole) return record;
    damaged |= result != hal::StoreResult::kOk || !isErased(record);
    return std::nullopt;
  }

  static bool isPossible(const StoredSettings& settings) {
    return settings.node >= kFirstNode && settings.node <= kLastNode &&
           settings.contactRate_hz >= kSlowestContactRate_hz &&
           settings.contactRate_hz <= kFastestContactRate_hz;
  }

  static bool isErased(const Record& record) {
    for (const std::uint32_t word : record)
      if (word != 0xFFFF'FFFF) return false;
    return true;
  }

  /// The numbers of the two records follow each other: the later is the newer, wherever they wrap.
  std::optional<Record> newest(bool& damaged) const {
    const auto even = recordIn(0, damaged), odd = recordIn(1, damaged);
    if (!even || !odd) return even ? even : odd;
    return static_cast<std::int32_t>((*odd)[kSequence] - (*even)[kSequence]) > 0 ? odd : even;
  }

  Store& store_;
};

}  // namespace strainfinger::firmware
