#pragma once
// Fractions with a denominator like 100 or 2000, written exactly.

#include <cstdint>
#include <optional>
#include <string>

namespace strainfinger::can {

/// value = number * factor / 10^places.
struct DecimalScale {
  std::int32_t factor = 1;
  int places = 0;
};

/// How numbers / `denominator` are written; nothing if they have no end (1/3) or more than nine places.
std::optional<DecimalScale> decimalScale(std::int32_t denominator);

/// How a whole number is written: as 10, or as 10.0 where a reader is to see that it could have a fraction.
enum class WholeNumber { kPlain, kWithPoint };

/// Appends number * factor / 10^places in the fewest digits, with an exponent below 1e-4: "0.29", "5e-05".
/// That is what other programs call the shortest text that reads back as the value.
void appendDecimal(std::string& out, std::int64_t number, const DecimalScale& scale,
                   WholeNumber whole = WholeNumber::kPlain);

}  // namespace strainfinger::can
