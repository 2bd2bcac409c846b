#pragma once
// Which gauges are not to be trusted.

#include <array>
#include <cstdint>
#include <span>

#include "firmware/core/detect.hpp"
#include "firmware/core/gauge_watch_products.hpp"
#include "firmware/core/left_out.hpp"

namespace strainfinger::firmware {

/// A sample set that one contact does not explain.
struct Misfit {
  GaugeSet culprit = 0;  ///< the one gauge without which one contact explains the others
  bool several = false;  ///< there is none: more than one contact, or more than one gauge
};

/// One contact leaves more unexplained than noise, rounding and gains that are a few percent off do.
/// `energy`: gateEnergy() of the strains that were fitted. Cost: three products.
bool isMisfit(const TableImage& tables, std::span<const std::int32_t> strains_q32, std::uint32_t energy,
              const Fit& fit);

/// Leave-one-out prediction, gauge by gauge: with leverage h and residual r of a reading, leaving it out
/// takes r^2 / (1 - h) off what is unexplained. Tried at sixteen places a pitch of the windows that may hold
/// the contact, then exactly for the four gauges that do best. A culprit must explain all but what noise and
/// gains may leave, and by more than 12 variances better than any other.
/// Cost: some thirty located contacts.
Misfit examine(const TableImage& tables, GaugeSet leftOut, std::span<const std::int32_t> strains_q32,
               std::uint32_t energy);

/// Looks for noisy gauges, one gauge after another: two readings in eight that jump by more than nine
/// standard deviations, while the rest of the ring is as quiet as untouched, are no noise that was planned
/// for. Cost: some thirty instructions.
class JumpWatch {
 public:
  explicit JumpWatch(const TableConstants& constants)
      : jump_q32_(saturate<std::int32_t>(std::int64_t{9} * readingNoise_q32(constants))) {}

  /// One sample set; `energy`: gateEnergy() of the strains. The gauge that is noisy, if one is.
  GaugeSet take(const TableConstants& constants, std::span<const std::int32_t> strains_q32,
                std::uint32_t energy) {
    const std::int32_t reading = strains_q32[gauge_];
    GaugeSet noisy = 0;
    if (looks_ != 0 && jumpOf(reading, before_q32_) > jump_q32_ &&
        isOthersNoise(constants, reading, energy) && ++jumps_ == kJumps) {
      noisy = 1u << gauge_;
      looks_ = kLooks;
    }
    before_q32_ = reading;
    energyBefore_ = energy;
    if (++looks_ > kLooks) {
      looks_ = jumps_ = 0;
      gauge_ = gauge_ + 1u < strains_q32.size() ? static_cast<std::uint8_t>(gauge_ + 1) : std::uint8_t{0};
    }
    return noisy;
  }

 private:
  /// The rest of the ring is as quiet as untouched, before and after.
  bool isOthersNoise(const TableConstants& constants, std::int32_t reading, std::uint32_t energy) const;

  static constexpr std::uint8_t kLooks = 8;
  static constexpr std::uint8_t kJumps = 2;

  std::int32_t jump_q32_;
  std::int32_t before_q32_ = 0;
  std::uint32_t energyBefore_ = 0;
  std::uint8_t gauge_ = 0;
  std::uint8_t looks_ = 0;
  std::uint8_t jumps_ = 0;
};

/// Gauges that were culprits in two of six sample sets, or in more than one of seventeen for longer, are out
/// of use until they read for a while what the others predict, or there is a new zero.
class GaugeWatch {
 public:
  GaugeSet outOfUse() const { return outOfUse_; }
  bool several() const { return several_; }

  /// Once a sample set: whom it speaks against.
  void accuse(GaugeSet culprits) {
    if (culprits != 0 || anyScore_) count(culprits);
  }
  /// Beyond doubt, and without another try.
  void convict(GaugeSet culprits) {
    outOfUse_ |= culprits;
    beyondDoubt_ |= culprits;
  }
  /// What a sample set says of gauges out of use: those that read what the others predict of them, and those
  /// that don't. The first come back after kConvincing sets without one of the second kind: two contacts, or
  /// a very wide one, may have looked like a gauge that fails.
  void reconsider(GaugeSet right, GaugeSet wrong);

  /// Misfits that last are looked into at once and then now and again.
  bool wantsToExamine();
  void found(const Misfit& misfit) { several_ = misfit.several; }
  void allIsWell() {
    several_ = false;
    misfits_ = 0;
  }

  static constexpr std::uint8_t kConvincing = 64;

 private:
  void count(GaugeSet culprits);

  std::array<std::uint8_t, kMaxGauges> score_{};
  GaugeSet outOfUse_ = 0;
  GaugeSet beyondDoubt_ = 0;
  std::uint8_t misfits_ = 0;
  bool several_ = false;
  bool anyScore_ = false;
};

}  // namespace strainfinger::firmware
