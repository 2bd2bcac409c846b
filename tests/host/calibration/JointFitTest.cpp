#include "host/calibration/joint_fit.hpp"

#include <limits>
#include <vector>

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

TEST_GROUP(JointFit) {
  const config::FingerConfig config;
  const Drawing drawing{config};
  const int last = RingResponse::lastHarmonic(drawing);
  const RingResponse ring{drawing, Eigen::VectorXd::Zero(drawing.unknowns()), last};
  JointFit fit{Eigen::VectorXd::Zero(drawing.unknowns()), {}};
  std::vector<TouchData> data;

  void setup() override {
    for (int i = 0; i < 64; ++i) {
      const TouchState touch{0.1 * i, 20, 2, 2e-2};
      Eigen::VectorXd readings = ring.readings(touch);
      for (Eigen::Index gauge = 0; gauge < readings.size(); ++gauge)  // a fit to nothing but 0 never settles
        readings[gauge] += 6e-6 * static_cast<double>((7 * gauge + 5 * i) % 3 - 1);
      data.push_back({readings, 6e-6, {}});
      fit.touches.push_back({0.1 * i + 0.01, 18, 1, 1e-2});
    }
  }
};

TEST(JointFit, SettlesWhereTheReadingsAreFrom) {
  CHECK_TRUE(fitTogether(drawing, last, data, 0, fit) == FitEnd::kSettled);
  DOUBLES_EQUAL(20, fit.touches[3][kNormalLoad], 2);
}

TEST(JointFit, WhatHasNoAnswerFailsAndMovesNothing) {
  data[3].readings[5] = std::numeric_limits<double>::quiet_NaN();
  CHECK_TRUE(fitTogether(drawing, last, data, 0, fit) == FitEnd::kFailed);
  DOUBLES_EQUAL(18, fit.touches[3][kNormalLoad], 0);
}

TEST(JointFit, WhatIsNoInformationHasNoInverse) {
  Eigen::Matrix2d information{{2, 1}, {1, 2}};
  DOUBLES_EQUAL(2.0 / 3, inverseOf(information)(0, 0), 1e-15);
  information(1, 1) = 0.4;
  CHECK_THROWS(Failure, inverseOf(information));
  information(1, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS(Failure, inverseOf(information));
}
