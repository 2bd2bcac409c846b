#pragma once
// What a firmware that goes wrong leaves in memory for the one that starts after it.

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "common/crc32.hpp"
#include "common/frames.hpp"

namespace strainfinger::firmware {

/// How the last run ended, for the first moments of the next. Zero restarts and no crash after power-on.
struct LastRun {
  Crash crash = Crash::kNone;
  std::uint8_t restarts = 0;        ///< since power-on; 255 means that or more
  std::uint32_t crash_address = 0;  ///< of the instruction at fault; 0 where there is none to blame
};

/// Why the board started, where it has no register that tells: a crash record is there unless power came on.
constexpr ResetCause resetCause(const LastRun& last) {
  if (last.crash == Crash::kHang || last.crash == Crash::kStarved) return ResetCause::kWatchdog;
  return last.crash == Crash::kNone ? ResetCause::kPowerOn : ResetCause::kSoftware;
}

/// For memory that nobody clears: after power-on it holds anything, and must not be believed.
class CrashRecord {
 public:
  /// A restart is about to follow.
  void write(Crash crash, std::uint32_t address) {
    const std::uint32_t before = isWhole() ? words_[kRestarts] : 0;
    words_ = {kMagic, static_cast<std::uint32_t>(crash), before < 255 ? before + 1 : before, address, 0};
    words_[kCheck] = checkOf(words_);
  }

  /// What write() left before this start. A crash is told once: a later restart for another reason is not
  /// its.
  LastRun take() {
    if (!isWhole()) return {};
    const LastRun run{static_cast<Crash>(words_[kCrash]), static_cast<std::uint8_t>(words_[kRestarts]),
                      words_[kAddress]};
    words_[kCrash] = static_cast<std::uint32_t>(Crash::kNone);
    words_[kAddress] = 0;
    words_[kCheck] = checkOf(words_);
    return run;
  }

 private:
  enum Word : std::uint8_t { kMagicWord, kCrash, kRestarts, kAddress, kCheck, kWords };
  using Words = std::array<std::uint32_t, kWords>;
  static constexpr std::uint32_t kMagic = 0x48534352;  ///< "RCSH"

  static std::uint32_t checkOf(const Words& words) {
    return crc32(std::as_bytes(std::span(words).first(kCheck)));
  }
  bool isWhole() const { return words_[kMagicWord] == kMagic && words_[kCheck] == checkOf(words_); }

  Words words_;
};

}  // namespace strainfinger::firmware
