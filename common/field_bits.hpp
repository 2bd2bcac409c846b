#pragma once
// A field of a frame as bits: where it lies, which raw values it takes, and how these get in and out.

#include <cstdint>

namespace strainfinger {

/// Where a field lies in its frame and which raw values it takes: all that encoding and decoding need.
struct FieldBits {
  std::uint8_t lsb;         ///< number of its lowest bit in the frame
  std::uint8_t width;       ///< bits
  std::int32_t limit = 0;   ///< largest valid raw value; 0: the largest the width holds
  bool unknowable = false;  ///< has a reserved value for "not known": see invalidRaw()
  bool isSigned = false;    ///< filled in from the type of the struct's member
};

/// All that a field's width can hold.
constexpr std::int64_t widestRaw(const FieldBits& field) {
  return (std::int64_t{1} << (field.width - (field.isSigned ? 1 : 0))) - 1;
}

/// The reserved value "not known": all ones if unsigned, the lowest number if signed.
constexpr std::int64_t invalidRaw(const FieldBits& field) {
  return field.isSigned ? -widestRaw(field) - 1 : widestRaw(field);
}

/// Largest valid raw value; the reserved one is not valid.
constexpr std::int64_t maxRaw(const FieldBits& field) {
  if (field.limit != 0) return field.limit;
  return widestRaw(field) - (field.unknowable && !field.isSigned ? 1 : 0);
}

/// Smallest valid raw value.
constexpr std::int64_t minRaw(const FieldBits& field) {
  if (!field.isSigned) return 0;
  return -widestRaw(field) - (field.unknowable ? 0 : 1);
}

constexpr bool isValidRaw(const FieldBits& field, std::int64_t raw) {
  return raw >= minRaw(field) && raw <= maxRaw(field);
}

/// What is sent for `raw`: itself if valid or the reserved value, else the nearest valid value. So a value
/// too large never turns into "not known", nor spills into its neighbours.
constexpr std::int64_t sendableRaw(const FieldBits& field, std::int64_t raw) {
  if (field.unknowable && raw == invalidRaw(field)) return raw;
  if (raw > maxRaw(field)) return maxRaw(field);
  return raw < minRaw(field) ? minRaw(field) : raw;
}

/// The bits a field covers in the frame, as a 64-bit little-endian word.
constexpr std::uint64_t fieldMask(const FieldBits& field) {
  return (~std::uint64_t{0} >> (64 - field.width)) << field.lsb;
}

constexpr std::uint64_t insertRaw(const FieldBits& field, std::int64_t raw) {
  return (static_cast<std::uint64_t>(sendableRaw(field, raw)) << field.lsb) & fieldMask(field);
}

constexpr std::int64_t extractRaw(const FieldBits& field, std::uint64_t word) {
  const auto bits = static_cast<std::int64_t>((word & fieldMask(field)) >> field.lsb);
  return field.isSigned && bits > widestRaw(field) ? bits - 2 * (widestRaw(field) + 1) : bits;
}

}  // namespace strainfinger
