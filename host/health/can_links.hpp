#pragma once
// The CAN interfaces of this machine, as `ip` (Debian's iproute2) shows them.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace strainfinger::health {

/// An interface. What is not there (a virtual one has no controller and no bit rate) is not set.
struct CanLink {
  std::string name;
  bool isUp = false;
  std::string state{};  ///< of the controller: "ERROR-ACTIVE", "BUS-OFF"; empty: there is none
  bool isListenOnly = false;
  std::optional<int> bitrate{};  ///< [bit/s]
  std::optional<double> samplePoint{};
  std::optional<int> restart_ms{};  ///< after which a controller that left the bus comes back; 0: never
  std::optional<int> txErrors{}, rxErrors{};  ///< ISO 11898's counters
};

/// Those in what `ip -details -json link show` prints. Throws Failure(kFailure) where that is no such JSON:
/// iproute2 before 5.16 mixes text into it.
std::vector<CanLink> parseCanLinks(std::string_view json);

/// Those of this machine. Throws Failure(kFailure) where `ip` is not installed or can't be read.
std::vector<CanLink> canLinks();

}  // namespace strainfinger::health
