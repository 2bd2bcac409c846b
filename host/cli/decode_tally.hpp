#pragma once
// What became of the lines that `strainfinger decode` read, and how that is told at the end.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "host/can/candump_text.hpp"
#include "host/can/loss_counter.hpp"

namespace strainfinger::cli {

/// Why a frame is not decoded.
enum class SkipReason : std::uint8_t {
  kOtherIdentifier,
  kOtherTime,    ///< outside --from and --to
  kOtherNode,    ///< none of --node
  kRaw,          ///< readings, which have readers of their own
  kForeign,      ///< of a finger that speaks another protocol
  kWrongLength,  ///< a finger's identifier with another number of bytes
  kExtended,
  kRemote,
  kFd,
  kError,
};

class DecodeTally {
 public:
  void countLine() { ++lines_; }
  void countUnreadable() { ++unreadable_; }

  /// Takes any line with a frame.
  void noteForm(const can::LogLine& line);
  bool knowsForm() const { return !form_.empty(); }

  /// By candump, as it says.
  void countDropped(std::uint32_t frames) { dropped_ += frames; }

  void countDecoded(std::string_view interface, const CanFrame& frame);
  /// A finger speaks another protocol, by this HEARTBEAT.
  void noteForeign(std::string_view interface, const CanFrame& heartbeat) {
    losses_.count(interface, heartbeat);
  }
  /// Of such a finger.
  void countForeign(std::string_view interface, const CanFrame& frame);
  void countSkipped(SkipReason reason) { ++skipped_[static_cast<std::size_t>(reason)]; }
  /// `place`: where it stands, as in stdin:3; of the first one the summary says it.
  void countWrongLength(const std::string& place, const CanFrame& frame);

  /// Prints the summary on stderr.
  void summarise() const;

  /// Throws Failure: kFailure if a line could not be read, kMismatch if a finger speaks another protocol.
  void requireGood() const;

 private:
  void summariseSkipped() const;

  std::uint64_t lines_ = 0;
  std::uint64_t decoded_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t unreadable_ = 0;
  std::array<std::uint64_t, static_cast<std::size_t>(SkipReason::kError) + 1> skipped_{};
  std::string firstWrongLength_;
  std::string form_;  ///< of the first line with a frame
  can::LossCounter losses_;
};

}  // namespace strainfinger::cli
