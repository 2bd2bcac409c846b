#include "host/base/text_parts.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(TextParts) {};

TEST(TextParts, BlanksAroundAreTrimmed) {
  for (const char* text : {"a b", " a b", "\ta b\r\n"})
    STRCMP_EQUAL("a b", std::string(trimmed(text)).c_str());
  CHECK_TRUE(trimmed("").empty());
  CHECK_TRUE(trimmed(" \t\r\n").empty());
}

TEST(TextParts, WhatTakesAPlaceIsNotLookedAtAgain) {
  STRCMP_EQUAL("--can can0, --can can0", replacedAll("--can BUS, --can BUS", "BUS", "can0").c_str());
  STRCMP_EQUAL("''a''", replacedAll("'a'", "'", "''").c_str());
  STRCMP_EQUAL("", replacedAll("", "a", "b").c_str());
}
