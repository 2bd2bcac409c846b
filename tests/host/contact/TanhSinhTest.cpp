#include "host/contact/tanh_sinh.hpp"

#include <numbers>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using strainfinger::contact::TanhSinhRule;

TEST_GROUP(TanhSinh) {};

TEST(TanhSinh, IntegratesALogarithm) {
  const TanhSinhRule rule(12);
  DOUBLES_EQUAL(-1, (rule.weights * rule.fromStart.log()).sum(), 1e-14);
}

// B(1/2, 1/2) = pi: both ends need their own distances.
TEST(TanhSinh, IntegratesInverseRootsAtBothEnds) {
  const TanhSinhRule rule(12);
  DOUBLES_EQUAL(std::numbers::pi, (rule.weights / (rule.fromStart * rule.fromEnd).sqrt()).sum(), 1e-13);
}

TEST(TanhSinh, IntegratesPolynomials) {
  const TanhSinhRule rule(16);
  DOUBLES_EQUAL(1.0 / 31, (rule.weights * rule.fromStart.pow(30)).sum(), 1e-15);
}
