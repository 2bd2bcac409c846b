#pragma once
// Whether a finger still has the zeros that the rows so far were read with.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "host/can/raw_receiver.hpp"
#include "host/config/finger_config.hpp"
#include "host/session/rules.hpp"

namespace strainfinger::session {

/// Told the zeros as they are heard, once a second. They creep as the finger follows drift; what moves them
/// by more between two rounds is another zero: a tare, or one that was taken at a start, whether it was seen
/// to be taken or not.
class ZeroWatch {
 public:
  explicit ZeroWatch(const config::Gauges& gauges)
      : most_codes_(kZeros.moved * gauges.noise_strain / can::strainPerCode(gauges.full_scale_strain)) {}

  /// The newest zeros, a code a gauge; empty before there are any. Whether they are others than the last
  /// ones.
  bool haveMoved(const std::vector<std::uint16_t>& zeros) {
    const auto isNear = [this](int before, int now) { return std::abs(now - before) <= most_codes_; };
    const bool areOthers =
        !zeros_.empty() && !std::equal(zeros_.begin(), zeros_.end(), zeros.begin(), zeros.end(), isNear);
    zeros_ = zeros;
    return areOthers;
  }

 private:
  double most_codes_;
  std::vector<std::uint16_t> zeros_;
};

}  // namespace strainfinger::session
