#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/commands/program.hpp"
#include "tests/commands/tables.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(ContactCommand) {
  static std::string flat(const std::string& more) { return "contact --indenter flat " + more; }

  static std::vector<double> summary(const std::string& arguments) {
    return tableOf(runProgram(arguments + " --summary").out).at(0);
  }

  static void refuses(const std::string& arguments, const std::string& named) {
    const Run run = runProgram(arguments);
    LONGS_EQUAL(2, run.status);
    STRCMP_EQUAL("", run.out.c_str());
    STRCMP_CONTAINS(named.c_str(), run.err.c_str());
  }
};

TEST(ContactCommand, SummarisesInTheColumnsScriptsRelyOn) {
  const Run run = runProgram(flat("--width-m 2e-3 --summary"));
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("normal_n_per_m,tangential_n_per_m,width_m,depth_m,offset_deg,residual_m\n21.4939181",
                  run.out.c_str());
  STRCMP_CONTAINS("contact: residual ", run.err.c_str());
}

TEST(ContactCommand, PrintsTractionsOverTwiceTheContact) {
  const Run run = runProgram(flat("--width-m 2e-3"));
  STRCMP_CONTAINS("angle_deg,pressure_pa,shear_pa,slope\n", run.out.c_str());
  const auto rows = tableOf(run.out);
  LONGS_EQUAL(400, rows.size());
  double load = 0;
  for (const auto& row : rows) {
    const double x = row[0] * std::numbers::pi / 180 * 12.7;  // mm
    DOUBLES_EQUAL(std::abs(x) < 1 ? 1 : 0, row[1] > 0 ? 1 : 0, 0);
    DOUBLES_EQUAL(0, row[2], 0);
    if (std::abs(x) < 1) DOUBLES_EQUAL(x * 1e-3, row[3], 1e-12);  // the flat indenter's slope, r_b theta
    load += row[1] * 4e-3 / 400;
  }
  DOUBLES_EQUAL(21.4939181, load, 0.01);  // midpoint rule against a square root
}

TEST(ContactCommand, LooksWhereItIsAsked) {
  const auto rows = tableOf(runProgram(flat("--width-m 2e-3 --at-deg 0,-9")).out);
  LONGS_EQUAL(2, rows.size());
  DOUBLES_EQUAL(13686.2526384, rows[0][1], 1e-7);
  DOUBLES_EQUAL(0, rows[1][1], 0);
  CHECK_TRUE(rows[1][3] > -0.2e-3 && rows[1][3] < 0);  // outside the surface is less steep than the indenter
}

TEST(ContactCommand, TakesALoad) {
  DOUBLES_EQUAL(1.932184257e-3, summary(flat("--load-n-per-m 20"))[2], 2e-12);
}

TEST(ContactCommand, FrictionSlidesTheContact) {
  const auto known = summary(flat("--width-m 2e-3 --friction 0.5 --regime sliding"));
  DOUBLES_EQUAL(21.4885228, known[0], 1e-7);
  DOUBLES_EQUAL(10.744261, known[1], 1e-6);
  DOUBLES_EQUAL(0.0621079 / 12.7 * 180 / std::numbers::pi, known[4], 1e-6);
  DOUBLES_EQUAL(known[0], summary(flat("--width-m 2e-3 --friction 0.5"))[0], 0);
  DOUBLES_EQUAL(21.4723573, summary(flat("--width-m 2e-3 --regime sliding"))[0], 1e-7);  // the config's 1.0
}

TEST(ContactCommand, SticksUnderATangentialLoad) {
  const auto row = summary(flat("--width-m 2e-3 --regime stick --tangential-n-per-m 10.746959"));
  DOUBLES_EQUAL(21.7513727, row[0], 1e-7);
  DOUBLES_EQUAL(10.746959, row[1], 1e-11);
}

// Pressure and shear of a wide contact turn with the surface. Known: the reaction of the core, integrated
// over what `field` has there.
TEST(ContactCommand, TellsTheForceThatALoadCellReads) {
  const std::string contact = flat("--width-m 6e-3 --friction 1");
  const auto core = tableOf(runProgram("field " + contact.substr(8) +
                                       " --radius-m 8.9e-3 --angles 721 --from-deg -180 --to-deg 180")
                                .out);
  double along = 0, sidewards = 0;
  const double part_m = 8.9e-3 * 2 * std::numbers::pi / 720;
  for (std::size_t i = 0; i < 720; ++i) {
    const double angle = core[i][1] * std::numbers::pi / 180, normal = core[i][7], shear = core[i][8];
    along -= part_m * (normal * std::cos(angle) - shear * std::sin(angle));
    sidewards += part_m * (normal * std::sin(angle) + shear * std::cos(angle));
  }
  DOUBLES_EQUAL(271.875, along, 1e-3);
  DOUBLES_EQUAL(234.849, sidewards, 1e-3);
  STRCMP_CONTAINS("contact: force 271.875 N/m along the indenter's normal, 234.849 N/m sidewards\n",
                  runProgram(contact + " --summary").err.c_str());
}

TEST(ContactCommand, WarnsOfStickThatTheFrictionWouldNotHold) {
  const auto told = [](const char* load) {
    return runProgram(flat("--width-m 2e-3 --regime stick --summary --tangential-n-per-m ") + load).err;
  };
  STRCMP_CONTAINS(
      "contact: warning: sticks with a coefficient of friction of 1.01 at least; "
      "contact.friction_coefficient is 1, with which it slides",
      told("22").c_str());
  CHECK_TRUE(told("21").find("friction") == std::string::npos);
}

TEST(ContactCommand, TakesCylindersAndWedges) {
  DOUBLES_EQUAL(21.4939181405 * 3.54, summary("contact --indenter cylinder:5e-3 --width-m 2e-3")[0], 1e-8);
  DOUBLES_EQUAL(82.79063, summary("contact --indenter wedge:80 --width-m 2e-3")[0], 1e-4);
}

// The shape comes through a pipe that a shell makes a file of.
TEST(ContactCommand, TakesMeasuredShapes) {
  const std::string shape = "x_m,height_m\n-3e-3,9e-4\n-1e-3,1e-4\n0,0\n1e-3,1e-4\n3e-3,9e-4\n";
  const Run run = runProgram("contact --indenter /dev/stdin --load-n-per-m 20 --summary", shape);
  LONGS_EQUAL(0, run.status);
  DOUBLES_EQUAL(summary("contact --indenter cylinder:5e-3 --load-n-per-m 20")[2], tableOf(run.out)[0][2],
                1e-12);
}

TEST(ContactCommand, SaysWhereAShapeIsWrong) {
  const auto fails = [](const std::string& shape, const char* named) {
    const Run run = runProgram("contact --indenter /dev/stdin --load-n-per-m 20", shape);
    LONGS_EQUAL(2, run.status);
    STRCMP_CONTAINS(named, run.err.c_str());
  };
  fails("0;0\n1e-3;0\n", "/dev/stdin:1:1: \"0;0\" has semicolons: separate columns by commas");
  fails("x;y\n0;0\n", "/dev/stdin:1:1: \"x;y\" has semicolons");
  fails("0,0\n1e-3,x\n", "/dev/stdin:2:");
  fails("0,0\n1e-3,0\n", "four points");
  fails("0,0\n1e-3,0\n1e-3,0\n2e-3,0\n",
        "/dev/stdin:3: x_m must rise from row to row: 0.001 comes after 0.001");
  fails("-2,2\n-1,0.5\n1,0.5\n2,2\n",
        "x_m goes from -2 to 2: as an arc along this finger it is from -0.0399 to");
}

TEST(ContactCommand, ThePapersMethodIsThereAndSaysWhatItIs) {
  const Run run = runProgram(flat("--width-m 2e-3 --method paper --summary"));
  STRCMP_CONTAINS("--method paper is inaccurate", run.err.c_str());
  DOUBLES_EQUAL(0.81 * 21.4939181, tableOf(run.out)[0][0], 0.02);
  const auto rows =
      tableOf(runProgram(flat("--width-m 2e-3 --method paper --cutoff 0.01 --at-deg 0,30")).out);
  DOUBLES_EQUAL(13686, rows[0][1], 0.01 * 13686);
  CHECK_TRUE(rows[1][1] != 0);  // it leaks
  STRCMP_CONTAINS("7 singular values kept, 4 of them with an even pressure", run.err.c_str());
  STRCMP_CONTAINS(
      "pressure off by 0.41 at worst, by 0.16 at the centre, load by -19 %; outside the contact 0.003",
      run.err.c_str());
  refuses(flat("--load-n-per-m 1 --method paper"), "--method paper");
  refuses(flat("--width-m 1e-3 --friction 1 --method paper"), "--method paper");
}

// A wedge's pressure is infinite below its edge.
TEST(ContactCommand, ThePapersMethodTellsHowFarItIsOffAWedge) {
  const Run run = runProgram("contact --indenter wedge:80 --width-m 2e-3 --method paper --summary");
  STRCMP_CONTAINS(
      "per its mean pressure: pressure off by 2.4 at worst but for the edge, where it is infinite, "
      "load by -14.2 %; outside the contact 0.0023 at worst",
      run.err.c_str());
}

// The row 1/10000 of the README's table, the window full.
TEST(ContactCommand, ThePapersMethodHasTheWindowsOfTheTable) {
  const Run run =
      runProgram(flat("--width-m 2e-3 --method paper --cutoff 1e-4 --window full --rows printed --summary"));
  STRCMP_CONTAINS("13 singular values kept, 7 of them", run.err.c_str());
  STRCMP_CONTAINS("off by 0.1 at worst", run.err.c_str());
  STRCMP_CONTAINS("load by -2.5", run.err.c_str());
}

TEST(ContactCommand, ThePapersMethodSaysWhenItsAnswerIsNoContact) {
  const std::string shape = "-3e-3,-9e-4\n-1e-3,-3e-4\n0,0\n1e-3,3e-4\n3e-3,9e-4\n";
  const Run tilted =
      runProgram("contact --indenter /dev/stdin --width-m 1e-3 --method paper --summary", shape);
  STRCMP_CONTAINS("no contact of this indenter is centred on its normal", tilted.err.c_str());
  const Run uncut = runProgram(flat("--width-m 2e-3 --method paper --cutoff 0 --summary"));
  STRCMP_CONTAINS("what pulls the surface out is no contact", uncut.err.c_str());
}

TEST(ContactCommand, WarnsOfLargeStrains) {
  const char* told = "0.21 of the rubber's thickness deep: strains are large";
  STRCMP_CONTAINS(told, runProgram(flat("--width-m 10e-3 --summary")).err.c_str());
  CHECK_TRUE(runProgram(flat("--width-m 4e-3 --summary")).err.find("strains are large") == std::string::npos);
}

// A contact that is nearly as wide as its cylinder, and one below steep faces, are not deep in a thick
// rubber.
TEST(ContactCommand, WarnsOfStrainsBelowNarrowContacts) {
  const auto told = [](const std::string& indenter) {
    return runProgram("contact --summary --load-n-per-m 30 --indenter " + indenter).err;
  };
  STRCMP_CONTAINS("contact: warning: strains of about 0.85 below the contact", told("cylinder:1e-4").c_str());
  STRCMP_CONTAINS("contact: warning: strains of about 1.7 below the contact", told("wedge:30").c_str());
  for (const char* gentle : {"cylinder:2e-3", "wedge:80", "flat"})
    CHECK_TRUE(told(gentle).find("strains") == std::string::npos);
}

// The curve through a step swings to either side of it.
TEST(ContactCommand, RefusesMeasuredStepsBetweenTwoPoints) {
  const auto shapeOf = [](double step_m) {
    std::string shape;
    for (int i = -400; i <= 400; ++i)
      shape += std::to_string(i) + "e-5," + (std::abs(i) < 100 ? "0" : std::to_string(step_m)) + "\n";
    return shape;
  };
  const std::string contact = "contact --indenter /dev/stdin --load-n-per-m 30 --summary";
  const Run run = runProgram(contact, shapeOf(1e-3));
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  STRCMP_CONTAINS("the measured heights jump or bend too sharply for their spacing near ", run.err.c_str());
  STRCMP_CONTAINS("5 m: the smooth curve through them swings by 5.7e-05 m there", run.err.c_str());
  STRCMP_CONTAINS("contact: warning: the measured heights jump",
                  runProgram(contact, shapeOf(5e-5)).err.c_str());
}

// The centre is between two bumps 0.1 mm high, which are 2 mm apart: the profile stands clear of the finger
// there.
TEST(ContactCommand, TellsTheRegionsOfAShapeThatTouchesTwice) {
  std::string shape;
  for (int i = -40; i <= 40; ++i) {
    const double x = i * 0.05, height = -0.1 * (std::exp(-std::pow((x - 1) / 0.3, 2)) +
                                                std::exp(-std::pow((x + 1) / 0.3, 2)));
    shape += std::to_string(x) + "e-3," + std::to_string(height) + "e-3\n";
  }
  const Run run = runProgram("contact --indenter /dev/stdin --load-n-per-m 5 --summary", shape);
  STRCMP_CONTAINS("; 2 regions: -0.00", run.err.c_str());
  CHECK_TRUE(tableOf(run.out).at(0)[3] < 0);
}

TEST(ContactCommand, RefusesHarmonicsThatTakeMinutes) {
  refuses(flat("--width-m 2e-3 --method paper --harmonics 1001"), "add --rows gauss");
  refuses(flat("--width-m 2e-3 --method paper --harmonics 2001"), "--harmonics");
}

TEST(ContactCommand, WarnsWhenNothingFits) {
  const Run run = runProgram(flat("--width-m 2e-3 --friction 0.5 --centre-deg 0 --summary"));
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("contact: warning: no contact with its centre held there", run.err.c_str());
}

TEST(ContactCommand, PrintsJson) {
  STRCMP_CONTAINS("{\"normal_n_per_m\":21.49",
                  runProgram(flat("--width-m 2e-3 --summary --json")).out.c_str());
}

TEST(ContactCommand, WantsOneSize) {
  refuses(flat(""), "--width-m W or --load-n-per-m P");
  refuses(flat("--width-m 1e-3 --load-n-per-m 1"), "--load-n-per-m");
  for (const char* width : {"0", "-1e-3", "0.05"}) refuses(flat("--width-m ") + width, "the width must be");
  for (const char* width : {"nan", "inf", "x"}) refuses(flat("--width-m ") + width, "--width-m");
  for (const char* load : {"0", "-1"}) refuses(flat("--load-n-per-m ") + load, "the load must be");
}

TEST(ContactCommand, RefusesIndentersThatAreNone) {
  for (const char* text :
       {"cylinder:0", "cylinder:-1", "cylinder:x", "cylinder:", "cylinder:nan", "wedge:0", "wedge:90"})
    refuses(std::string("contact --width-m 1e-3 --indenter ").append(text), "--indenter");
  refuses("contact --width-m 1e-3", "--indenter");
  refuses("contact --width-m 1e-3 --indenter no/such.csv", "no/such.csv");
  refuses("contact --width-m 1e-3 --indenter cube",
          "\"cube\" is neither flat, cylinder:RADIUS_M, wedge:HALF_ANGLE_DEG");
}

TEST(ContactCommand, RefusesOptionsThatDoNotGoTogether) {
  refuses(flat("--width-m 1e-3 --tangential-n-per-m 1"), "--regime stick");
  for (const char* regime : {"frictionless", "stick"})
    refuses(flat("--width-m 1e-3 --friction 0.5 --regime ") + regime,
            "--friction goes with --regime sliding");
  for (const char* option : {"--cutoff 0.1", "--harmonics 300", "--window half", "--rows gauss"})
    refuses(flat("--width-m 1e-3 ") + option, "goes with --method paper");
  refuses(flat("--width-m 1e-3 --regime glued"), "--regime");
  refuses(flat("--width-m 1e-3 --friction 11"), "friction");
  for (const char* option : {"--points 3", "--at-deg 1"})
    refuses(flat("--width-m 1e-3 --summary ") + option, "excludes");
  refuses(flat("--width-m 1e-3 --points 0"), "--points");
  refuses(flat("--width-m 1e-3 --at-deg 181"), "--at-deg");
  refuses(flat("--width-m 1e-3 --centre-deg 181"), "--centre-deg");
  refuses(flat("--width-m 1e-3 --at-deg 1,,2"), "--at-deg: an item of ");
}

TEST(ContactCommand, ALoadThatIsTooMuchFails) {
  const Run run = runProgram(flat("--load-n-per-m 1e9 --summary"));
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("half the surface", run.err.c_str());
}
