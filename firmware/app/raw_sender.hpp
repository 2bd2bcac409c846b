#pragma once
// The gauges' readings on the bus, for who asked for them.

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/frames.hpp"
#include "common/raw_share.hpp"
#include "firmware/core/condition.hpp"
#include "hal/can_port.hpp"
#include "hal/clock.hpp"

namespace strainfinger::firmware {

/// Sends sample sets as pages of RAW at a rate, and with them, a page a set, once a second the zeros: all at
/// once where sets are rare. All pages of a set are of one sample: a set that is due while the one before
/// waits for the port is left out.
class RawSender {
 public:
  /// From the next sample set on; 0: no more.
  void setRate(std::uint16_t rate_hz) {
    rate_hz_ = rate_hz;
    phase_us_ = 0;
    page_ = lastPage_;
    sayZeros();
  }

  /// The zeros are to be said anew.
  void sayZeros() {
    zeroPage_ = lastZeroPage_ = 0;
    sinceZeros_us_ = 0;
  }

  /// A sample set, and the number it has.
  void take(Codes codes, RawKind kind, std::uint32_t sample, std::uint32_t period_us) {
    if (rate_hz_ == 0) return;
    sinceZeros_us_ += period_us;
    if (sinceZeros_us_ >= hal::kSecond_us) sayZeros();
    phase_us_ += period_us * rate_hz_;
    if (phase_us_ < hal::kSecond_us) return;
    phase_us_ = std::min(phase_us_ - hal::kSecond_us, hal::kSecond_us);  // never faster than the sets are
    if (any()) return;
    std::copy(codes.begin(), codes.end(), codes_.begin());
    kind_ = kind;
    sample_ = static_cast<std::uint8_t>(sample);
    gauges_ = static_cast<std::uint8_t>(codes.size());
    page_ = 0;
    lastPage_ = static_cast<std::uint8_t>(rawPages(gauges_));
    const auto next = static_cast<std::uint8_t>(zeroPage_ + 1);
    lastZeroPage_ = rate_hz_ <= kSlow_hz ? lastPage_ : std::min(next, lastPage_);
  }

  bool any() const { return page_ < lastPage_ || zeroPage_ < lastZeroPage_; }

  /// Sends what the port takes.
  template <hal::CanPort Can>
  void send(Can& can, std::uint8_t node, const Calibration& calibration) {
    while (page_ < lastPage_) {
      const auto codeOf = [this](std::uint32_t gauge) { return codes_[gauge]; };
      if (!can.send(encode(pageOf(page_, kind_, codeOf), node))) return;
      ++page_;
    }
    while (zeroPage_ < lastZeroPage_) {
      const auto zeroOf = [&](std::uint32_t gauge) { return roundedZero(calibration.zero_q15[gauge]); };
      if (!can.send(encode(pageOf(zeroPage_, RawKind::kZeros, zeroOf), node))) return;
      ++zeroPage_;
    }
  }

 private:
  static constexpr std::uint16_t kSlow_hz = 100;  ///< a set has time for all zeros' pages

  static std::uint16_t roundedZero(std::int32_t zero_q15) {
    return saturate<std::uint16_t>((std::int64_t{zero_q15} + (1 << (kCodeBits - 1))) >> kCodeBits);
  }

  template <typename CodeOf>
  RawFrame pageOf(std::uint8_t page, RawKind kind, CodeOf codeOf) const {
    const std::uint32_t first = page * kCodesPerPage;
    const auto code = [&](std::uint32_t gauge) -> std::uint16_t {
      return gauge < gauges_ ? codeOf(gauge) : 0;
    };
    return {page, kind, sample_, code(first), code(first + 1), code(first + 2)};
  }

  std::array<std::uint16_t, kMaxGauges> codes_{};  ///< of the set that is being sent
  std::uint32_t phase_us_ = 0;                     ///< of the sets [us * rate_hz_]
  std::uint32_t sinceZeros_us_ = 0;
  std::uint16_t rate_hz_ = 0;
  RawKind kind_ = RawKind::kReadings;
  std::uint8_t sample_ = 0;
  std::uint8_t gauges_ = 0;
  std::uint8_t page_ = 0;          ///< the next of the set's
  std::uint8_t lastPage_ = 0;      ///< those before it are the set's
  std::uint8_t zeroPage_ = 0;      ///< the next of the zeros'
  std::uint8_t lastZeroPage_ = 0;  ///< those before it go with this set
};

}  // namespace strainfinger::firmware
