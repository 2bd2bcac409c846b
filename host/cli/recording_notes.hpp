#pragma once
// What is written down beside a recorded log: the config, versions, and the fingers that were heard.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/can_frame.hpp"
#include "common/frames.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::cli {

/// A time in which the bus was away: its interface down or gone, or its controller bus-off.
struct RecordingGap {
  std::int64_t start_ns = 0;  ///< since 1970
  std::int64_t end_ns = 0;    ///< 0: not yet
};

/// How far a recording has come.
struct RecordingProgress {
  std::int64_t start_ns = 0;  ///< since 1970
  std::int64_t end_ns = 0;    ///< 0: it goes on, or was cut off
  std::uint64_t frames = 0;
  std::uint64_t missed = 0;  ///< frames that this machine was too slow for
  std::uint64_t gaps = 0;
  std::vector<RecordingGap> firstGaps{};  ///< of `gaps`
};

class RecordingNotes {
 public:
  RecordingNotes(std::string bus, const config::FingerConfig& config);

  /// Takes any frame; true: something is known now that was not.
  bool note(const CanFrame& frame);

  /// The fingers that last said to have other tables than those of this CRC-32.
  std::vector<std::uint8_t> nodesOfOtherTables(std::uint32_t tables_crc32) const;

  /// A finger.toml with a section [recording], which readers of configs pass over: it can be given to -c.
  std::string toml(const RecordingProgress& progress) const;

 private:
  struct Finger {
    std::optional<InfoFrame> info;
    std::optional<HeartbeatFrame> heartbeat;
    std::optional<std::uint8_t> tables{};      ///< last byte of their CRC-32, while it works with some
    std::vector<std::uint8_t> tablesBefore{};  ///< earlier ones, in their order

    void noteTables(const HeartbeatFrame& of);
  };
  std::string bus_;
  std::string config_;  ///< as text
  std::map<std::uint8_t, Finger> fingers_;
};

}  // namespace strainfinger::cli
