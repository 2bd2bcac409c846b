#include <CppUTest/TestHarness.h>

#include <fmt/format.h>

#include <string>

#include "tests/commands/program.hpp"

using namespace strainfinger;

TEST_GROUP(Plot) {
  static constexpr const char* kTouch =
      "(10.000000) can0 185#E8032201808161A3\n(12.500000) can0 185#E8032201808161A3\n"
      "(12.500000) can0 285#22011EFF070981A3\n(12.500000) can0 385#F8079600110181A3\n";

  static Run inFolder(const std::string& commands, const std::string& input) {
    return runShell(
        "folder=$(mktemp -d); cat >$folder/x.log; cd $folder; trap 'rm -rf $folder' EXIT\n" + commands,
        input);
  }
};

TEST(Plot, DrawsALog) {
  const Run run = inFolder(
      "\"$STRAINFINGER\" plot x.log -o a.png && \"$STRAINFINGER\" plot - -o b.svg <x.log && head -c 4 a.png "
      "| tail -c 3\n"
      "grep -c '<svg' b.svg; tail -n 1 a-force.csv; ls",
      kTouch);
  STRCMP_EQUAL(
      "PNG1\n2.5,0.29,0.2865,0.2935,-0.226,-0.2305,-0.2215\na-angle.csv\na-flags.csv\na-force.csv\na-width."
      "csv\na.gp\na.png\nb-angle.csv\nb-flags.csv\n"
      "b-force.csv\nb-width.csv\nb.gp\nb.svg\nx.log\n",
      run.out.c_str());
  STRCMP_EQUAL("", run.err.c_str());
}

TEST(Plot, OfALogATimeIsDrawnWithTheTimesOfTheWhole) {
  const Run late =
      inFolder("\"$STRAINFINGER\" plot x.log --from +1 -o a.png && cut -d, -f1 a-angle.csv", kTouch);
  STRCMP_CONTAINS("2.5\n", late.out.c_str());
  CHECK(late.out.find("0\n") == std::string::npos);
  const Run none = inFolder("\"$STRAINFINGER\" plot x.log --from 13 -o a.png", kTouch);
  LONGS_EQUAL(1, none.status);
  STRCMP_CONTAINS("x.log: no touch from --from to --to in it to draw", none.err.c_str());
}

TEST(Plot, OfALogThatWasCutOffTheRestIsDrawn) {
  const std::string log = std::string(kTouch) + "(13.000000) can0 185#E803220";
  const Run run =
      inFolder("\"$STRAINFINGER\" plot x.log -o a.png && tail -n 1 a-force.csv | cut -c 1-5", log);
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL("2.5,0\n", run.out.c_str());
  STRCMP_EQUAL("plot: warning: x.log:5: the log breaks off in this line, which is left out\n",
               run.err.c_str());
}

TEST(Plot, WhatIsNoLogIsNoneThatWasCutOff) {
  const Run run = inFolder("\"$STRAINFINGER\" plot x.log -o a.png", "rubbish");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("x.log:1:8: ", run.err.c_str());
}

TEST(Plot, OfSeveralFingersOneIsChosen) {
  std::string log = kTouch;
  for (const char* line :
       {"(13.000000) can0 182#E8032201808161A3\n", "(13.000000) can0 282#22011EFF070981A3\n",
        "(13.000000) can0 382#F8079600110181A3\n"})
    log += line;
  const Run both = inFolder("\"$STRAINFINGER\" plot x.log -o a.png; status=$?; ls; exit $status", log);
  LONGS_EQUAL(2, both.status);
  STRCMP_EQUAL("x.log\n", both.out.c_str());
  STRCMP_CONTAINS("several fingers (can0 node 2, can0 node 5): choose one with --node", both.err.c_str());
  LONGS_EQUAL(0, inFolder("\"$STRAINFINGER\" plot x.log -o a.png -n 2", log).status);
}

TEST(Plot, OfOneNodeOnSeveralInterfacesOneIsChosen) {
  std::string log = kTouch, other = kTouch;
  for (auto at = other.find("can0"); at != std::string::npos; at = other.find("can0", at))
    other[at + 3] = '1';
  const Run both = inFolder("\"$STRAINFINGER\" plot x.log -o a.png -n 5", log + other);
  LONGS_EQUAL(2, both.status);
  STRCMP_CONTAINS("several fingers (can0 node 5, can1 node 5): choose one with --interface",
                  both.err.c_str());
  const Run one =
      inFolder("\"$STRAINFINGER\" plot x.log -o a.svg --interface can1 && grep -c can1 a.gp", log + other);
  STRCMP_EQUAL("1\n", one.out.c_str());
  const Run none = inFolder("\"$STRAINFINGER\" plot x.log -o a.svg --interface can2", log);
  LONGS_EQUAL(1, none.status);
  STRCMP_CONTAINS("x.log: no touch of can2 in it to draw", none.err.c_str());
}

TEST(Plot, WarnsOfTwoFingersOfOneNumber) {
  std::string log;
  for (int i = 0; i < 40; ++i)
    for (const int sequence : {i, i + 100})
      for (const char* frame : {"185#E803220180816100", "285#22011EFF07098100", "385#F807960011018100"})
        log += fmt::format("(10.{:06}) can0 {:.18}{:02X}\n", i * 1000, frame, sequence);
  const Run run = inFolder("\"$STRAINFINGER\" plot x.log -o a.svg", log);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("plot: warning: x.log: can0 node 5: two fingers have this node number", run.err.c_str());
}

TEST(Plot, OfAnotherProtocolNothingIsDrawn) {
  for (const char* touch : {kTouch, ""}) {
    const Run run = inFolder("\"$STRAINFINGER\" plot x.log -o a.svg; status=$?; ls; exit $status",
                             std::string(touch) + "(13.000000) can0 705#4200004D0E1900A7\n");
    LONGS_EQUAL(5, run.status);
    STRCMP_CONTAINS("can0 node 5 speaks protocol 4, this program 2", run.err.c_str());
    STRCMP_EQUAL("x.log\n", run.out.c_str());
  }
}

TEST(Plot, SaysWhatItCannotDraw) {
  const Run empty =
      inFolder("\"$STRAINFINGER\" plot x.log -o a.png", "(1.000000) can0 705#2200004D0E1900A7\n");
  LONGS_EQUAL(1, empty.status);
  STRCMP_CONTAINS("x.log: no touch in it to draw", empty.err.c_str());
  const Run unreadable = inFolder("\"$STRAINFINGER\" plot x.log -o a.png", "rubbish\n");
  LONGS_EQUAL(1, unreadable.status);
  STRCMP_CONTAINS("x.log:1:8: ", unreadable.err.c_str());
  const Run another =
      inFolder("\"$STRAINFINGER\" plot x.log -o a.png -n 5", "(1.000000) can0 705#2200004D0E1900A7\n");
  STRCMP_CONTAINS("x.log: no touch of node 5 in it to draw", another.err.c_str());
  checkRefused("plot x.log -o a.pdf", "pictures are .svg or .png");
  checkRefused("plot x.log -o a.png -c /nowhere.toml", "/nowhere.toml");
  const Run nowhere = inFolder("\"$STRAINFINGER\" plot x.log -o none/a.png", "rubbish\n");
  LONGS_EQUAL(1, nowhere.status);
  STRCMP_CONTAINS("--output none/a.png: there is no folder", nowhere.err.c_str());
}

TEST(Plot, DrawsSomeOfTheTouchesOfALongLog) {
  std::string log;
  for (int i = 0; i < 20'000; ++i) log += kTouch;
  const Run run = inFolder("\"$STRAINFINGER\" plot x.log -o a.svg; grep -c . a-width.csv", log);
  LONGS_EQUAL(0, run.status);
  CHECK_TRUE(std::stoi(run.out) > 4000 && std::stoi(run.out) <= 8001);
}
