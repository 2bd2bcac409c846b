#include "host/can/decimal_text.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>

namespace strainfinger::can {
namespace {

constexpr int kMostPlaces = 9;
constexpr int kMostLeadingZeros = 4;  ///< "0.0001"; below that an exponent is shorter

constexpr auto kPowersOfTen = [] {
  std::array<std::uint64_t, kMostPlaces + 1> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = powers[i - 1] * 10;
  return powers;
}();

bool needsExponent(std::uint64_t digits, int places) {
  return places > kMostLeadingZeros &&
         digits < kPowersOfTen[static_cast<std::size_t>(places - kMostLeadingZeros)];
}

void appendScientific(std::string& out, std::uint64_t digits, int places) {
  const fmt::format_int text(digits);
  out.push_back(text.data()[0]);
  if (text.size() > 1) out.append(".").append(text.data() + 1, text.size() - 1);
  fmt::format_to(std::back_inserter(out), "e-{:02}", places + 1 - static_cast<int>(text.size()));
}

/// From the last digit to the first: that takes no counting of digits.
void appendFixed(std::string& out, std::uint64_t digits, int places) {
  std::array<char, 32> text;
  char* start = text.end();
  for (; places > 0; --places, digits /= 10) *--start = static_cast<char>('0' + digits % 10);
  *--start = '.';
  do {
    *--start = static_cast<char>('0' + digits % 10);
    digits /= 10;
  } while (digits > 0);
  out.append(start, text.end());
}

}  // namespace

std::optional<DecimalScale> decimalScale(std::int32_t denominator) {
  std::int64_t power = 1;
  for (int places = 0; places <= kMostPlaces; ++places, power *= 10)
    if (power % denominator == 0) return DecimalScale{static_cast<std::int32_t>(power / denominator), places};
  return std::nullopt;
}

void appendDecimal(std::string& out, std::int64_t number, const DecimalScale& scale, WholeNumber whole) {
  const std::int64_t value = number * scale.factor;
  auto digits = static_cast<std::uint64_t>(value < 0 ? -value : value);
  int places = digits == 0 ? 0 : scale.places;
  for (; places > 0 && digits % 10 == 0; --places) digits /= 10;
  if (value < 0) out.push_back('-');
  if (needsExponent(digits, places)) return appendScientific(out, digits, places);
  if (places > 0) return appendFixed(out, digits, places);
  const fmt::format_int text(digits);
  out.append(text.data(), text.size()).append(whole == WholeNumber::kWithPoint ? ".0" : "");
}

}  // namespace strainfinger::can
