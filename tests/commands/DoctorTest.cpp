#include <CppUTest/TestHarness.h>

#include <string>

#include "tests/commands/with_finger.hpp"

using namespace strainfinger;

TEST_GROUP(DoctorCommand) {};

// A machine that is late loses sample sets, which is a warning.
TEST(DoctorCommand, FindsNoErrorInAFingerThatIsWell) {
  const Run run =
      withFinger("", R"("$STRAINFINGER" doctor --can $BUS -c <(echo 'schema = 1') | sed "s/$BUS/BUS/")");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("ok       BUS: fingers: 1, ", run.out.c_str());
  STRCMP_CONTAINS(" BUS node 1: ", run.out.c_str());
  CHECK_TEXT(run.out.find("error ") == std::string::npos, run.out.c_str());
  STRCMP_CONTAINS("doctor: errors: 0, ", run.err.c_str());
}

TEST(DoctorCommand, SaysWhatIsWrongAndWhatToDo) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" doctor --can $BUS --json -c <(printf 'schema = 1\n[gauges]\ncount = 18\n') | grep '"error"' | sed "s/$BUS/BUS/"
)");
  LONGS_EQUAL(5, run.status);
  STRCMP_CONTAINS(
      "{\"result\":\"error\",\"where\":\"BUS node 1\",\"finding\":\"its tables are not those of the config",
      run.out.c_str());
  STRCMP_CONTAINS("\"remedy\":\"give the config that its tables were made from", run.out.c_str());
  STRCMP_CONTAINS("doctor: errors: 1, ", run.err.c_str());
}

TEST(DoctorCommand, TheConfigsNodeIsMissed) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" doctor --can $BUS -c <(printf 'schema = 1\n[can]\nnode = 9\n'))");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS("error    config: its node 9 (can.node) is not heard\n", run.out.c_str());
}

TEST(DoctorCommand, TwoFingersOfOneNumberAreFound) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" run --can $BUS --duration 20 --seed 2 2>/dev/null & second=$!
"$STRAINFINGER" doctor --can $BUS --duration 4; status=$?
kill -INT $second; wait $second; (exit $status))");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("node 1: two fingers have this node number", run.out.c_str());
}

TEST(DoctorCommand, AFingerThatSendsRawIsToldAndCanBeStopped) {
  const Run run = withFinger("", R"("$STRAINFINGER" strains --can $BUS >/dev/null & strains=$!
listening $strains; sleep 0.5; kill -KILL $strains; wait $strains
"$STRAINFINGER" doctor --can $BUS --duration 1.5 | grep -c '(RAW)'
"$STRAINFINGER" strains --can $BUS -n 1 --rows 1 >/dev/null
"$STRAINFINGER" doctor --can $BUS --duration 1.5 | grep -c '(RAW)')");
  STRCMP_EQUAL("1\n0\n", run.out.c_str());
}

TEST(DoctorCommand, ASilentBusIsNoNode) {
  const Run run = runProgram("doctor --can udp:19979 --duration 1");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS("error    udp:19979: no finger heard in 1.0 s, and nothing else\n", run.out.c_str());
  STRCMP_CONTAINS("strainfinger run --can udp:19979", run.out.c_str());
}

TEST(DoctorCommand, LooksAtEveryInterfaceOfTheMachine) {
  const std::string two = interfacesAre(
      R"([{"ifname":"nocan7","flags":[],"link_type":"can","linkinfo":{"info_data":{"state":"STOPPED"}}},
{"ifname":"nocan8","flags":["UP"],"link_type":"can","linkinfo":{"info_data":{"state":"ERROR-ACTIVE","bittiming":{"bitrate":500000}}}}])");
  const Run run = runShell(two + "\"$STRAINFINGER\" doctor");
  LONGS_EQUAL(3, run.status);
  STRCMP_CONTAINS("warning  nocan7: down\n", run.out.c_str());
  STRCMP_CONTAINS("sudo ip link set nocan7 up type can bitrate 1000000", run.out.c_str());
  STRCMP_CONTAINS("ok       nocan8: up, ERROR-ACTIVE, 500000 bit/s\n", run.out.c_str());
  const Run config = runShell(two + "\"$STRAINFINGER\" doctor -c <(echo 'schema = 1')");
  STRCMP_CONTAINS("error    nocan8: 500000 bit/s; the config's can.bitrate is 1000000\n", config.out.c_str());
  // And nocan8, which there isn't, is opened.
  const Run one = runShell(two + "\"$STRAINFINGER\" doctor --can nocan8");
  STRCMP_CONTAINS("nocan8", one.out.c_str());
  CHECK_TRUE(one.out.find("nocan7") == std::string::npos);
}

TEST(DoctorCommand, AMachineWithoutCanIsTold) {
  const Run run = runShell(interfacesAre("[]") + "\"$STRAINFINGER\" doctor");
  LONGS_EQUAL(3, run.status);
  STRCMP_CONTAINS("error    this machine: there is no CAN interface\n", run.out.c_str());
  STRCMP_CONTAINS("--can udp", run.out.c_str());
}

TEST(DoctorCommand, WithoutIpItGoesOn) {
  const Run run = runShell(interfacesAre("") + "\"$STRAINFINGER\" doctor --can nocan7");
  LONGS_EQUAL(3, run.status);
  STRCMP_CONTAINS("warning  this machine: `ip -details -json link show` prints something unknown",
                  run.out.c_str());
  STRCMP_CONTAINS("error    nocan7: ", run.out.c_str());
  // But it doesn't know where to look.
  const Run nowhere = runShell(interfacesAre("") + "\"$STRAINFINGER\" doctor");
  LONGS_EQUAL(1, nowhere.status);
  STRCMP_CONTAINS("error    this machine: ", nowhere.out.c_str());
  const Run none = runShell("PATH=/nowhere \"$STRAINFINGER\" doctor");
  LONGS_EQUAL(1, none.status);
  STRCMP_CONTAINS("name the bus with --can: ip is not installed: apt install iproute2", none.out.c_str());
  const Run failed = runShell(interfacesAre("") +
                              "printf '#!/bin/sh\\necho no netlink >&2; exit 2' >$tools/ip\n"
                              "\"$STRAINFINGER\" doctor");
  LONGS_EQUAL(1, failed.status);
  STRCMP_CONTAINS("ip -details -json link show failed:\nno netlink\n", failed.out.c_str());
}

TEST(DoctorCommand, IsInterrupted) {
  const Run run = runShell(R"("$STRAINFINGER" doctor --can udp:19978 --duration 60 & interrupt $!; wait $!)");
  LONGS_EQUAL(130, run.status);
}

TEST(DoctorCommand, RefusesWhatIsOutsideTheDomain) {
  checkRefused("doctor --can loopback", "use udp on both sides");
  checkRefused("doctor --duration 0", "--duration");
}
