#include "host/can/decimal_text.hpp"

#include <CppUTest/TestHarness.h>
#include <fmt/format.h>

#include <string>

#include "host/can/frame_catalogue.hpp"

using namespace strainfinger;
using namespace strainfinger::can;

TEST_GROUP(DecimalText) {
  static std::string text(std::int64_t number, std::int32_t denominator,
                          WholeNumber whole = WholeNumber::kPlain) {
    std::string out;
    appendDecimal(out, number, decimalScale(denominator).value(), whole);
    return out;
  }

  /// Against fmt's shortest text of the nearest double, which is a library's.
  static void checkShortest(std::int64_t number, std::int32_t denominator) {
    const double value = static_cast<double>(number) / denominator;
    STRCMP_EQUAL(fmt::format("{}", value).c_str(), text(number, denominator).c_str());
  }
};

TEST(DecimalText, HasNoDigitTooMany) {
  STRCMP_EQUAL("0", text(0, 100).c_str());
  STRCMP_EQUAL("10", text(1000, 100).c_str());
  STRCMP_EQUAL("35.73", text(3573, 100).c_str());
  STRCMP_EQUAL("-0.226", text(-226, 1000).c_str());
  STRCMP_EQUAL("1.0625", text(17, 16).c_str());
  STRCMP_EQUAL("0.0045", text(9, 2000).c_str());
}

TEST(DecimalText, SmallNumbersHaveAnExponent) {
  STRCMP_EQUAL("0.0001", text(100, 1'000'000).c_str());
  STRCMP_EQUAL("9.9e-05", text(99, 1'000'000).c_str());
  STRCMP_EQUAL("1e-09", text(1, 1'000'000'000).c_str());
}

TEST(DecimalText, APointSaysThatThereCouldBeAFraction) {
  STRCMP_EQUAL("10.0", text(1000, 100, WholeNumber::kWithPoint).c_str());
  STRCMP_EQUAL("0.0", text(0, 100, WholeNumber::kWithPoint).c_str());
  STRCMP_EQUAL("0.5", text(50, 100, WholeNumber::kWithPoint).c_str());
}

TEST(DecimalText, FractionsWithoutAnEndHaveNoScale) {
  CHECK_FALSE(decimalScale(3).has_value());
  CHECK_FALSE(decimalScale(1'000'000'007).has_value());
}

TEST(DecimalText, IsTheShortestTextOfEveryValueOnTheBus) {
  for (const FrameEntry& entry : frameCatalogue())
    for (const auto& [bits, meaning] : entry.fields) {
      if (meaning.kind != FieldKind::kNumber || bits.width > 16) continue;
      for (std::int64_t raw = minRaw(bits); raw <= maxRaw(bits); ++raw)
        checkShortest(raw, meaning.stepsPerUnit);
    }
}
