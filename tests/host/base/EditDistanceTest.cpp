#include "host/base/edit_distance.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(EditDistance) {};

// The textbook's examples.
TEST(EditDistance, CountsInsertionsDeletionsAndReplacements) {
  LONGS_EQUAL(3, editDistance("kitten", "sitting"));
  LONGS_EQUAL(3, editDistance("saturday", "sunday"));
  LONGS_EQUAL(2, editDistance("uncertian", "uncertain"));
  LONGS_EQUAL(0, editDistance("noisy", "noisy"));
}

TEST(EditDistance, OfNothingIsTheOthersLength) {
  LONGS_EQUAL(5, editDistance("", "noisy"));
  LONGS_EQUAL(5, editDistance("noisy", ""));
  LONGS_EQUAL(0, editDistance("", ""));
}
