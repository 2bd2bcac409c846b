#pragma once
// A finger under one disturbance, switched on and touched several times.

#include <cstdint>
#include <span>
#include <vector>

#include "common/contact.hpp"
#include "firmware/core/pipeline.hpp"
#include "host/bench/matrix/disturbance.hpp"
#include "host/bench/matrix/tally.hpp"
#include "host/evidence/touched_ring.hpp"

namespace strainfinger::bench {

/// The firmware's pipeline at one sample set a millisecond, fed with codes. Everything is drawn by seed and
/// number.
class Session {
 public:
  static constexpr int kTouches = 6;  ///< of one session: what is wrong with a gauge shows at several places
  static constexpr int kFirstRest_sets = 300;  ///< before the first touch
  static constexpr int kSettled_sets = 10;     ///< of a rest: what is told then is a ghost

  /// `tables` outlives it.
  Session(const Disturbance& disturbance, const TableImage& tables, std::uint64_t seed, std::uint64_t number);

  void rest(int sets);
  /// Touches, and judges the last sample set.
  void touch(Tally& tally);
  /// A row without touches: the rest before is judged.
  void leaveUntouched(Tally& tally);

 private:
  struct Pressing {
    simulation::Touch touch;
    Eigen::VectorXd exact;  ///< at its place and loads when nothing moves
    int start_set;
  };
  using Pressings = std::span<const Pressing>;

  std::vector<Pressing> drawTouch();
  Pressing pressing(const simulation::Touch& touch, int start_set) const;
  void sample(Pressings pressings, int set);
  Eigen::VectorXd pressed(Pressings pressings, int set) const;
  double loadShare(const Pressing& pressing, int set) const;
  simulation::Touch movedTouch(const Pressing& pressing, int set) const;
  void disturb(Eigen::VectorXd& readings) const;
  void fail(Eigen::VectorXd& readings) const;
  void judge(std::span<const simulation::Touch> truths, Tally& tally) const;
  bool isHealthy(int gauge) const;
  double draw(std::uint32_t what, int gauge = 0) const;

  const Disturbance& disturbance_;
  config::FingerConfig finger_;
  evidence::TouchedRing ring_;
  evidence::TouchDraws touches_;
  simulation::Noise draws_;
  std::uint64_t number_;
  firmware::Pipeline pipeline_;
  int failed_;             ///< gauge
  int touched_ = 0;        ///< touches so far
  std::uint64_t set_ = 0;  ///< since the finger was switched on
  bool ghost_ = false;     ///< since the last touch
  std::vector<std::uint16_t> firstCodes_;
};

/// Runs sessions until a disturbance was met by so many touches. Throws Failure(kUsage) where tables cannot
/// be built.
Tally tallyOf(const Disturbance& disturbance, int touches, std::uint64_t seed);

}  // namespace strainfinger::bench
