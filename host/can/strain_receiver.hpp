#pragma once
// RAW of one finger as strains.

#include <cstdint>
#include <optional>
#include <vector>

#include "common/can_frame.hpp"
#include "host/can/raw_receiver.hpp"

namespace strainfinger::can {

/// A sample set, a strain a gauge: at nominal gain, less the finger's zero.
struct StrainSet {
  bool zeroing = false;  ///< it goes into the zero
  std::vector<double> strains;
};

/// Listens to one node of so many gauges, whose converter covers +- fullScale_strain.
class StrainReceiver {
 public:
  StrainReceiver(std::uint8_t node, int gauges, double fullScale_strain)
      : raw_(node, gauges), strainOfCode_(strainPerCode(fullScale_strain)) {}

  /// Takes any frame; a set when it is the set's last page and the finger has told its zeros.
  std::optional<StrainSet> take(const CanFrame& frame) {
    const auto set = raw_.take(frame);
    const auto& zeros = raw_.zeros();
    if (!set) return std::nullopt;
    if (zeros.size() != set->codes.size()) {
      ++withoutZeros_;
      return std::nullopt;
    }
    StrainSet found{set->zeroing, {}};
    for (std::size_t i = 0; i < zeros.size(); ++i)
      found.strains.push_back(strainOfCode_ * (int{set->codes[i]} - int{zeros[i]}));
    return found;
  }

  /// As RawReceiver's.
  const std::vector<std::uint16_t>& zeros() const { return raw_.zeros(); }
  std::uint64_t incomplete() const { return raw_.incomplete(); }  ///< sets that lost a page
  std::uint64_t withoutZeros() const { return withoutZeros_; }    ///< whole sets before the first zeros
  /// As RawReceiver's.
  void requireAllGauges() const { raw_.requireAllGauges(); }
  bool sendsAny() const { return raw_.sendsAny(); }
  void requireEnoughGauges() const { raw_.requireEnoughGauges(); }

 private:
  RawReceiver raw_;
  double strainOfCode_;
  std::uint64_t withoutZeros_ = 0;
};

}  // namespace strainfinger::can
