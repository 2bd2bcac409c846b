#pragma once
// Tables that come over the bus, word by word, into memory that survives a reset.

#include <array>
#include <cstdint>
#include <span>

#include "common/commands.hpp"
#include "hal/non_volatile.hpp"

namespace strainfinger::firmware {

/// After begin() words are taken in order, from the first one on; one that comes again, because its answer
/// was lost, is answered again. The first word of a page erases it, so that tables which nobody began to
/// replace stay whole, and each page is erased once at most for each begin(). What a power cut leaves is
/// found by checkTableImage() at the next start. Cost of a word: 8 bytes of the memory written, or a page
/// erased.
template <hal::NonVolatile Store>
class TableLoader {
 public:
  explicit TableLoader(Store& store) : store_(store) {}

  /// The first word is due.
  void begin() {
    due_ = 0;
    isOpen_ = true;
  }

  /// Since begin() nothing was taken.
  bool isFresh() const { return isOpen_ && due_ == 0; }

  /// `index` below kTableWords.
  ResponseFrame take(std::uint16_t index, std::uint32_t word) {
    if (!isOpen_) return responseTo(Command::kWord, CommandStatus::kOutOfTurn);
    const bool isRepeated = index + 1 == due_ && word == unit_[index % unit_.size()];
    if (!isRepeated && index != due_) return answer(CommandStatus::kOutOfTurn);
    if (!isRepeated) isOpen_ = put(word);
    return answer(isOpen_ ? CommandStatus::kDone : CommandStatus::kNotKept);
  }

 private:
  static constexpr std::size_t kWord_bytes = 4;

  ResponseFrame answer(CommandStatus status) const { return responseTo(Command::kWord, status, due_); }

  bool put(std::uint32_t word) {
    const std::size_t offset = due_ * kWord_bytes;
    const std::size_t page_bytes = store_.pageSize();
    if (page_bytes == 0) return false;
    if (offset % page_bytes == 0 && store_.erase(offset / page_bytes) != hal::StoreResult::kOk) return false;
    unit_[due_ % unit_.size()] = word;
    if ((due_ + 1u) % unit_.size() == 0) {
      const auto unit = std::as_bytes(std::span(unit_));
      if (store_.write(offset + kWord_bytes - unit.size(), unit) != hal::StoreResult::kOk) return false;
    }
    ++due_;
    return true;
  }

  Store& store_;
  std::array<std::uint32_t, hal::kStoreUnit_bytes / kWord_bytes> unit_{};
  std::uint16_t due_ = 0;
  bool isOpen_ = false;
};
static_assert(sizeof(TableImage) % hal::kStoreUnit_bytes == 0);

}  // namespace strainfinger::firmware
