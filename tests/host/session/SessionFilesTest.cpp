#include "host/session/session_files.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/base/failure.hpp"
#include "host/config/read_config.hpp"
#include "host/config/write_config.hpp"
#include "tests/host/base/smallest_disk.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using session::SessionFiles;

TEST_GROUP(SessionFiles) {
  const std::string folder_ = std::string(P_tmpdir) + "/session_files_test." + std::to_string(getpid());
  const std::string config_ = folder_ + "/cal.toml", strains_ = folder_ + "/cal.strains.csv",
                    touches_ = folder_ + "/cal.touches.csv", session_ = folder_ + "/cal.session.toml";

  /// Of the ring: the fewest gauges that there may be.
  static constexpr int kGauges = 12;
  const std::string header_ =
      "time_s,strain_0,strain_1,strain_2,strain_3,strain_4,strain_5,strain_6,strain_7,strain_8,strain_9,"
      "strain_10,strain_11\n";
  const std::string rest_ = ",0,0,0,0,0,0,0,0,0\n";  ///< of a row, behind its first three strains
  config::FingerConfig finger_;

  void setup() override {
    std::filesystem::remove_all(folder_);  // of a process of that number that was killed
    std::filesystem::create_directory(folder_);
    finger_.gauges.count = kGauges;
  }
  void teardown() override { std::filesystem::remove_all(folder_); }

  static std::string contentOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  static void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }
  static Eigen::VectorXd strains(double first, double second, double third) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(kGauges);
    row.head<3>() << first, second, third;
    return row;
  }
  void addTwo() {
    SessionFiles files(config_, finger_);
    files.add(1.5, strains(0.1, -2e-6, 0.5), {std::nullopt, 24.5, std::nullopt});
    files.add(2.5, strains(0.25, 0, 0), {40, std::nullopt, std::nullopt});
  }
  void checkRefused(const std::string& message) {
    try {
      SessionFiles files(config_, finger_);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kFailure), static_cast<int>(failure.code()));
      STRCMP_CONTAINS(message.c_str(), failure.what());
      return;
    }
    FAIL("not refused");
  }
};

TEST(SessionFiles, NoHalfRowStaysOnAFullDisk) {
  addTwo();
  {
    SessionFiles files(config_, finger_);
    const SmallestDisk disk(std::filesystem::file_size(strains_) + 10);
    LONGS_EQUAL(2, files.kept());
    CHECK_THROWS(Failure, files.add(3.5, strains(0.5, 0, 0), {}));
    LONGS_EQUAL(2, files.kept());
  }
  STRCMP_EQUAL("\n", contentOf(strains_).substr(contentOf(strains_).size() - 1).c_str());
  LONGS_EQUAL(2, SessionFiles(config_, finger_).rows().size());
}

TEST(SessionFiles, AreWhatCalibrateReads) {
  addTwo();
  STRCMP_EQUAL((header_ + "1.500000,0.1,-2e-06,0.5" + rest_ + "2.500000,0.25,0,0" + rest_).c_str(),
               contentOf(strains_).c_str());
  STRCMP_EQUAL("angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n40,,\n", contentOf(touches_).c_str());
}

TEST(SessionFiles, AreNamedWhereCalibrateSpeaksOfTouches) {
  const SessionFiles files(config_, finger_);
  STRCMP_EQUAL(("the loads of " + files.touchesPath() + " are wrong in rows 3").c_str(),
               files.named("the loads of touches.csv are wrong in rows 3").c_str());
  STRCMP_EQUAL("gauge 3 is dead", files.named("gauge 3 is dead").c_str());
}

TEST(SessionFiles, WithoutRowsDontStayIfTheyAreNew) {
  { const SessionFiles files(config_, finger_); }
  CHECK_TRUE(std::filesystem::is_empty(folder_));
  write(strains_, "");
  { const SessionFiles files(config_, finger_); }
  CHECK_TRUE(std::filesystem::exists(strains_));
  CHECK_FALSE(std::filesystem::exists(touches_));
}

TEST(SessionFiles, GoOnWithWhatIsThere) {
  write(strains_, header_ + "1.5,0.1,-2e-06,0.3" + rest_);
  write(touches_, "angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n");
  SessionFiles files(config_, finger_);
  LONGS_EQUAL(1, files.rows().size());
  DOUBLES_EQUAL(-2e-6, files.rows().strains[0][1], 0);
  DOUBLES_EQUAL(24.5, *files.rows().known[0].normal_n_per_m, 0);
  CHECK_FALSE(files.rows().known[0].angle_deg.has_value());
  files.add(2.5, strains(0, 0, 0), {});
  LONGS_EQUAL(2, files.kept());
  STRCMP_CONTAINS((rest_ + "2.500000,0,0,0" + rest_).c_str(), contentOf(strains_).c_str());
}

TEST(SessionFiles, GoOnAfterSomethingWasTakenBack) {
  SessionFiles files(config_, finger_);
  files.add(1.5, strains(0, 0, 0), {std::nullopt, 24.5, std::nullopt});
  files.add(2.5, strains(0, 0, 0), {40, std::nullopt, std::nullopt});
  files.add(3.5, strains(0, 0, 0), {std::nullopt, 0, 0});
  files.rewriteTouches({{std::nullopt, 24.5, std::nullopt}, {}, {std::nullopt, 0, 0}});
  files.add(4.5, strains(0, 0, 0), {50, std::nullopt, std::nullopt});
  STRCMP_EQUAL("angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n,,\n,0,0\n50,,\n",
               contentOf(touches_).c_str());
  for (const std::string& path : {strains_, session_})  // which would be refused as well
    std::filesystem::remove(path);
  checkRefused(touches_ + ": another session writes it now");
}

TEST(SessionFiles, ARowThatWasHalfWrittenIsTakenAway) {
  addTwo();
  const std::string touches = contentOf(touches_);
  write(strains_, contentOf(strains_).substr(0, contentOf(strains_).size() - 10));  // in the second row
  write(touches_, touches.substr(0, touches.size() - 5));
  SessionFiles files(config_, finger_);
  LONGS_EQUAL(1, files.rows().size());
  STRCMP_EQUAL("angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n", contentOf(touches_).c_str());
}

TEST(SessionFiles, OfARowWithoutItsTouchNothingIsKnown) {
  addTwo();
  write(touches_, "angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n");
  SessionFiles files(config_, finger_);
  LONGS_EQUAL(2, files.rows().size());
  STRCMP_EQUAL("angle_deg,normal_n_per_m,tangential_n_per_m\n,24.5,\n,,\n", contentOf(touches_).c_str());
}

TEST(SessionFiles, AConfigThatIsNoSessionsIsNotTouched) {
  write(config_, "schema = 1\n");
  checkRefused("there is such a file already");
  CHECK_FALSE(std::filesystem::exists(strains_));
  STRCMP_EQUAL("schema = 1\n", contentOf(config_).c_str());
}

TEST(SessionFiles, AFileThatOnlyHasTheNameOfASessionsConfigIsNotTouched) {
  write(session_, "mine");
  checkRefused(session_ + ": there is such a file already");
  CHECK_FALSE(std::filesystem::exists(strains_));
  STRCMP_EQUAL("mine", contentOf(session_).c_str());
}

TEST(SessionFiles, NothingStaysOfASessionThatCouldNotBegin) {
  std::filesystem::create_directory(touches_);
  checkRefused(touches_ + ": cannot open the file");
  CHECK_FALSE(std::filesystem::exists(strains_));
  CHECK_TRUE(std::filesystem::is_directory(touches_));
}

TEST(SessionFiles, FilesOfAnotherRingAreNotTouched) {
  addTwo();
  finger_.gauges.count = 14;
  checkRefused("its first line must be \"time_s,strain_0,strain_1,");
  STRCMP_CONTAINS("strain_11\n1.5", contentOf(strains_).c_str());
}

// Strains of another full scale are off by its ratio, and their fit looks as good as ever.
TEST(SessionFiles, RowsOfAnotherFingerAreRefusedByTheFirstKeyThatDiffers) {
  addTwo();
  const std::string strains = contentOf(strains_), session = contentOf(session_);
  finger_.gauges.full_scale_strain = 0.04;
  finger_.gauges.adc_bits = 14;
  checkRefused(strains_ +
               ": its rows were collected with gauges.full_scale_strain = 0.03, and the config now has "
               "0.04: go on with -c " +
               session_ + ", or give another -o");
  finger_.finger.core_radius_m = 0.008;
  checkRefused("collected with finger.core_radius_m = 0.0089, and the config now has 0.008");
  STRCMP_EQUAL(strains.c_str(), contentOf(strains_).c_str());
  STRCMP_EQUAL(session.c_str(), contentOf(session_).c_str());
  finger_ = config::readConfigFile(session_);
  LONGS_EQUAL(2, SessionFiles(config_, finger_).rows().size());
}

TEST(SessionFiles, RowsDontDependOnNoiseBusOrTolerances) {
  addTwo();
  finger_.gauges.noise_strain = 9e-6;
  finger_.gauges.model_error = 0;
  finger_.can.node = 9;
  finger_.tolerance.depth_m = 1e-4;
  LONGS_EQUAL(2, SessionFiles(config_, finger_).rows().size());
}

TEST(SessionFiles, RowsOfAnOlderSessionAreTakenForThisConfigs) {
  addTwo();
  std::filesystem::remove(session_);
  finger_.gauges.full_scale_strain = 0.04;
  SessionFiles files(config_, finger_);
  LONGS_EQUAL(2, files.rows().size());
  files.add(3.5, strains(0, 0, 0), {});
  CHECK_FALSE(std::filesystem::exists(session_));
}

TEST(SessionFiles, TheFingerOfASessionWithoutRowsRefusesNone) {
  finger_.gauges.full_scale_strain = 0.05;
  write(session_, config::writeConfig(finger_));
  write(strains_, header_);
  finger_.gauges.full_scale_strain = 0.04;
  addTwo();
  DOUBLES_EQUAL(0.04, config::readConfigFile(session_).gauges.full_scale_strain, 0);
}

TEST(SessionFiles, AFingersFileThatIsBrokenIsRefusedByItsPlace) {
  addTwo();
  write(session_, "schema = 1\n[finger\n");
  checkRefused(session_ + ":2:");
}

TEST(SessionFiles, TouchesWithoutRowsAreRefused) {
  addTwo();
  write(strains_, header_ + "1.5,0.1,-2e-06,0.3" + rest_);
  checkRefused("more rows than in");
}

TEST(SessionFiles, OneSessionAtATimeWritesThem) {
  const SessionFiles files(config_, finger_);
  checkRefused("another session writes it now");
}

TEST(SessionFiles, AFolderThatIsNotThereIsTold) {
  try {
    SessionFiles files(folder_ + "/nowhere/cal.toml", finger_);
    FAIL("made");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS("cal.strains.csv: cannot open the file: No such file", failure.what());
  }
}
