#pragma once
// Whether a finger has the tables that it should have, as far as its HEARTBEAT tells.

#include <cstdint>

#include "common/frames.hpp"

namespace strainfinger::can {

/// It says that it works with other tables than those of this CRC-32, of which it has the lowest byte. One
/// without usable tables, or of another protocol, says nothing of them.
inline bool hasOtherTables(const HeartbeatFrame& heartbeat, std::uint32_t tables_crc32) {
  return heartbeat.protocol == kProtocolVersion && !heartbeat.faults.has(FingerFault::kTables) &&
         heartbeat.table_crc != tableCrcByte(tables_crc32);
}

}  // namespace strainfinger::can
