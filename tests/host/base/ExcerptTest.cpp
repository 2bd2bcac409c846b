#include "host/base/excerpt.hpp"

#include <string>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Excerpt) {};

TEST(Excerpt, WhatIsShortStays) {
  STRCMP_EQUAL("", excerpt("").c_str());
  STRCMP_EQUAL(std::string(60, 'a').c_str(), excerpt(std::string(60, 'a')).c_str());
}

TEST(Excerpt, WhatIsLongIsItsBeginning) {
  STRCMP_EQUAL((std::string(60, 'a') + "..").c_str(), excerpt(std::string(61, 'a')).c_str());
}

TEST(Excerpt, NoCharacterIsCut) {
  STRCMP_EQUAL((std::string(59, 'a') + "..").c_str(), excerpt(std::string(59, 'a') + "\u00e4").c_str());
  STRCMP_EQUAL((std::string(58, 'a') + "\u00e4..").c_str(),
               excerpt(std::string(58, 'a') + "\u00e4\u00e4").c_str());
}

TEST(Excerpt, OfNamesTheFirstAreSaid) {
  STRCMP_EQUAL("a, b", excerptNames({"a", "b"}).c_str());
  STRCMP_EQUAL(("a, " + std::string(60, 'b') + ".., c, d, e and 2 more").c_str(),
               excerptNames({"a", std::string(5000, 'b'), "c", "d", "e", "f", "g"}).c_str());
}

TEST(Excerpt, OfAMessageEachWordIsCut) {
  STRCMP_EQUAL("", excerptWords("").c_str());
  STRCMP_EQUAL(("--node: " + std::string(60, 'a') + ".. is\nno number\n").c_str(),
               excerptWords("--node: " + std::string(5000, 'a') + " is\nno number\n").c_str());
}
