#include "host/contact/decompositions.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::contact;

TEST_GROUP(Decompositions) {};

// The line through (0, 1), (1, 3), (2, 4), (3, 4) by hand: 1.5 + x.
TEST(Decompositions, LeastSquaresIsTheLineWorkedOutByHand) {
  Eigen::MatrixXd matrix(4, 2);
  matrix << 1, 0, 1, 1, 1, 2, 1, 3;
  const Eigen::VectorXd line = leastSquares(matrix, Eigen::Vector4d(1, 3, 4, 4));
  LONGS_EQUAL(2, line.size());
  DOUBLES_EQUAL(1.5, line[0], 1e-14);
  DOUBLES_EQUAL(1, line[1], 1e-14);
}
