#pragma once
// A finger's sample sets, put together again from the pages of RAW.

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/can_frame.hpp"
#include "common/frames.hpp"

namespace strainfinger::can {

/// Strain a step of a code: 2^15 of them are the gauges' full scale, whatever the converter's bits.
inline double strainPerCode(double fullScale_strain) { return std::ldexp(fullScale_strain, -15); }

/// A sample set, a code a gauge.
struct RawSet {
  bool zeroing = false;     ///< it goes into the zero
  std::uint8_t sample = 0;  ///< number of the sample set, modulo 256
  std::vector<std::uint16_t> codes;
};

/// Listens to one node of so many gauges. Pages of a node come in order; a set that lost one gives nothing.
class RawReceiver {
 public:
  RawReceiver(std::uint8_t node, int gauges);

  /// Takes any frame; a set when it is the set's last page.
  std::optional<RawSet> take(const CanFrame& frame);

  /// What the gauges read untouched, by the newest whole round of such pages; empty before there was one.
  const std::vector<std::uint16_t>& zeros() const { return zeros_; }

  std::uint64_t incomplete() const { return incomplete_; }  ///< sets that lost a page
  /// Throws Failure(kMismatch) where the finger has told pages of more gauges: there are no more sets then.
  void requireAllGauges() const;
  bool sendsAny() const { return heardGauges_ > 0; }
  /// Where no set was whole: throws Failure(kMismatch) if that is because the finger has fewer gauges.
  void requireEnoughGauges() const;

 private:
  /// The pages of one set so far.
  struct Pages {
    std::uint8_t next = 0;
    std::uint8_t sample = 0;
    RawKind kind = RawKind::kReadings;
    std::vector<std::uint16_t> codes;
  };
  bool isNext(const Pages& pages, const RawFrame& page) const;
  bool add(Pages& pages, const RawFrame& page) const;

  std::uint8_t node_;
  std::size_t gauges_;
  Pages readings_;
  Pages zeroPages_;
  std::vector<std::uint16_t> zeros_;
  std::uint64_t incomplete_ = 0;
  int heardGauges_ = 0;  ///< by the pages; codes beyond the last gauge are 0, as one at its rail may be
  bool hasMoreGauges_ = false;
};

}  // namespace strainfinger::can
