#include "host/session/session.hpp"

#include <algorithm>

#include "tests/host/session/hands.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::session;

TEST_GROUP(GuidedSession) {
  using Kind = session::Advice::Kind;
  config::FingerConfig config;
  Hand hand{config};
  Session session{config, {}};
  double time_s = 0;

  std::vector<NewRow> take(const Eigen::VectorXd& strains) {
    time_s += 0.01;
    return session.take({time_s, strains});
  }
  std::vector<NewRow> leaveAlone(double duration_s) {
    std::vector<NewRow> rows;
    for (const double end_s = time_s + duration_s; time_s < end_s;)
      for (const NewRow& row : take(hand.nothing())) rows.push_back(row);
    return rows;
  }
  void hold(double angle_deg, double normal_n_per_m, int sets = 40) {
    for (int i = 0; i < sets; ++i) take(hand.touch(angle_deg, normal_n_per_m));
  }
  void holdStill(double angle_deg, double normal_n_per_m, double duration_s) {
    hold(angle_deg, normal_n_per_m, static_cast<int>(100 * duration_s));
  }
  void rollAround(double load_n_per_m = 20) {
    for (int i = 0; i < 1000; ++i) take(hand.touch(0.72 * i, load_n_per_m + 0.01 * i));
  }
  calibration::CalibrationResult poorlyTold() const {
    const calibration::Drawing drawing(config);
    return {drawing,
            Eigen::VectorXd::Zero(drawing.unknowns()),
            Eigen::MatrixXd::Identity(drawing.unknowns(), drawing.unknowns()),
            {},
            {0, 0},
            true};
  }
  std::string say(const char* text) {
    return session.obey(parseCommand(text, config.finger.length_m)).message;
  }
};

TEST(GuidedSession, FiveSecondsUntouchedAreTenRowsOfTheZero) {
  const auto rows = leaveAlone(5.1);
  LONGS_EQUAL(10, rows.size());
  for (const NewRow& row : rows) {
    CHECK(row.known.isUntouched());
    CHECK_COMPARE(row.strains.cwiseAbs().maxCoeff(), <, 5e-6);  // the mean of fifty with a noise of 6e-6
  }
  CHECK(session.advice().kind == Kind::kRoll);
  LONGS_EQUAL(0, leaveAlone(10).size());  // not asked for again
}

TEST(GuidedSession, ATouchBreaksTheTimeUntouched) {
  LONGS_EQUAL(0, leaveAlone(4).size());
  hold(40, 20);
  LONGS_EQUAL(0, leaveAlone(4).size());
  LONGS_EQUAL(10, leaveAlone(1.2).size());
}

TEST(GuidedSession, AFingerThatRestsFarFromItsZeroIsTold) {
  Eigen::VectorXd off = Eigen::VectorXd::Zero(16);
  off[5] = 2e-3;
  for (int i = 0; i < 520; ++i) LONGS_EQUAL(0, take(hand.nothing() + off).size());
  LONGS_EQUAL(5, session.farGauge().value_or(-1));
  take(hand.nothing() + off);
  LONGS_EQUAL(5, session.farGauge().value_or(-1));
  take(hand.nothing());
  CHECK_FALSE(session.farGauge().has_value());
}

TEST(GuidedSession, APressThatIsAskedForIsNoZeroThatIsOff) {
  leaveAlone(5.1);
  rollAround(10);
  rollAround(18);
  CHECK(session.advice().kind == Kind::kPress);
  holdStill(45, 24, 6);
  CHECK_FALSE(session.farGauge().has_value());
}

TEST(GuidedSession, APressThatWasEnteredIsNoZeroThatIsOffUntilItIsLetGo) {
  leaveAlone(5.1);
  CHECK(session.advice().kind == Kind::kRoll);
  holdStill(45, 24, 6);
  LONGS_EQUAL(2, session.farGauge().value_or(-1));
  say("load 24 N/m");
  CHECK_FALSE(session.farGauge().has_value());
  holdStill(45, 23, 6);  // a hand that tires
  CHECK_FALSE(session.farGauge().has_value());
  holdStill(200, 24, 6);
  CHECK_TRUE(session.farGauge().has_value());
  say("hold");
  CHECK_FALSE(session.farGauge().has_value());
}

TEST(GuidedSession, RollingCoversTheRingAndThenALoadIsAskedFor) {
  leaveAlone(5.1);
  rollAround(10);
  rollAround(18);
  for (const int touches : session.coverage().touches) CHECK_COMPARE(touches, >=, 4);
  CHECK(session.advice().kind == Kind::kPress);
}

TEST(GuidedSession, ALoadIsThatOfTheTouchThatIsHeld) {
  hold(45, 24);
  const Obeyed obeyed = session.obey(LoadIs{24});
  CHECK(obeyed.row.has_value());
  DOUBLES_EQUAL(24, *obeyed.row->known.normal_n_per_m, 0);
  CHECK_FALSE(obeyed.row->known.angle_deg.has_value());
  LONGS_EQUAL(1, session.coverage().loads);
  STRCMP_CONTAINS("24 N/m is taken", obeyed.message.c_str());
}

TEST(GuidedSession, ALoadIsOfWhatWasHeldWhenItsEntryBegan) {
  hold(45, 24);
  STRCMP_EQUAL("held", say("hold").c_str());
  for (int i = 0; i < 100; ++i) take(hand.nothing());  // let go to type
  const Obeyed obeyed = session.obey(LoadIs{24});
  CHECK(obeyed.row.has_value());
  CHECK_COMPARE(obeyed.row->strains.cwiseAbs().maxCoeff(), >, 1e-3);
  STRCMP_CONTAINS("was not taken", say("load 24 N/m").c_str());  // once
}

TEST(GuidedSession, NoLoadIsTakenOfWhatIsNotHeld) {
  STRCMP_CONTAINS("no readings come", say("load 20 N/m").c_str());
  leaveAlone(0.4);
  STRCMP_CONTAINS("nothing presses the finger", say("load 20 N/m").c_str());
  for (int i = 0; i < 60; ++i) take(hand.touch(45 + 0.2 * i, 24));
  STRCMP_CONTAINS("it is not held still", say("load 20 N/m").c_str());
  hold(0, 100);
  STRCMP_CONTAINS("beyond its range", say("load 20 N/m").c_str());
  LONGS_EQUAL(0, session.peakGauge());
  hold(90, 100);
  LONGS_EQUAL(4, session.peakGauge());
  LONGS_EQUAL(0, session.coverage().loads);
}

// 24 N/m on a finger of 20 mm are 0.48 N.
TEST(GuidedSession, ALoadOfAnotherUnitIsAskedForAgain) {
  hold(45, 24);
  STRCMP_CONTAINS("reads so under about 24", say("load 0.48 N/m").c_str());
  STRCMP_CONTAINS("was not taken", say("load 24 kg").c_str());
  LONGS_EQUAL(0, session.coverage().loads);
  say("load 0.48 N");
  LONGS_EQUAL(1, session.coverage().loads);
}

TEST(GuidedSession, ALoadOfAnotherUnitIsStillThatOfTheTouchThatWasHeld) {
  hold(45, 24);
  say("hold");
  for (int i = 0; i < 100; ++i) take(hand.nothing());
  STRCMP_CONTAINS("was not taken", say("load 0.48 N/m").c_str());
  STRCMP_CONTAINS("is taken", say("load 0.48 N").c_str());
}

TEST(GuidedSession, ATypingErrorLeavesTheTouchThatWasHeld) {
  hold(45, 24);
  say("hold");
  for (int i = 0; i < 100; ++i) take(hand.nothing());
  CHECK_TRUE(session.obey(parseCommand("load 24", config.finger.length_m)).isRefused);
  CHECK_FALSE(session.obey(parseCommand("load 24 N/m", config.finger.length_m)).isRefused);
  CHECK_TRUE(session.obey(Hold{}).isRefused);
}

TEST(GuidedSession, ADoubtfulLoadThatIsEnteredTwiceIsTaken) {
  hold(45, 24);
  say("load 2 N/m");
  LONGS_EQUAL(0, session.coverage().loads);
  say("load 2 N/m");
  LONGS_EQUAL(1, session.coverage().loads);
}

TEST(GuidedSession, ADoubtfulLoadOfAnotherTouchIsDoubtedAnew) {
  hold(45, 24);
  STRCMP_CONTAINS("was not taken", say("load 2 N/m").c_str());
  hold(200, 24);
  STRCMP_CONTAINS("was not taken", say("load 2 N/m").c_str());
  LONGS_EQUAL(0, session.coverage().loads);
}

TEST(GuidedSession, ADoubtfulLoadIsDoubtedAnewOfWhatIsHeldAnewAndAfterARow) {
  hold(45, 24);
  say("hold");
  STRCMP_CONTAINS("was not taken", say("load 2 N/m").c_str());
  say("hold");
  STRCMP_CONTAINS("was not taken", say("load 2 N/m").c_str());
  STRCMP_CONTAINS("is taken", say("load 2 N/m").c_str());
  STRCMP_CONTAINS("was not taken", say("load 2 N/m").c_str());
  say("angle 218");
  STRCMP_CONTAINS("is taken", say("angle 45").c_str());
  STRCMP_CONTAINS("was not taken", say("angle 218").c_str());
}

TEST(GuidedSession, AnAngleOfAnotherPlaceIsAskedForAgainAndTakenIfItIsMeant) {
  hold(128, 24);
  say("hold");
  for (int i = 0; i < 100; ++i) take(hand.nothing());
  STRCMP_CONTAINS("was not taken: the readings say about 128 deg", say("angle 218").c_str());
  STRCMP_CONTAINS("was not taken", say("angle 37.5").c_str());
  LONGS_EQUAL(0, session.coverage().directions_deg.size());
  STRCMP_CONTAINS("is taken", say("angle 37.5").c_str());
  LONGS_EQUAL(1, session.coverage().directions_deg.size());
}

// A ring that is glued or drawn some degrees off.
TEST(GuidedSession, AnAngleThatIsAboutWhatTheReadingsSayIsTaken) {
  hold(358, 24);
  STRCMP_CONTAINS("is taken", say("angle 10").c_str());
  STRCMP_CONTAINS("was not taken", say("angle 20").c_str());
  Session rough(config, session.rows(), {.angle_deg = 6});
  for (int i = 0; i < 40; ++i) rough.take({0.01 * i, hand.touch(358, 24)});
  CHECK_FALSE(rough.obey(AngleIs{20}).isRefused);
}

TEST(GuidedSession, AnAngleIsOfTheRingAsTheFitHasItTurned) {
  auto turned = poorlyTold();
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(turned.drawing().unknowns());
  for (int gauge = 0; gauge < 16; ++gauge)
    deviations[calibration::Drawing::at(gauge, calibration::kAngleOffset)] = 30 / config.tolerance.angle_deg;
  const calibration::CalibrationResult result(turned.drawing(), deviations, turned.covariance(), {}, {0, 0},
                                              true);
  session.takeFit({.rows = 70, .result = result});
  hold(45, 24);
  STRCMP_CONTAINS("say about 75 deg", say("angle 45").c_str());
  STRCMP_CONTAINS("is taken", say("angle 75").c_str());
}

TEST(GuidedSession, WhatWasEnteredIsTakenBackTheLastFirst) {
  leaveAlone(5.1);
  hold(45, 24);
  say("load 24 N/m");
  say("angle 45");
  hold(90, 20);
  const std::size_t rows = session.rows().size();
  STRCMP_EQUAL("the angle of 45 deg is taken back", say("undo").c_str());
  STRCMP_EQUAL("the load of 24 N/m is taken back", say("undo").c_str());
  LONGS_EQUAL(0, session.coverage().loads);
  STRCMP_EQUAL("no load and no angle was entered yet", say("undo").c_str());
  CHECK_FALSE(session.obey(Undo{}).takenBack);
  LONGS_EQUAL(rows, session.rows().size());
  LONGS_EQUAL(10,
              std::ranges::count_if(session.rows().known, [](const auto& of) { return of.isUntouched(); }));
}

TEST(GuidedSession, WhatAnEarlierSessionHasIsTakenBackAsSuch) {
  Rows rows;
  rows.add(hand.touch(45, 24), {45, 24, 3});
  Session again(config, rows);
  STRCMP_EQUAL("the angle of 45 deg and the load of 24 N/m, of an earlier session, is taken back",
               again.obey(Undo{}).message.c_str());
  CHECK_FALSE(again.rows().known[0].tangential_n_per_m.has_value());
}

TEST(GuidedSession, NoFitStandsThatKnewWhatWasTakenBack) {
  leaveAlone(5.1);
  rollAround();
  hold(45, 24);
  say("load 24 N/m");
  session.takeFit({.rows = session.beginFit().size(), .result = poorlyTold()});
  CHECK_TRUE(session.fit().has_value());
  session.beginFit();
  CHECK_TRUE(session.obey(Undo{}).takenBack);
  CHECK_FALSE(session.fit().has_value());
  CHECK_TRUE(session.wantsFit());
  session.takeFit({.rows = 1, .result = poorlyTold()});  // was under way
  CHECK_FALSE(session.fit().has_value());
  session.beginFit();
  session.takeFit({.rows = 1, .result = poorlyTold()});
  CHECK_TRUE(session.fit().has_value());
}

// Nothing can be told by wires that are wrong.
TEST(GuidedSession, NoLoadIsDoubtedOfReadingsThatNoTouchExplains) {
  for (int i = 0; i < 40; ++i) take(-hand.touch(45, 24));
  say("load 0.48 N/m");
  LONGS_EQUAL(1, session.coverage().loads);
}

TEST(GuidedSession, AZeroIsTakenBeforeThereAreRowsAlone) {
  CHECK_TRUE(session.obey(Tare{}).tare);
  leaveAlone(5.1);
  CHECK_FALSE(session.obey(Tare{}).tare);
  STRCMP_CONTAINS("have the old zero", say("tare").c_str());
  STRCMP_CONTAINS("have the old zero", session.obey(MayTare{}).message.c_str());
}

TEST(GuidedSession, WhatCannotBeDoneIsSkipped) {
  STRCMP_CONTAINS("cannot be skipped", say("skip").c_str());
  leaveAlone(5.1);
  rollAround(10);
  rollAround(18);
  STRCMP_CONTAINS("unit of force is the drawing's", say("skip").c_str());
  CHECK(session.advice().kind == Kind::kMark);
  STRCMP_CONTAINS("turned or reversed", say("skip").c_str());
  CHECK(session.advice().kind == Kind::kWait);
}

// A second load would tell the unit of force better; the first has told it.
TEST(GuidedSession, SkippingAnotherLoadLeavesWhatLoadsHaveTold) {
  leaveAlone(5.1);
  rollAround(10);
  rollAround(18);
  Assessment assessment;
  assessment.unitOfForce = 0.05;
  assessment.unitAfterPress.assign(16, 0.03);
  session.takeFit({.rows = session.rows().size(), .result = poorlyTold(), .assessment = assessment});
  hold(45, 24);
  say("load 24 N/m");
  CHECK(session.advice().kind == Kind::kPress);
  STRCMP_EQUAL("the unit of force is what the loads tell that were taken", say("skip").c_str());
}

TEST(GuidedSession, SkippingAnotherMarkLeavesWhatMarksHaveTold) {
  leaveAlone(5.1);
  rollAround(10);
  rollAround(18);
  hold(45, 24);
  say("angle 45");
  say("skip");  // loads
  CHECK(session.advice().kind == Kind::kMark);
  STRCMP_EQUAL("the zero of the angle is what the marks tell that were taken", say("skip").c_str());
}

TEST(GuidedSession, AFitIsWantedOfFourTouchesAGaugeThenOfAFifthMoreOrOfWhatIsKnown) {
  leaveAlone(5.1);
  CHECK_FALSE(session.wantsFit());
  rollAround(10);
  CHECK_TRUE(session.wantsFit());
  const std::size_t rows = session.beginFit().size();
  CHECK_FALSE(session.wantsFit());
  hold(45, 24);
  say("load 24 N/m");
  CHECK_TRUE(session.wantsFit());
  session.beginFit();
  rollAround(18);
  CHECK_COMPARE(session.rows().size(), >=, rows + rows / 5);
  CHECK_TRUE(session.wantsFit());
}

TEST(GuidedSession, AnArcThatIsNotCoveredPutsTheFirstFitOffButNotForEver) {
  leaveAlone(5.1);
  const auto rollHalf = [&](double load_n_per_m) {
    for (int i = 0; i < 250; ++i) take(hand.touch(0.72 * i, load_n_per_m, 0.01 * i));
  };
  for (const double load_n_per_m : {4, 8, 16, 32}) rollHalf(load_n_per_m);
  CHECK_COMPARE(session.rows().size(), >, 10 + 4 * 16);
  CHECK_FALSE(session.wantsFit());
  for (const double load_n_per_m : {5, 10, 20, 34, 6, 12, 24}) rollHalf(load_n_per_m);
  CHECK_COMPARE(session.rows().size(), >, 10 + 20 * 16);
  CHECK_TRUE(session.wantsFit());
}

TEST(GuidedSession, AFailedFitLeavesTheOneBefore) {
  session.takeFit({.rows = 70, .complaint = "gauges 3 and 4 are swapped"});
  STRCMP_EQUAL("gauges 3 and 4 are swapped", session.complaint().c_str());
  CHECK_FALSE(session.fit().has_value());
}

TEST(GuidedSession, FaultyGaugesStopItBeforeAnythingElseIsAskedFor) {
  session.takeFit({.rows = 70, .complaint = "gauges 3 and 4 are swapped", .isOfFaults = true});
  CHECK_TRUE(session.isFaulty());
  CHECK(session.advice().kind == Kind::kMend);
  STRCMP_CONTAINS("Stop: ", textOf(session.advice(), config.gauges).c_str());
  STRCMP_CONTAINS("another -o", textOf(session.advice(), config.gauges).c_str());
  session.takeFit({.rows = 80, .complaint = "too few touches"});
  CHECK(session.advice().kind == Kind::kLeaveAlone);
}

// A gauge that came loose: what was fitted before is no more what the finger reads.
TEST(GuidedSession, NoFitStandsOnceTheFingerIsFaulty) {
  session.takeFit({.rows = 70, .result = poorlyTold()});
  CHECK_TRUE(session.fit().has_value());
  session.takeFit({.rows = 80, .complaint = "too few touches"});
  CHECK_TRUE(session.fit().has_value());
  session.takeFit({.rows = 90, .complaint = "gauge 3 is loose", .isOfFaults = true});
  CHECK_FALSE(session.fit().has_value());
}

TEST(GuidedSession, ItHoldsUntilALoadIsTaken) {
  CHECK_FALSE(session.isHolding());
  hold(45, 24);
  say("hold");
  CHECK_TRUE(session.isHolding());
  say("load 24 N/m");
  CHECK_FALSE(session.isHolding());
}

TEST(GuidedSession, GoesOnWithTheRowsOfBefore) {
  leaveAlone(5.1);
  rollAround(10);
  Session again(config, session.rows());
  LONGS_EQUAL(session.rows().size(), again.rows().size());
  CHECK(session.coverage().touches == again.coverage().touches);
  CHECK(again.advice() == session.advice());
  CHECK_TRUE(again.wantsFit());
}
