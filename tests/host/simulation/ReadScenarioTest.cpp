#include "host/simulation/read_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

TEST_GROUP(ReadScenario) {
  /// A touch from 1 s to 3 s whose angle is line 5, its value at column 13.
  std::string withAngle(const std::string& angle) {
    return "schema = 1\n[[touch]]\nstart_s = 1\nend_s = 3\nangle_deg = " + angle + "\nnormal_n_per_m = 20\n";
  }
  std::string complaintAbout(const std::string& text) {
    try {
      readScenario(text, "s.toml");
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
      return failure.what();
    }
    return "accepted";
  }
  void checkComplaint(const std::string& text, const std::string& part) {
    STRCMP_CONTAINS(part.c_str(), complaintAbout(text).c_str());
  }
  double angleAt_deg(const std::string& angle, double time_s) {
    return readScenario(withAngle(angle), "s").at(time_s).at(0).angle_rad * 180 / std::numbers::pi;
  }
};

TEST(ReadScenario, ANumberIsConstant) {
  DOUBLES_EQUAL(40, angleAt_deg("40", 1), 1e-13);
  DOUBLES_EQUAL(40, angleAt_deg("40.0", 2.9), 1e-13);
}

TEST(ReadScenario, NumbersAreSpreadEvenlyOverTheTouch) {
  DOUBLES_EQUAL(10, angleAt_deg("[10, 30, 20]", 1), 1e-13);
  DOUBLES_EQUAL(20, angleAt_deg("[10, 30, 20]", 1.5), 1e-13);
  DOUBLES_EQUAL(30, angleAt_deg("[10, 30, 20]", 2), 1e-13);
  DOUBLES_EQUAL(25, angleAt_deg("[10, 30, 20]", 2.5), 1e-13);
}

TEST(ReadScenario, PointsHaveTheirTimeSinceTheTouchsStart) {
  DOUBLES_EQUAL(10, angleAt_deg("[[0.5, 10], [1, 30]]", 1.2), 1e-13);
  DOUBLES_EQUAL(20, angleAt_deg("[[0.5, 10], [1, 30]]", 1.75), 1e-13);
  DOUBLES_EQUAL(30, angleAt_deg("[[0.5, 10], [1, 30]]", 2.5), 1e-13);
}

// 1.4 - 1 is less than 0.4.
TEST(ReadScenario, AListMayEndWithTheTouchWhateverItsTimes) {
  struct Life {
    std::string start, end, duration;
  };
  for (const Life& life :
       {Life{"1", "1.4", "0.4"}, Life{"0.1", "0.3", "0.2"}, Life{"86399.7", "86400.1", "0.4"}}) {
    const auto endingAt = [&](const std::string& time) {
      return "schema = 1\n[[touch]]\nstart_s = " + life.start + "\nend_s = " + life.end +
             "\nangle_deg = 0\nnormal_n_per_m = [[0, 10], [" + time + ", 20]]\n";
    };
    STRCMP_EQUAL("accepted", complaintAbout(endingAt(life.duration)).c_str());
    STRCMP_EQUAL(("s.toml:6:29: time in touch.normal_n_per_m = 0.41 is out of its domain; it must be 0 to " +
                  life.duration)
                     .c_str(),
                 complaintAbout(endingAt("0.41")).c_str());
  }
}

TEST(ReadScenario, TheTangentialLoadIsZeroWhenLeftOut) {
  const Touch touch = readScenario(withAngle("0"), "s").at(2).at(0);
  CHECK_TRUE((touch == Touch{0, 20, 0}));
}

TEST(ReadScenario, ATouchMayHaveAWidthAndAProfile) {
  const auto touchOf = [&](const std::string& more) {
    return readScenario(withAngle("0") + more, "s").at(2).at(0);
  };
  DOUBLES_EQUAL(2e-3, *touchOf("width_m = 2e-3").width_m, 0);
  CHECK_TRUE(model::Profile::kEllipse == touchOf("width_m = 2e-3").profile);
  CHECK_TRUE(model::Profile::kEllipse == touchOf("width_m = 2e-3\nprofile = \"hertz\"").profile);
  CHECK_TRUE(model::Profile::kUniform == touchOf("width_m = 2e-3\nprofile = \"uniform\"").profile);
  DOUBLES_EQUAL(1e-3, *touchOf("width_m = [0, 2e-3]").width_m, 1e-18);
  CHECK_FALSE(touchOf("").width_m.has_value());
}

TEST(ReadScenario, WidthsAndProfilesThatCantBeAreNamed) {
  checkComplaint(withAngle("0") + "width_m = -1e-3",
                 "s.toml:7:11: touch.width_m = -0.001 is out of its domain; it must be 0 to 1");
  checkComplaint(
      withAngle("0") + "width_m = 1e-3\nprofile = \"round\"",
      "s.toml:8:11: touch.profile = \"round\" is out of its domain; it must be one of hertz, uniform");
  checkComplaint(withAngle("0") + "width_m = 1e-3\nprofile = 1",
                 "touch.profile is an integer; it must be a text");
  checkComplaint(
      withAngle("0") + "profile = \"hertz\"",
      "s.toml:7:11: touch.profile says how the load is spread over touch.width_m, which is missing");
}

TEST(ReadScenario, AScenarioMayHaveNoTouch) {
  DOUBLES_EQUAL(0, readScenario("schema = 1", "s").duration_s(), 0);
}

TEST(ReadScenario, EachMissingKeyIsNamed) {
  const std::string whole = withAngle("0");
  for (const char* key : {"start_s", "end_s", "angle_deg", "normal_n_per_m"}) {
    std::string text = whole;
    const auto begin = text.find(key);
    text.erase(begin, text.find('\n', begin) - begin);
    STRCMP_EQUAL(("s.toml:2:1: touch." + std::string(key) + " is missing").c_str(),
                 complaintAbout(text).c_str());
  }
}

TEST(ReadScenario, UnknownKeysAreNamedWithWhatWasProbablyMeant) {
  checkComplaint(withAngle("0") + "tangent_n_per_m = 1",
                 "s.toml:7:1: unknown key touch.tangent_n_per_m; did you mean ");
  checkComplaint("schema = 1\nrepeats_s = 4", "s.toml:2:1: unknown key repeats_s; did you mean repeat_s?");
}

TEST(ReadScenario, AnglesAndLoadsOutOfTheirDomainPointAtThemselves) {
  checkComplaint(withAngle("3601"), "s.toml:5:13: touch.angle_deg = 3601 is out of its domain");
  checkComplaint(withAngle("[0, nan]"), "s.toml:5:17: touch.angle_deg = nan is out of its domain");
  checkComplaint(withAngle("[[0, 1], [1, inf]]"), "s.toml:5:26: touch.angle_deg = inf is out of its domain");
  checkComplaint(withAngle("0\ntangential_n_per_m = -10001"), "touch.tangential_n_per_m = -10001");
  checkComplaint("schema = 1\n[[touch]]\nstart_s = 0\nend_s = 1\nangle_deg = 0\nnormal_n_per_m = -1",
                 "s.toml:6:18: touch.normal_n_per_m = -1 is out of its domain; it must be 0 to 10000");
}

TEST(ReadScenario, ListsThatAreNoCourseSayWhatOneIs) {
  checkComplaint(withAngle("\"40\""), "s.toml:5:13: touch.angle_deg is a text; it must be a real number");
  checkComplaint(withAngle("[]"), "a list needs at least two points");
  checkComplaint(withAngle("[1]"), "a list needs at least two points");
  checkComplaint(withAngle("[1, [1, 2]]"),
                 "s.toml:5:17: touch.angle_deg: all numbers or all [seconds, number]");
  checkComplaint(withAngle("[[0, 1], 2]"), "all numbers or all [seconds, number]");
  checkComplaint(withAngle("[[0, 1], [1, 2, 3]]"),
                 "s.toml:5:22: touch.angle_deg: a point must be [seconds, number]");
  checkComplaint(withAngle("[[1, 1], [0.5, 2]]"),
                 "s.toml:5:22: touch.angle_deg: points must be in order of time");
  checkComplaint(withAngle("[[0, 1], [2.1, 2]]"),
                 "time in touch.angle_deg = 2.1 is out of its domain; it must be 0 to 2");
  checkComplaint(withAngle("[\"a\", \"b\"]"), "s.toml:5:14: touch.angle_deg is a text");
}

TEST(ReadScenario, TimesMustMakeSense) {
  checkComplaint("schema = 1\n[[touch]]\nstart_s = 2\nend_s = 2",
                 "s.toml:4:9: touch.end_s = 2 must be after touch.start_s = 2");
  checkComplaint("schema = 1\n[[touch]]\nstart_s = -1\nend_s = 2", "touch.start_s = -1 is out of its domain");
  checkComplaint("schema = 1\nrepeat_s = 0",
                 "s.toml:2:12: repeat_s = 0 is out of its domain; it must be greater than 0");
  checkComplaint("schema = 1\npause_s = 1", "s.toml:2:11: pause_s is the time between repeats");
  checkComplaint("schema = 1\nrepeat_s = 1\npause_s = -1",
                 "s.toml:3:11: pause_s = -1 is out of its domain; it must be 0 to 864000");
  checkComplaint("repeat_s = 2.5\n" + withAngle("0"),
                 "s.toml:1:12: repeat_s = 2.5 cuts off a touch: touch.end_s = 3");
}

TEST(ReadScenario, TouchIsAListOfSections) {
  checkComplaint("schema = 1\n[touch]\nstart_s = 1",
                 "s.toml:2:1: touch must be a list of sections: [[touch]]");
  checkComplaint("schema = 1\ntouch = [3]", "s.toml:2:10: touch is an integer; it must be a section");
}

TEST(ReadScenario, SchemaSyntaxAndFileAreCheckedAsForTheConfig) {
  checkComplaint("", "schema is missing; the file must begin with schema = 1");
  checkComplaint("schema = 1\n[[touch]\n", "s.toml:2:");
  CHECK_THROWS(Failure, readScenarioFile("/nonexistent/s.toml"));
}

TEST(ReadScenario, TheBuiltInOneBeginsIdleRepeatsAndStaysWithinTheFinger) {
  const Scenario scenario = builtInScenario();
  DOUBLES_EQUAL(10, scenario.duration_s(), 0);
  for (int ms = 0; ms < 20'000; ++ms) {
    const auto touches = scenario.at(ms * 1e-3);
    CHECK_TRUE(touches.size() <= 1 && (ms > 300 || touches.empty()));
    for (const Touch& touch : touches) {
      CHECK_TRUE(touch.normal_n_per_m <= 45);  // N/m; the default finger saturates at 65
      CHECK_TRUE(std::fabs(touch.tangential_n_per_m) <= 0.9 * touch.normal_n_per_m + 1e-9);
    }
  }
}
