#pragma once
// Follows the fingers of one bus by their frames.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/can_frame.hpp"
#include "host/can/loss_counter.hpp"
#include "host/can/other_frame.hpp"
#include "host/can/strain_receiver.hpp"
#include "host/can/touch_receiver.hpp"
#include "host/config/finger_config.hpp"
#include "host/live/finger_view.hpp"
#include "host/live/rate_meter.hpp"

namespace strainfinger::live {

class Fleet {
 public:
  /// Of the config, the bit rate is for the load and the gauges are for RAW. `tables_crc32`: of the tables
  /// that the config's node should have; nothing: any.
  Fleet(std::string busName, const config::FingerConfig& config,
        std::optional<std::uint32_t> tables_crc32 = std::nullopt)
      : name_(std::move(busName)),
        bitrate_(config.can.bitrate),
        configured_(config.can.node),
        gauges_(config.gauges),
        tables_crc32_(tables_crc32) {}

  /// Takes any frame, in the order of the bus. Times have any origin; one before the last is taken for that.
  void take(std::int64_t time_us, const CanFrame& frame);

  /// Takes a frame of another format, which is no finger's, for frames a second and load.
  void takeOther(std::int64_t time_us, const can::OtherFrame& other);

  /// How things are now; spans of force begin anew.
  BusView view(std::int64_t now_us);

  /// Two fingers answer by this number, or did until a few seconds ago.
  bool hasTwin(std::uint8_t number, std::int64_t now_us) const;

 private:
  /// Of one node, which may turn out to be no finger.
  struct Node {
    Node(std::uint8_t number, const config::Gauges& ring)
        : receiver(number), raw(number, ring.count, ring.full_scale_strain) {}
    can::TouchReceiver receiver;
    can::StrainReceiver raw;
    std::optional<HeartbeatFrame> heartbeat{};
    std::optional<InfoFrame> info{};
    std::optional<GaugesFrame> gauges{};
    std::optional<can::TouchReport> touch{};
    std::int64_t twin_us = 0;     ///< when the last sign of another of its number came
    std::int64_t heard_us = 0;    ///< when its last HEARTBEAT came
    std::int64_t touched_us = 0;  ///< when its last touch was complete
    std::int64_t since_us = 0;    ///< when the first of its kind was
    std::vector<double> strains{};
    std::int64_t strained_us = 0;  ///< when these came
    ForceSpan span{};
    double strongest_n = 0;
    RateMeter contacts{}, rawBits{};
    std::array<std::int64_t, 10> intervals_us{};  ///< between HEARTBEATs
    std::size_t intervals = 0;                    ///< so many so far
  };
  Node& nodeAt(std::uint8_t number);
  void countLosses(std::uint8_t number, Node& node, const CanFrame& frame);
  static bool showsTwin(const can::NodeCount& count, const Node& node, std::int64_t now_us);
  static void takeHeartbeat(Node& node, std::int64_t time_us, const HeartbeatFrame& heartbeat);
  static void takeTouch(Node& node, std::int64_t time_us, const can::TouchReport& touch);
  double loadOf(RateMeter& bits) const;  ///< share of the bit rate, now
  FingerView viewOf(std::uint8_t number, Node& node);

  std::string name_;
  int bitrate_;
  int configured_;  ///< the config's node
  config::Gauges gauges_;
  std::optional<std::uint32_t> tables_crc32_;
  std::int64_t now_us_ = 0;
  std::map<std::uint8_t, Node> nodes_;
  can::LossCounter losses_;
  RateMeter frames_, bits_;
};

}  // namespace strainfinger::live
