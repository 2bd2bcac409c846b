#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <string>

#include "tests/commands/program.hpp"

using namespace strainfinger;

TEST_GROUP(ExplainCommand){};

TEST(ExplainCommand, SaysWhatANameMeansAndWhatToDo) {
  const Run run = runProgram("explain stale_zero");
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "stale_zero: bit 5 of flags in CONTACT, FORCE, PATCH, CONTACT2, FORCE2\n"
      "    The zero of the gauges is too old to be trusted\n"
      "    What to do: let go of it; if nothing touches it, `strainfinger tare`\n",
      run.out.c_str());
  STRCMP_EQUAL(run.out.c_str(), runProgram("explain stale zero").out.c_str());
}

TEST(ExplainCommand, TakesSeveralNames) {
  const Run run = runProgram("explain noisy ANGLE_DEG");
  STRCMP_CONTAINS("noisy: bit 8 of faults in HEARTBEAT\n", run.out.c_str());
  STRCMP_CONTAINS("angle_deg: field [deg] in CONTACT, CONTACT2\n", run.out.c_str());
}

// The bytes are those that BUS.md explains.
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
  STRCMP_CONTAINS("        What to do: make them", run.out.c_str());
}

TEST(ExplainCommand, ReadsAnyLineOfCandump) {
  const std::string frame = runProgram("explain 185#E8032201808161A3").out;
  for (const char* line :
       {"'(1609779922.655421) can0 185#E8032201808161A3'",
        "'(1609779922.655421)' can0 '185#E8032201808161A3'", "'  can0  185   [8]  E8 03 22 01 80 81 61 A3'"})
    STRCMP_EQUAL(frame.c_str(), runProgram(std::string("explain ") + line).out.c_str());
}

TEST(ExplainCommand, JsonHasAnObjectANameOrAField) {
  STRCMP_EQUAL(
      "{\"name\":\"crash\",\"kind\":\"field in INFO\",\"meaning\":\"What the run before this one died "
      "of\",\"remedy\":\"\"}\n",
      runProgram("explain --json crash").out.c_str());
  const std::string request = runProgram("explain --json 605#0302C80000000000").out;
  STRCMP_EQUAL(
      "{\"frame\":\"REQUEST\",\"node\":5,\"field\":\"command\",\"value\":\"contact_rate\",\"meaning\":\"What "
      "to do\"}\n"
      "{\"frame\":\"REQUEST\",\"node\":5,\"field\":\"argument\",\"value\":200,\"meaning\":\"Of the command; "
      "what length leaves out is 0\"}\n",
      request.c_str());
}

TEST(ExplainCommand, ListsEveryNameWithoutOne) {
  const Run run = runProgram("explain --json");
  LONGS_EQUAL(0, run.status);
  CHECK_TRUE(std::ranges::count(run.out, '\n') > 100);
  STRCMP_EQUAL("", run.err.c_str());
}

TEST(ExplainCommand, RefusesWhatIsNoNameAndNoFrameOfAFinger) {
  checkRefused("explain uncertian", "uncertian is no name on the bus (did you mean uncertain?)");
  checkRefused("explain xylophone", "xylophone is no name on the bus; `strainfinger explain` lists them");
  checkRefused("explain noisy xylophone", "xylophone");
  checkRefused("explain 123#00", "identifier 0x123, 1 bytes");
  checkRefused("explain 181#0000", "identifier 0x181, 2 bytes: CONTACT has 8 bytes");
  checkRefused("explain 12345678#0000", "none of a finger's frames");
  checkRefused("explain 601#0117", "identifier 0x601");
}
