#pragma once
// A store with faults: power cuts at any point, bytes that cannot be read.

#include <map>
#include <optional>
#include <set>

#include "host/system/memory_store.hpp"

namespace strainfinger::doubles {

/// Work is counted in steps: a unit (8 bytes) programmed is one, a page erased is one. A power cut can
/// therefore be put at each of them: cutPowerAfter(0), (1), ... until the work under test has fewer steps.
class FakeNonVolatile {
 public:
  static constexpr std::size_t kUnit_bytes = system::MemoryStore::kUnit_bytes;
  enum class CutUnit { kErased, kUnreadable };  ///< what the unit being programmed at a cut is afterwards

  explicit FakeNonVolatile(std::size_t pages = 2, std::size_t pageSize_bytes = 256)
      : store_(pages, pageSize_bytes) {}

  /// The power goes after so many further steps. A page being erased then becomes unreadable.
  void cutPowerAfter(int steps, CutUnit unit = CutUnit::kUnreadable) {
    stepsLeft_ = steps;
    cutUnit_ = unit;
  }
  void restorePower() { stepsLeft_.reset(); }
  bool hasPower() const { return !stepsLeft_ || *stepsLeft_ >= 0; }
  int steps() const { return steps_; }  ///< done so far
  int erases(std::size_t page) const { return erases_.contains(page) ? erases_.at(page) : 0; }  ///< so far

  /// As if reading had found so many.
  void found(hal::StoreErrors errors) { errors_ = errors; }

  /// The page no longer takes what is erased or written.
  void wearOut(std::size_t page) { worn_.insert(page); }

  /// The unit that holds `offset` can't be read until its page is erased.
  void damage(std::size_t offset) { unreadable_.insert(offset / kUnit_bytes); }

  std::size_t size() const noexcept { return store_.size(); }
  std::size_t pageSize() const noexcept { return store_.pageSize(); }

  hal::StoreResult read(std::size_t offset, std::span<std::byte> to) const noexcept {
    if (!hasPower()) return hal::StoreResult::kFailed;
    const auto result = store_.read(offset, to);
    const bool damaged = result == hal::StoreResult::kOk && touchesDamage(offset, to.size());
    errors_.unreadable += damaged;
    return damaged ? hal::StoreResult::kUnreadable : result;
  }

  hal::StoreErrors errors() const noexcept { return errors_; }

  hal::StoreResult write(std::size_t offset, std::span<const std::byte> from) noexcept {
    if (!hasPower()) return hal::StoreResult::kFailed;
    if (const auto result = store_.canWrite(offset, from.size()); result != hal::StoreResult::kOk)
      return result;
    if (touchesDamage(offset, from.size())) return hal::StoreResult::kNotErased;
    for (std::size_t done = 0; done < from.size(); done += kUnit_bytes)
      if (const auto result = program(offset + done, from.subspan(done, kUnit_bytes));
          result != hal::StoreResult::kOk)
        return result;
    return hal::StoreResult::kOk;
  }

  hal::StoreResult erase(std::size_t page) noexcept {
    if (!hasPower()) return hal::StoreResult::kFailed;
    if (page >= size() / pageSize()) return hal::StoreResult::kOutOfRange;
    const std::size_t units = pageSize() / kUnit_bytes;
    const bool cut = !step();
    ++erases_[page];
    if (worn_.contains(page)) return hal::StoreResult::kFailed;
    for (std::size_t unit = page * units; unit < (page + 1) * units; ++unit)
      cut ? void(unreadable_.insert(unit)) : void(unreadable_.erase(unit));
    return cut ? hal::StoreResult::kFailed : store_.erase(page);
  }

 private:
  /// False: the power goes before this step.
  bool step() {
    if (stepsLeft_ && (*stepsLeft_)-- == 0) return false;
    ++steps_;
    return true;
  }

  hal::StoreResult program(std::size_t offset, std::span<const std::byte> unit) {
    if (step()) return store_.write(offset, unit);
    if (cutUnit_ == CutUnit::kUnreadable) damage(offset);
    return hal::StoreResult::kFailed;
  }

  bool touchesDamage(std::size_t offset, std::size_t length) const {
    const auto first = unreadable_.lower_bound(offset / kUnit_bytes);
    return length > 0 && first != unreadable_.end() && *first * kUnit_bytes < offset + length;
  }

  system::MemoryStore store_;
  std::set<std::size_t> unreadable_;  ///< units
  std::set<std::size_t> worn_;        ///< pages
  std::optional<int> stepsLeft_;      ///< -1: the power is gone
  CutUnit cutUnit_ = CutUnit::kUnreadable;
  int steps_ = 0;
  std::map<std::size_t, int> erases_;  ///< by page
  mutable hal::StoreErrors errors_{};
};

static_assert(hal::NonVolatile<FakeNonVolatile>);

}  // namespace strainfinger::doubles
