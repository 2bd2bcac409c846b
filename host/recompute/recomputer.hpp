#pragma once
// What a finger must have said, computed again from the readings in a recording.

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/can_frame.hpp"
#include "common/table_image.hpp"
#include "firmware/core/locator.hpp"
#include "host/can/raw_receiver.hpp"

namespace strainfinger::recompute {

/// The finger that was recorded.
struct RecordedFinger {
  std::uint8_t node = 1;
  std::uint16_t contactRate_hz = 500;
  firmware::FitMode mode = firmware::FitMode::kRefined;
};

struct RecomputeTally {
  std::uint64_t sets = 0;       ///< sample sets that went through the firmware, from a tare on
  std::uint64_t leftOut = 0;    ///< sample sets before the first tare, and from a gap to the next tare
  std::uint64_t gaps = 0;       ///< sample sets missing between two recorded ones: each ends what is known
  std::uint64_t compared = 0;   ///< frames of touches
  std::uint64_t different = 0;  ///< of these
  std::uint64_t absent = 0;     ///< frames that should be in the recording, and aren't
  std::optional<std::string> first{};  ///< the first difference, in words
};

/// Puts the RAW of a recording through the firmware's own code and compares the frames of touches, bit for
/// bit.
///
/// What a finger says depends on its sample sets since the last tare alone: so the recording needs RAW of
/// every sample set, from before a tare on. Only the sequence numbers' start and the flags `simulated` and
/// `uncalibrated`, which no reading tells, are taken from the recording. Frames that the bus held up and the
/// finger therefore left out count as absent.
class Recomputer {
 public:
  /// `tables` passed checkTableImage() and outlive it.
  Recomputer(const TableImage& tables, const RecordedFinger& finger);
  ~Recomputer();

  /// Takes the recording's frames in their order, whosever they are. Throws Failure(kMismatch) when a
  /// heartbeat of the finger says that it has other tables.
  void take(std::int64_t time_ns, const CanFrame& frame);

  /// At the end of the recording.
  RecomputeTally finish();

 private:
  class Engine;
  struct Recorded {
    std::int64_t time_ns;
    CanFrame frame;
  };
  void take(const can::RawSet& set);
  void begin();
  void end();
  void compute(const can::RawSet& set);
  bool isOfTouchBefore(const CanFrame& frame);
  void compareAll();
  void compare(const CanFrame& computed, const Recorded& recorded);

  const TableImage& tables_;
  RecordedFinger finger_;
  can::RawReceiver receiver_;
  std::unique_ptr<Engine> engine_;  ///< absent: what the finger knew is not known
  std::optional<std::uint8_t> lastSample_;
  bool wasZeroing_ = true;  ///< until a set says otherwise: the first sets of a zero may be missing
  int zeroingSets_ = 0;
  std::optional<std::uint8_t> firstSequence_;  ///< recorded, of what the engine numbers 0
  std::optional<std::uint8_t> before_;         ///< sequence of the end of a touch from before the tare
  bool hasSecond_ = false;                     ///< a second contact has begun since the tare
  std::map<std::uint16_t, std::deque<Recorded>> recorded_;  ///< by identifier
  std::map<std::uint16_t, std::deque<CanFrame>> computed_;
  RecomputeTally tally_;
};

}  // namespace strainfinger::recompute
