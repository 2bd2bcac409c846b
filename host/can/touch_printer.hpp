#pragma once
// Touches as rows of a table, one for all frames of a sequence number: what `strainfinger decode --touches`
// prints.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/can_frame.hpp"
#include "host/base/table_writer.hpp"
#include "host/can/per_node.hpp"
#include "host/can/row_start.hpp"
#include "host/can/touch_receiver.hpp"

namespace strainfinger::can {

/// Prints time_s,interface,node,angle_deg,normal_n,tangential_n,width_m, their sigmas,
/// quality_percent,chi,flags,sequence, then angle2_deg and more of a second contact, alternatives and the
/// number of contacts; empty or null where the finger says nothing. The time is that of CONTACT. The last row
/// of a touch has no flag `contact` and forces of 0; so has the last one of a second contact. What a touch
/// lost is empty or null too; one that lost its CONTACT has no row.
class TouchPrinter {
 public:
  /// Appends to `out`: at once the header, if the format has one.
  TouchPrinter(std::string& out, TableFormat format);

  /// Takes any frame; appends a row when it is the last one of a touch, and for a touch that lost frames when
  /// it shows that no more will come: the node's next CONTACT, or its second HEARTBEAT.
  void print(std::optional<std::int64_t> time_ns, std::string_view interface, const CanFrame& frame);

  /// At the end: appends rows for touches of which no more will come.
  void finish();

 private:
  struct Listener {
    std::optional<TouchReceiver> receiver;  ///< there from its first frame on
    CanFrame contact{};                     ///< the last one
    std::optional<std::int64_t> contactTime_ns;
    int heartbeats = 0;  ///< since then
  };
  static bool isRepeated(const Listener& listener, FunctionCode function, const CanFrame& frame);
  static bool showsEnd(Listener& listener, FunctionCode function);
  void giveUp(std::string_view interface, std::uint8_t node, Listener& listener);
  void appendRow(const std::optional<TouchReport>& touch, std::string_view interface, std::uint8_t node,
                 const Listener& listener);
  void append(const TouchReport& touch);
  void appendNumber(double value);
  void appendFlags(FingerFlags flags);

  std::string& out_;
  TableFormat format_;
  RowStart start_;
  PerNode<Listener> listeners_;
};

}  // namespace strainfinger::can
