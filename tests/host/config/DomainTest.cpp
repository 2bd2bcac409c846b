#include "host/config/domain.hpp"

#include <cmath>
#include <string>

#include <CppUTest/TestHarness.h>

using strainfinger::config::Domain;

TEST_GROUP(Domain) {
  void checkEnds(const Domain& domain, bool low, bool high) {
    CHECK_EQUAL(low, domain.contains(2));
    CHECK_EQUAL(high, domain.contains(4));
    CHECK_TRUE(domain.contains(3));
    CHECK_FALSE(domain.contains(std::nextafter(2.0, 0.0)));
    CHECK_FALSE(domain.contains(std::nextafter(4.0, 5.0)));
  }
  void checkText(const char* expected, const Domain& domain) {
    STRCMP_EQUAL(expected, domain.text().c_str());
  }
};

TEST(Domain, EndsAreInOrOutAsSaid) {
  checkEnds(Domain::between(2, 4), true, true);
  checkEnds(Domain::above(2, 4), false, true);
  checkEnds(Domain::below(2, 4), true, false);
}

TEST(Domain, NothingButFiniteNumbersIsEverInside) {
  for (const auto& domain : {Domain::between(-1, 1), Domain::oneOf({1, 2})})
    for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) CHECK_FALSE(domain.contains(value));
}

TEST(Domain, EvenAndListedNumbersOnly) {
  CHECK_TRUE(Domain::evenBetween(12, 32).contains(12));
  CHECK_FALSE(Domain::evenBetween(12, 32).contains(13));
  CHECK_FALSE(Domain::evenBetween(12, 32).contains(34));
  CHECK_TRUE(Domain::oneOf({1, 5}).contains(5));
  CHECK_FALSE(Domain::oneOf({1, 5}).contains(3));
}

TEST(Domain, WordsSayWhatIsInside) {
  checkText("2 to 4", Domain::between(2, 4));
  checkText("greater than 2, at most 4", Domain::above(2, 4));
  checkText("at least 2, less than 4", Domain::below(2, 4));
  checkText("even, 12 to 32", Domain::evenBetween(12, 32));
  checkText("one of 1, 5", Domain::oneOf({1, 5}));
}
