#pragma once
// What a finger keeps of its configuration when power goes: which node it is and how often it tells.
//
// One record a page, in all pages of a store taken in turn: while one is erased and written, the others still
// hold what was there before, so that a power cut loses the new settings at worst and never the old ones. A
// page that fails is passed over.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/commands.hpp"
#include "common/crc32.hpp"
#include "firmware/app/erase_budget.hpp"
#include "hal/non_volatile.hpp"

namespace strainfinger::firmware {

struct StoredSettings {
  std::uint8_t node = kFirstNode;
  std::uint16_t contactRate_hz = 0;
  bool operator==(const StoredSettings&) const = default;
};

/// What a store has. `damaged`: there are bytes in it that are neither erased nor a record, or that can't be
/// read: a power cut has ended a change, or a page is worn.
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
  settings.standingFaults.set(FingerFault::kConfiguration, found.damaged);
  return settings;
}

enum class SaveResult : std::uint8_t { kSaved, kWait, kFailed };

/// Settings in a hal::NonVolatile of at least two pages. All calls take bounded time; save() stops the board
/// for as long as its memory takes to erase a page, for each page that it has to pass over.
template <hal::NonVolatile Store>
class SettingsStore {
 public:
  explicit SettingsStore(Store& store) : store_(store) {
    for (std::size_t page = 0; page < pages(); ++page) take(page);
  }

  /// As it was when this was made, or what was saved since.
  const SettingsFound& found() const { return found_; }

  /// Pages erased in the store's life, but for those whose erasing a power cut ended.
  std::uint32_t erases() const { return erases_; }

  /// Nothing has to be erased to keep these, and nothing to be mended.
  bool has(const StoredSettings& settings) const { return found_.settings == settings && !damagedPage_; }

  /// kWait: no page may be erased before budget.wait_s(now_s); nothing is lost. kFailed: no page takes them.
  SaveResult save(const StoredSettings& settings, EraseBudget& budget, std::uint32_t now_s) {
    if (has(settings)) return SaveResult::kSaved;
    for (std::size_t tried = found_.settings ? 1 : 0; tried < pages(); ++tried) {
      if (budget.wait_s(now_s) > 0) return SaveResult::kWait;
      budget.spend(now_s);
      if (!write(nextPage(), settings)) continue;
      found_.settings = settings;
      newestPage_ = lastPage_;
      return SaveResult::kSaved;
    }
    return SaveResult::kFailed;
  }

 private:
  using Page = std::uint16_t;
  enum Word : std::uint8_t { kMagicWord, kErases, kValues, kCheck, kWords };
  using Record = std::array<std::uint32_t, kWords>;
  static_assert(sizeof(Record) % hal::kStoreUnit_bytes == 0);
  static constexpr std::uint32_t kMagic = 0x32474643;  ///< "CFG2"; another layout gets another number

  std::size_t pages() const { return store_.pageSize() == 0 ? 0 : store_.size() / store_.pageSize(); }

  /// The record of a page, if it is a later one than those seen before: records are numbered by the erases.
  void take(std::size_t page) {
    Record record{};
    const auto result = store_.read(page * store_.pageSize(), std::as_writable_bytes(std::span(record)));
    const bool whole = result == hal::StoreResult::kOk && record[kMagicWord] == kMagic &&
                       record[kCheck] == checkOf(record) && isPossible(settingsOf(record));
    if (!whole) {
      const bool isDamaged = result != hal::StoreResult::kOk || !isErased(record);
      found_.damaged |= isDamaged;
      if (isDamaged) damagedPage_ = static_cast<Page>(page);
    } else if (!found_.settings || record[kErases] > erases_) {
      found_.settings = settingsOf(record);
      erases_ = record[kErases];
      newestPage_ = lastPage_ = static_cast<Page>(page);
    }
  }

  /// One that is damaged; else the one after that which was erased last, but never the one that holds the
  /// newest record.
  std::size_t nextPage() const {
    if (damagedPage_) return *damagedPage_;
    const std::size_t next = (lastPage_ + 1) % pages();
    return found_.settings && next == newestPage_ ? (next + 1) % pages() : next;
  }

  bool write(std::size_t page, const StoredSettings& settings) {
    lastPage_ = static_cast<Page>(page);
    if (damagedPage_ == lastPage_) damagedPage_.reset();  // mended, or worn
    ++erases_;
    if (store_.erase(page) != hal::StoreResult::kOk) return false;
    const Record record = recordOf(settings, erases_);
    return store_.write(page * store_.pageSize(), std::as_bytes(std::span(record))) == hal::StoreResult::kOk;
  }

  static std::uint32_t checkOf(const Record& record) {
    return crc32(std::as_bytes(std::span(record).first(kCheck)));
  }

  static Record recordOf(const StoredSettings& settings, std::uint32_t erases) {
    Record record{kMagic, erases, settings.node | std::uint32_t{settings.contactRate_hz} << 16};
    record[kCheck] = checkOf(record);
    return record;
  }

  static StoredSettings settingsOf(const Record& record) {
    return {static_cast<std::uint8_t>(record[kValues] & 0xFF),
            static_cast<std::uint16_t>(record[kValues] >> 16)};
  }

  static bool isPossible(const StoredSettings& settings) {
    return settings.node >= kFirstNode && settings.node <= kLastNode &&
           settings.contactRate_hz >= kSlowestContactRate_hz &&
           settings.contactRate_hz <= kFastestContactRate_hz;
  }

  static bool isErased(const Record& record) {
    return std::ranges::all_of(record, [](std::uint32_t word) { return word == 0xFFFF'FFFF; });
  }

  Store& store_;
  SettingsFound found_{};
  std::uint32_t erases_ = 0;
  Page newestPage_ = 0;              ///< if there are settings
  Page lastPage_ = 0;                ///< erased last
  std::optional<Page> damagedPage_;  ///< to be written next
};

}  // namespace strainfinger::firmware
