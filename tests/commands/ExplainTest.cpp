#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>

#include "tests/commands/program.hpp"

using namespace strainfinger;

TEST_GROUP(ExplainCommand) {};

TEST(ExplainCommand, SaysWhatANameMeansAndWhatToDo) {
  const Run run = runProgram("explain stale_zero");
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "stale_zero: bit 5 of flags in CONTACT, FORCE, PATCH, CONTACT2, FORCE2\n"
      "    The zero of the gauges is too old to be trusted\n"
      "    What to do: let go of it; if nothing touches it, `strainfinger tare --can BUS -n N --force`\n",
      run.out.c_str());
  STRCMP_EQUAL(run.out.c_str(), runProgram("explain stale zero").out.c_str());
}

TEST(ExplainCommand, TakesSeveralNames) {
  const Run run = runProgram("explain noisy ANGLE_DEG");
  STRCMP_CONTAINS("noisy: bit 8 of faults in HEARTBEAT\n", run.out.c_str());
  STRCMP_CONTAINS("angle_deg: field [deg] in CONTACT, CONTACT2\n", run.out.c_str());
}

// The bytes are those that BUS_TOUCHES.md explains.
TEST(ExplainCommand, SaysWhatAFrameSays) {
  const Run run = runProgram("explain 185#E8032201808161A3");
  LONGS_EQUAL(0, run.status);
  for (const char* part :
       {"CONTACT of node 5 (0x185): ", "angle_deg        10     ", "sigma_angle_deg  2.9 ",
        "alternative_deg  ?  ", "flags            contact+simulated  ",
        "        contact: Something touches the finger\n", "quality_percent  97 ", "sequence         163 "})
    STRCMP_CONTAINS(part, run.out.c_str());
}

TEST(ExplainCommand, SaysWhatToDoAboutWhatAFrameSays) {
  const Run run = runProgram("explain 705#220100FFFF80FF00");
  STRCMP_CONTAINS("        tables: The lookup tables are absent", run.out.c_str());
  STRCMP_CONTAINS("        What to do: `strainfinger push --can BUS -n N -c FINGER.toml`", run.out.c_str());
}

TEST(ExplainCommand, ReadsAnyLineOfCandump) {
  const std::string frame = runProgram("explain 185#E8032201808161A3").out;
  for (const char* line :
       {"'(1609779922.655421) can0 185#E8032201808161A3'",
        "'(1609779922.655421)' can0 '185#E8032201808161A3'", "'  can0  185   [8]  E8 03 22 01 80 81 61 A3'"})
    STRCMP_EQUAL(frame.c_str(), runProgram(std::string("explain ") + line).out.c_str());
}

TEST(ExplainCommand, ReadsALineOfTheScreenWithoutQuotes) {
  const std::string frame = runProgram("explain 185#E8032201808161A3").out;
  for (const char* line : {"can0 185 [8] E8 03 22 01 80 81 61 A3", "185 [8] E8 03 22 01 80 81 61 A3",
                           "'185#E8032201808161A3 '", "'(000.000213)' can0 185 [8] E8 03 22 01 80 81 61 A3"})
    STRCMP_EQUAL(frame.c_str(), runProgram(std::string("explain ") + line).out.c_str());
}

TEST(ExplainCommand, TakesSeveralFrames) {
  const Run run = runProgram("explain 181#E2270200808164FF 281#45029F000F0581FF");
  STRCMP_CONTAINS("CONTACT of node 1", run.out.c_str());
  STRCMP_CONTAINS("FORCE of node 1", run.out.c_str());
}

TEST(ExplainCommand, AValueAtTheEndOfItsRangeSaysOnWhichSideTheTrueOneIs) {
  const std::string least = runProgram("explain --json 281#E803018000000000").out;
  STRCMP_CONTAINS("-32.767", least.c_str());
  STRCMP_CONTAINS("this value or less", least.c_str());
  STRCMP_CONTAINS("this value or more", runProgram("explain --json 281#E803FF7F00000000").out.c_str());
}

TEST(ExplainCommand, TakesNamesAsOtherCommandsJoinThem) {
  const Run run = runProgram("explain contact+uncertain noisy,");
  LONGS_EQUAL(0, run.status);
  for (const char* name : {"CONTACT: frame", "contact: bit 0", "uncertain: bit 3", "noisy: bit 8"})
    STRCMP_CONTAINS(name, run.out.c_str());
}

TEST(ExplainCommand, AHeartbeatOfAnotherProtocolIsWarnedOf) {
  const Run run = runProgram("explain 705#3200000D0E1900A7");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("warning: it speaks protocol 3", run.err.c_str());
}

TEST(ExplainCommand, JsonHasAnObjectANameAFieldOrAFlag) {
  STRCMP_EQUAL(
      R"({"name":"crash","kind":"field in INFO","meaning":"What the run before this one died of","remedy":""}
)",
      runProgram("explain --json crash").out.c_str());
  STRCMP_EQUAL(
      R"({"frame":"REQUEST","node":5,"field":"command","value":"contact_rate","meaning":"What to do","remedy":""}
{"frame":"REQUEST","node":5,"field":"command","value":"contact_rate","meaning":"Send at most so many CONTACT a second, until the next start","remedy":""}
{"frame":"REQUEST","node":5,"field":"argument","value":200,"meaning":"Of the command; what length leaves out is 0","remedy":""}
{"frame":"REQUEST","node":5,"field":"word","value":null,"meaning":"Four bytes of the tables; what length leaves out is 0","remedy":""}
)",
      runProgram("explain --json 605#0302C80000000000").out.c_str());
  STRCMP_CONTAINS(
      R"("field":"faults","value":"tables","meaning":"The lookup tables are absent, damaged or of another finger","remedy":"`strainfinger push --can BUS -n N -c FINGER.toml`)",
      runProgram("explain --json 705#220100FFFF80FF00").out.c_str());
}

TEST(ExplainCommand, ListsEveryNameWithoutOne) {
  const Run run = runProgram("explain --json");
  LONGS_EQUAL(0, run.status);
  CHECK_TRUE(std::ranges::count(run.out, '\n') > 100);
  STRCMP_EQUAL("", run.err.c_str());
}

TEST(ExplainCommand, RefusesWhatIsNoNameAndNoFrameOfAFinger) {
  checkRefused("explain uncertian", "'uncertian' is no name on the bus (did you mean uncertain?)");
  checkRefused("explain xylophone", "'xylophone' is no name on the bus; `strainfinger explain` lists them");
  checkRefused("explain noisy xylophone", "xylophone");
  checkRefused("explain ''", "'' is no name");
  checkRefused("explain 123#00", "none of a finger's frames: identifier 0x123");
  checkRefused("explain 181#0000", "CONTACT has 8 bytes, not 2");
  checkRefused("explain 401#00", "RAW has 8 bytes, not 1");
  checkRefused("explain 601#0117", "no REQUEST that there is");
  checkRefused("explain 12345678#0000", "its identifier has 29 bits");
  checkRefused("explain 181##1E227", "it is of CAN FD");
  checkRefused("explain 181#R", "it is a remote request");
  checkRefused("explain 20000004#0000000000000000", "it is an error frame");
  checkRefused("explain 181#E22702008080F", "'181#E22702008080F' is no frame: ");
  checkRefused("explain -c /nowhere.toml noisy", "/nowhere.toml");
  checkRefused("explain 181#E2270200808164FF 181#00", "CONTACT has 8 bytes");
}
