#pragma once
// How many frames of each finger were lost on the way, from their sequence numbers; and whether two fingers
// have one node number.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/can_frame.hpp"
#include "common/frames.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/per_node.hpp"

namespace strainfinger::can {

/// What was seen of one node.
struct NodeCount {
  std::string interface;
  std::uint8_t node = 0;
  std::uint64_t received = 0;            ///< of touches: CONTACT, FORCE, PATCH, CONTACT2 and FORCE2
  std::uint64_t lost = 0;                ///< of these, as far as the sequence numbers tell: modulo 256
  std::uint64_t repeated = 0;            ///< the same number twice in a row
  std::optional<std::uint8_t> protocol;  ///< of its last HEARTBEAT
  std::uint64_t restarts = 0;        ///< the uptime went back; frames lost across a restart cannot be counted
  bool twoSenders = false;           ///< two fingers are this node: the other counts mean nothing then
  std::vector<std::uint8_t> tables;  ///< last byte of their CRC-32, each time that it was another
};

/// "its tables changed meanwhile (2C, 8F)": what to tell where they did; "": they didn't.
std::string tableChangesText(const NodeCount& node);

/// Throws Failure(kMismatch) where the node speaks another protocol.
void requireOurProtocol(const NodeCount& node);

class LossCounter {
 public:
  /// Takes any frame; those that are no finger's are ignored. True: it is a sign of two fingers with one
  /// number, of which there have to be several.
  bool count(std::string_view interface, const CanFrame& frame);

  /// Where two fingers were this node: from here on they are only if they give themselves away anew.
  void forgetTwin(std::string_view interface, std::uint8_t node);

  /// By interface, then node.
  std::vector<NodeCount> counts() const;

 private:
  /// Sequence numbers of a kind of frame.
  struct Numbers {
    std::uint8_t last;
    std::uint64_t data;                       ///< of the last frame
    std::optional<std::uint8_t> before{};     ///< the number before the last
    std::optional<std::uint8_t> beforeGap{};  ///< the number before the last gap
    std::uint8_t gap = 0;                     ///< frames counted as lost there
    bool has(std::uint8_t number) const { return number == last || number == before; }
  };
  /// Two senders give themselves away again and again by going on where a gap began: in their sequence
  /// numbers, uptimes or boards.
  struct Evidence {
    std::uint64_t gaps = 0;         ///< that one sender can leave as well
    std::uint64_t resumptions = 0;  ///< of what a gap had ended
    bool isOfTwo() const;
  };
  struct Stream {
    NodeCount seen;
    Evidence evidence;
    std::array<std::optional<Numbers>, (kMaxCanId + 1) / kIdsPerFunction> numbers;
    std::optional<std::uint8_t> announced;  ///< of the last PATCH, if a second contact belongs to it
    std::optional<std::uint16_t> uptime_s;
    std::optional<std::uint16_t> uptimeBeforeJump_s;
    int sameUptime = 0;                        ///< heartbeats
    std::optional<std::uint8_t> tablesBefore;  ///< those of seen.tables are the ones after
    std::uint8_t board = 0;
    std::uint8_t boardBefore = 0;
  };
  static void countFrame(Stream& stream, FunctionCode function, const CanFrame& frame);
  static void countNumber(Stream& stream, FunctionCode function, std::uint8_t number, std::uint64_t data);
  static void countGap(Stream& stream, Numbers& numbers, std::uint8_t number);
  static void countAnnounced(Stream& stream, const PatchFrame& patch);
  static void countHeartbeat(Stream& stream, const HeartbeatFrame& heartbeat);
  static void countUptime(Stream& stream, std::uint16_t uptime_s);
  static void countTables(Stream& stream, const HeartbeatFrame& heartbeat);
  static void countBoard(Stream& stream, std::uint8_t board);

  PerNode<Stream> streams_;
};

}  // namespace strainfinger::can
