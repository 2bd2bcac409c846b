#include "host/can/open_bus.hpp"

#include <fmt/format.h>
#include <net/if.h>

#include <algorithm>
#include <string_view>

#include "host/base/edit_distance.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/text_parts.hpp"
#include "host/can/socketcan_port.hpp"
#include "host/can/udp_port.hpp"

namespace strainfinger::can {
namespace {

constexpr std::string_view kDigits = "0123456789";

/// The bus between programs that a name was meant to be, as upd:30010 and udp30010 are; "": none.
std::string meantUdp(std::string_view name) {
  constexpr std::string_view kUdp = "udp";
  constexpr std::size_t kMostOff = 2;
  const std::string word = lowerCase(name.substr(0, std::min(name.find_first_of(kDigits), name.find(':'))));
  std::string_view port = name.substr(word.size());
  const bool hasColon = port.starts_with(':');  // no interface has one
  if (hasColon) port.remove_prefix(1);
  const bool isMeant =
      std::ranges::is_permutation(word, kUdp) || (hasColon && editDistance(word, kUdp) <= kMostOff);
  if (!isMeant || port.find_first_not_of(kDigits) != port.npos) return "";
  return port.empty() ? std::string(kUdp) : fmt::format("{}:{}", kUdp, port);
}

}  // namespace

std::unique_ptr<BusPort> openBus(const std::string& name, int bitrate, BusFilter filter) {
  if (isUdpName(name)) return std::make_unique<UdpPort>(name, filter);
  if (name == "loopback")
    throw Failure(ExitCode::kUsage,
                  "loopback is inside one `run` and no other program hears it: use udp on both sides");
  if (const std::string meant = meantUdp(name); !meant.empty() && ::if_nametoindex(name.c_str()) == 0)
    throw Failure(ExitCode::kNoInterface,
                  fmt::format("{} is no bus: did you mean {}?", excerpt(name), meant));
  return std::make_unique<SocketCanPort>(name, bitrate, filter);
}

}  // namespace strainfinger::can
