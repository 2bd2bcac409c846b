#pragma once
// A bus by its name.

#include <memory>
#include <string>

#include "host/can/bus_port.hpp"

namespace strainfinger::can {

/// "udp" and "udp:PORT" are a UdpPort, every other name is that of a SocketCAN interface. Throws
/// Failure(kNoInterface) with what would help when there is no such bus, Failure(kUsage) when it is no name
/// of one. `bitrate` [bit/s] is for that message only.
std::unique_ptr<BusPort> openBus(const std::string& name, int bitrate = 1'000'000, BusFilter filter = {});

}  // namespace strainfinger::can
