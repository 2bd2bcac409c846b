#include "host/base/parse_number.hpp"

#include <cmath>
#include <cstdint>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(ParseNumber) {};

TEST(ParseNumber, AllOfATextIsOne) {
  CHECK_TRUE(parseNumber<int>("-40") == -40);
  CHECK_TRUE(parseNumber<double>("2.5e-3") == 2.5e-3);
  CHECK_TRUE(std::isnan(*parseNumber<double>("nan")));
}

TEST(ParseNumber, NothingElseIsOne) {
  for (const char* text : {"", " 1", "1 ", "+1", "1x", "x"}) {
    CHECK_FALSE_TEXT(parseNumber<int>(text).has_value(), text);
    CHECK_FALSE_TEXT(parseNumber<double>(text).has_value(), text);
  }
  CHECK_FALSE(parseNumber<int>("1.5").has_value());
}

TEST(ParseNumber, WhatTheTypeDoesNotHoldIsNone) {
  CHECK_FALSE(parseNumber<std::uint8_t>("256").has_value());
  CHECK_FALSE(parseNumber<std::uint32_t>("-1").has_value());
  CHECK_FALSE(parseNumber<double>("1e999").has_value());
}

TEST(ParseNumber, ADecimalCommaIsTold) {
  CHECK_TRUE(withPoint("0,5") == "0.5");
  CHECK_TRUE(withPoint("-1,14e-06") == "-1.14e-06");
  for (const char* text : {"", "0.5", "5", ",5", "5,", "1.000,5", "1,2,3", "1e5,2", "-,5", "1,5 N", "a,5"})
    CHECK_FALSE_TEXT(withPoint(text).has_value(), text);
}

TEST(ParseNumber, OneIsTakenOffTheTextThatBeginsWithIt) {
  std::string_view text = "24.5 N/m";
  CHECK_TRUE(takeNumber<double>(text) == 24.5);
  CHECK_TRUE(text == " N/m");
  CHECK_FALSE(takeNumber<double>(text).has_value());
  CHECK_TRUE(text == " N/m");
}
