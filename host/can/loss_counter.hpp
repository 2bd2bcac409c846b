#pragma once
// How many frames of each finger were lost on the way, from their sequence numbers.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/can_frame.hpp"
#include "common/frames.hpp"

namespace strainfinger::can {

/// What was seen of one node.
struct NodeCount {
  std::string interface;
  std::uint8_t node = 0;
  std::uint64_t received = 0;            ///< of touches: CONTACT, FORCE, PATCH, CONTACT2 and FORCE2
  std::uint64_t lost = 0;                ///< of these, as far as the sequence numbers tell: modulo 256
  std::uint64_t repeated = 0;            ///< the same number twice in a row
  std::optional<std::uint8_t> protocol;  ///< of its last HEARTBEAT
  std::uint64_t restarts = 0;  ///< the uptime went back; frames lost across a restart cannot be counted
};

class LossCounter {
 public:
  /// Takes any frame; those that are no finger's are ignored.
  void count(const std::string& interface, const CanFrame& frame);

  /// By interface, then node.
  std::vector<NodeCount> counts() const;

 private:
  /// Sequence numbers of the last two frames of a kind.
  struct Numbers {
    std::uint8_t last;
    std::optional<std::uint8_t> before;
    bool has(std::uint8_t number) const { return number == last || number == before; }
  };
  struct Stream {
    NodeCount seen;
    std::map<FunctionCode, Numbers> numbers;
    std::optional<std::uint8_t> announced;  ///< of the last PATCH, if a second contact belongs to it
    std::uint16_t uptime_s = 0;
  };
  template <typename Frame>
  bool countNumbered(const std::string& interface, const CanFrame& frame);
  Stream& streamOf(const std::string& interface, std::uint8_t node);
  static void countAnnounced(Stream& stream, const PatchFrame& patch);
  static void countHeartbeat(Stream& stream, const HeartbeatFrame& heartbeat);

  std::map<std::pair<std::string, std::uint8_t>, Stream> streams_;
};

}  // namespace strainfinger::can
