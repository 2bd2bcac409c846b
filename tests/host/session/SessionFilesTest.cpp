#include "host/session/session_files.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using session::SessionFiles;

TEST_GROUP(SessionFiles) {
  const std::string folder_ = std::string(P_tmpdir) + "/session_files_test." + std::to_string(getpid());
  const std::string config_ = folder_ + "/cal.toml", strains_ = folder_ + "/cal.strains.csv",
                    touches_ = folder_ + "/cal.touches.csv";

  void setup() override { std::filesystem::create_directory(folder_); }
  void teardown() override { std::filesystem::remove_all(folder_); }

  static std::string contentOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  static void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }
  void addTwo() {
    SessionFiles files(config_, 3);
    files.add(1.5, Eigen::Vector3d{0.1, -2e-6, 0.5}, {std::nullopt, 24.5, std::nullopt});
    files.add(2.5, Eigen::Vector3d{0.25, 0, 0}, {40, std::nullopt, std::nullopt});
  }
  void checkRefused(const char* message, int gauges = 3) {
    try {
      SessionFiles files(config_, gauges);
    } catch (const Failure& failure) {
      STRCMP_CONTAINS(message, failure.what());
      return;
    }
    FAIL("not refused");
  }
};

TEST(SessionFiles, AreWhatCalibrateReads) {
  addTwo();
  STRCMP_EQUAL("time_s,strain_0,strain_1,strain_2\n1.500000,0.1,-2e-06,0.5\n2.500000,0.25,0,0\n",
               contentOf(strains_).c_str());
  STRCMP_EQUAL("angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n40,,\n", contentOf(touches_).c_str());
}

TEST(SessionFiles, AreNamedWhereCalibrateSpeaksOfTouches) {
  const SessionFiles files(config_, 3);
  STRCMP_EQUAL(("the loads of " + files.touchesPath() + " are wrong in rows 3").c_str(),
               files.named("the loads of touches.csv are wrong in rows 3").c_str());
  STRCMP_EQUAL("gauge 3 is dead", files.named("gauge 3 is dead").c_str());
}

TEST(SessionFiles, WithoutRowsDontStayIfTheyAreNew) {
  { const SessionFiles files(config_, 3); }
  CHECK_FALSE(std::filesystem::exists(strains_) || std::filesystem::exists(touches_));
  write(strains_, "");
  { const SessionFiles files(config_, 3); }
  CHECK_TRUE(std::filesystem::exists(strains_));
  CHECK_FALSE(std::filesystem::exists(touches_));
}

TEST(SessionFiles, GoOnWithWhatIsThere) {
  write(strains_, "time_s,strain_0,strain_1,strain_2\n1.5,0.1,-2e-06,0.3\n");
  write(touches_, "angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n");
  SessionFiles files(config_, 3);
  LONGS_EQUAL(1, files.rows().size());
  DOUBLES_EQUAL(-2e-6, files.rows().strains[0][1], 0);
  DOUBLES_EQUAL(24.5, *files.rows().known[0].normal_n_per_m, 0);
  CHECK_FALSE(files.rows().known[0].angle_deg.has_value());
  files.add(2.5, Eigen::Vector3d::Zero(), {});
  STRCMP_CONTAINS("0.3\n2.500000,0,0,0\n", contentOf(strains_).c_str());
}

TEST(SessionFiles, GoOnAfterSomethingWasTakenBack) {
  SessionFiles files(config_, 3);
  files.add(1.5, Eigen::Vector3d::Zero(), {std::nullopt, 24.5, std::nullopt});
  files.add(2.5, Eigen::Vector3d::Zero(), {40, std::nullopt, std::nullopt});
  files.add(3.5, Eigen::Vector3d::Zero(), {std::nullopt, 0, 0});
  files.rewriteTouches({{std::nullopt, 24.5, std::nullopt}, {}, {std::nullopt, 0, 0}});
  files.add(4.5, Eigen::Vector3d::Zero(), {50, std::nullopt, std::nullopt});
  STRCMP_EQUAL("angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n,,\n,0,0\n50,,\n",
               contentOf(touches_).c_str());
  std::filesystem::remove(strains_);  // whose lock would refuse as well
  checkRefused((touches_ + ": another session writes it now").c_str());
}

TEST(SessionFiles, ARowThatWasHalfWrittenIsTakenAway) {
  addTwo();
  const std::string touches = contentOf(touches_);
  write(strains_, contentOf(strains_).substr(0, 70));  // in the second row
  write(touches_, touches.substr(0, touches.size() - 5));
  SessionFiles files(config_, 3);
  LONGS_EQUAL(1, files.rows().size());
  STRCMP_EQUAL("angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n", contentOf(touches_).c_str());
}

TEST(SessionFiles, OfARowWithoutItsTouchNothingIsKnown) {
  addTwo();
  write(touches_, "angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n");
  SessionFiles files(config_, 3);
  LONGS_EQUAL(2, files.rows().size());
  STRCMP_EQUAL("angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n,,\n", contentOf(touches_).c_str());
}

TEST(SessionFiles, AConfigThatIsNoSessionsIsNotTouched) {
  write(config_, "schema = 1\n");
  checkRefused("there is such a file already");
  CHECK_FALSE(std::filesystem::exists(strains_));
  STRCMP_EQUAL("schema = 1\n", contentOf(config_).c_str());
}

TEST(SessionFiles, FilesOfAnotherRingAreNotTouched) {
  addTwo();
  checkRefused("its first line must be \"time_s,strain_0,strain_1\"", 2);
  STRCMP_CONTAINS("strain_2\n1.5", contentOf(strains_).c_str());
}

TEST(SessionFiles, TouchesWithoutRowsAreRefused) {
  addTwo();
  write(strains_, "time_s,strain_0,strain_1,strain_2\n1.5,0.1,-2e-06,0.3\n");
  checkRefused("more rows than in");
}

TEST(SessionFiles, OneSessionAtATimeWritesThem) {
  const SessionFiles files(config_, 3);
  checkRefused("another session writes it now");
}

TEST(SessionFiles, AFolderThatIsNotThereIsTold) {
  try {
    SessionFiles files(folder_ + "/nowhere/cal.toml", 3);
    FAIL("made");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS("cal.strains.csv: cannot open the file: No such file", failure.what());
  }
}
