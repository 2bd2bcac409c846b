#pragma once
// Sample sets of every kind, from integers only: the same ones on every machine and processor.

#include <algorithm>
#include <array>
#include <cstdint>

#include "hal/gauge_adc.hpp"
#include "impulse_table.hpp"

namespace strainfinger::emulated {

inline constexpr int kGauges = 16;  ///< of the default finger

/// Random numbers addressed by (sample, draw): lowbias32 (Chris Wellons, "Prospecting for hash functions",
/// 2018), twice.
class Draws {
 public:
  explicit constexpr Draws(std::uint32_t sample) : key_(mixed(sample + 0x5F3759DF)) {}

  constexpr std::uint32_t next() { return mixed(key_ ^ mixed(++count_)); }
  /// 0 .. below - 1
  constexpr std::uint32_t below(std::uint32_t limit) {
    return static_cast<std::uint32_t>((std::uint64_t{next()} * limit) >> 32);
  }

 private:
  static constexpr std::uint32_t mixed(std::uint32_t x) {
    x = (x ^ x >> 16) * 0x7FEB352D;
    x = (x ^ x >> 15) * 0x846CA68B;
    return x ^ x >> 16;
  }
  std::uint32_t key_;
  std::uint32_t count_ = 0;
};

/// How wide a contact is, as impulse_table.hpp has them.
enum Width : std::uint8_t { kLine, kTwoMillimetres };

/// A contact: where [turns * 2^32], how hard [codes at the response's peak] and how wide.
struct GeneratedContact {
  std::uint32_t angle;
  std::int32_t normal;
  std::int32_t tangential;
  Width width = kLine;
};

/// Any angle; loads up to twice `range`, over thirteen octaves, large ones more often, as the faintest cost
/// ten times as much; tangential load within 1.25 times the normal one either way; lines and wide ones.
constexpr GeneratedContact drawContact(Draws& draws, std::uint32_t range) {
  const std::uint32_t angle = draws.next();
  const auto normal =
      static_cast<std::int32_t>((range + draws.below(range)) >> draws.below(draws.below(13) + 1));
  const auto percent = static_cast<std::int32_t>(draws.below(251)) - 125;
  return {angle, normal, normal * percent / 100, draws.below(2) == 0 ? kLine : kTwoMillimetres};
}

constexpr std::int32_t interpolated(const std::int16_t* table, std::uint32_t turn) {
  constexpr int kBits = 20;  // of 4096 points
  const std::uint32_t point = turn >> kBits, next = (point + 1) % 4096;
  const auto part = static_cast<std::int32_t>(turn >> 6 & 0x3FFF);
  return table[point] + ((table[next] - table[point]) * part >> 14);
}

using Deflections = std::array<std::int32_t, kGauges>;  ///< codes from mid-scale

constexpr void press(Deflections& codes, const GeneratedContact& contact) {
  for (std::uint32_t gauge = 0; gauge < kGauges; ++gauge) {
    const std::uint32_t away = (gauge << 28) - contact.angle;
    const std::int64_t normal =
        std::int64_t{contact.normal} * interpolated(kNormalResponse[contact.width], away);
    const std::int64_t tangential =
        std::int64_t{contact.tangential} * interpolated(kTangentialResponse[contact.width], away);
    codes[gauge] += static_cast<std::int32_t>((normal + tangential) >> 14);
  }
}

/// Of about normal distribution, standard deviation 74 >> down codes.
constexpr void addNoise(Deflections& codes, Draws& draws, int down) {
  for (std::int32_t& code : codes) {
    const std::uint32_t bytes = draws.next();
    const auto sum =
        static_cast<std::int32_t>((bytes & 255) + (bytes >> 8 & 255) + (bytes >> 16 & 255) + (bytes >> 24));
    code += (sum - 510) / 2 >> down;
  }
}

/// As a converter of 12 bits gives them, or one of 16.
constexpr hal::SampleSet converted(const Deflections& codes, bool fine) {
  hal::SampleSet set{};
  for (std::size_t gauge = 0; gauge < kGauges; ++gauge) {
    const std::int32_t code = std::clamp<std::int32_t>(codes[gauge] + 0x8000, 0, 0xFFFF);
    set[gauge] = static_cast<std::uint16_t>(fine ? code : code & 0xFFF0);
  }
  return set;
}

/// Codes that no finger gives: anything, or nothing but ends of ranges.
constexpr hal::SampleSet strange(Draws& draws) {
  constexpr std::array<std::uint16_t, 8> kEnds{0, 1, 0x0010, 0x7FFF, 0x8000, 0x8001, 0xFFF0, 0xFFFF};
  const std::uint32_t kind = draws.below(4);
  hal::SampleSet set{};
  for (std::size_t gauge = 0; gauge < kGauges; ++gauge) {
    const auto any = static_cast<std::uint16_t>(draws.next());
    const std::uint16_t end = kEnds[draws.below(8)];
    set[gauge] = kind == 0 ? any : end;
    if (kind == 1) set[gauge] = gauge == 0 ? end : set[0];
    if (kind == 2 && gauge % 4 != 0) set[gauge] = 0x8000;
  }
  return set;
}

/// Sample sets that a generated touch lasts.
inline constexpr std::uint32_t kTouch = 64;

/// One contact, two or none, held or sliding by up to 16 um a sample set, with no more noise than the tables
/// expect: what a finger feels day in, day out. Loads to twice `range`.
constexpr hal::SampleSet ordinary(std::uint32_t sample, std::uint32_t range) {
  Draws touch(sample / kTouch), draws(sample);
  Deflections codes{};
  const std::uint32_t kind = touch.below(16);
  const std::uint32_t moved = sample % kTouch * touch.below(kTurn_q32Of50_um / 3);
  for (std::uint32_t i = 0; i < (kind == 0 ? 2u : kind < 12 ? 1u : 0u); ++i) {
    GeneratedContact contact = drawContact(touch, range);
    contact.angle += moved;
    press(codes, contact);
  }
  const int down = 4 + static_cast<int>(touch.below(4));
  const bool fine = touch.below(2) == 0;
  addNoise(codes, draws, down);
  return converted(codes, fine);
}

/// Of 32, 24 show one contact, 3 two, 3 none but noise, 2 are strange; loads to beyond the converter's range.
/// Few gauges are long in use with that.
constexpr hal::SampleSet wild(Draws& draws) {
  const std::uint32_t kind = draws.below(32);
  if (kind >= 30) return strange(draws);
  Deflections codes{};
  if (kind < 27) press(codes, drawContact(draws, 1u << 16));
  if (kind >= 24 && kind < 27) press(codes, drawContact(draws, 1u << 16));
  addNoise(codes, draws, static_cast<int>(draws.below(8)));
  return converted(codes, draws.below(2) == 0);
}

/// Sample sets after which a replay starts afresh.
inline constexpr std::uint32_t kBlock = 1024;

/// Sample set number `sample`. What takes many times the time is rarer than the rest: every sixteenth block
/// presses gauges to the ends of the converter's range, and the last 96 of every sixteenth are wild ones,
/// each of them another touch.
constexpr hal::SampleSet generatedSamples(std::uint32_t sample) {
  constexpr std::uint32_t kCycle = 16 * kBlock, kWild = 96;
  Draws draws(sample);
  if (sample % kCycle >= kCycle - kWild) return wild(draws);
  return ordinary(sample, sample / kBlock % 16 == 5 ? 1u << 14 : 1u << 13);
}

}  // namespace strainfinger::emulated
