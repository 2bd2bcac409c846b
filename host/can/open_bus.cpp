#include "host/can/open_bus.hpp"

#include "host/base/failure.hpp"
#include "host/can/socketcan_port.hpp"
#include "host/can/udp_port.hpp"

namespace strainfinger::can {

std::unique_ptr<BusPort> openBus(const std::string& name, int bitrate, BusFilter filter) {
  if (isUdpName(name)) return std::make_unique<UdpPort>(name, filter);
  if (name == "loopback")
    throw Failure(ExitCode::kUsage,
                  "loopback is inside one `run` and no other program hears it: use udp on both sides");
  return std::make_unique<SocketCanPort>(name, bitrate, filter);
}

}  // namespace strainfinger::can
