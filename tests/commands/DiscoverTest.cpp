// `discover` and `info`, of a finger that runs beside them.
#include <CppUTest/TestHarness.h>

#include <string>

#include "tests/commands/with_finger.hpp"

using namespace strainfinger;

namespace {

/// A HEARTBEAT of protocol 3.
constexpr const char* kForeign = "(1.000000) can0 701#39FFFFFFFFFFFF00\n";

}  // namespace

TEST_GROUP(DiscoverCommand) {};

TEST(DiscoverCommand, HasARowForEachFinger) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" discover --can $BUS | sed "s/$BUS/BUS/; s/,power_on,[0-9]*,[0-9A-F][0-9A-F],/,power_on,UP,CRC,/; s/,samples,/,,/")");
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "interface,node,state,faults,protocol,firmware,board,reset_cause,uptime_s,table_crc,note\n"
      "BUS,1,run,,2,0.1,0,power_on,UP,CRC,\n",
      run.out.c_str());
}

TEST(DiscoverCommand, AnotherProtocolIsTold) {
  const Run run = whileHearing(kForeign, "discover --duration 1 --json");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS(
      R"(,"node":1,"state":null,"faults":null,"protocol":3,"firmware":null,"board":null,"reset_cause":null,"uptime_s":null,"table_crc":null,"note":"speaks protocol 3, this program 2: use the strainfinger of its firmware"}
)",
      run.out.c_str());
}

TEST(DiscoverCommand, NobodyThereIsTold) {
  const Run run = runProgram("discover --can udp:19986 --duration 0.2");
  LONGS_EQUAL(4, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  STRCMP_CONTAINS("no finger heard on udp:19986 in 0.2 s: `strainfinger doctor --can udp:19986`",
                  run.err.c_str());
}

TEST(DiscoverCommand, AFingerThatIsExpectedAndNotThereIsAFailure) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" discover --can $BUS --duration 1 --expect 1 >/dev/null; echo $?
"$STRAINFINGER" discover --can $BUS --duration 1 --expect 1,2,3 | wc -l; echo ${PIPESTATUS[0]}
"$STRAINFINGER" doctor --can $BUS --duration 1 --expect 1,7 | grep -- '--expect'; echo ${PIPESTATUS[0]})");
  STRCMP_EQUAL("0\n2\n4\nerror    --expect: node 7 is not heard\n4\n", run.out.c_str());
  STRCMP_CONTAINS("discover: not heard: node 2, 3 (--expect)", run.err.c_str());
}

TEST(DiscoverCommand, WithoutABusEveryInterfaceThatIsUpIsListenedTo) {
  const Run none = runShell(interfacesAre(R"([{"ifname":"can7","flags":[],"link_type":"can"}])") +
                            "\"$STRAINFINGER\" discover");
  LONGS_EQUAL(3, none.status);
  STRCMP_CONTAINS("no CAN interface of this machine is up", none.err.c_str());
  // That there is no such interface is the kernel's word: it was tried.
  const Run up = runShell(interfacesAre(R"([{"ifname":"nocan7","flags":["UP"],"link_type":"can"}])") +
                          "\"$STRAINFINGER\" discover");
  LONGS_EQUAL(3, up.status);
  STRCMP_CONTAINS("nocan7", up.err.c_str());
}

TEST(DiscoverCommand, IsInterrupted) {
  const Run run =
      runShell(R"("$STRAINFINGER" discover --can udp:19985 --duration 60 & interrupt $!; wait $!)");
  LONGS_EQUAL(130, run.status);
  STRCMP_CONTAINS("discover: interrupted", run.err.c_str());
}

TEST(DiscoverCommand, RefusesWhatIsOutsideTheDomain) {
  for (const char* duration : {"0", "-1", "nan", "inf", "x"})
    checkRefused(std::string("discover --can udp:19984 --duration ") + duration, "--duration");
  checkRefused("discover --can loopback", "use udp on both sides");
  checkRefused("discover --can ''", "give the name of a bus");
}

TEST_GROUP(InfoCommand) {};

TEST(InfoCommand, TellsAllThatAFingerSaysOfItself) {
  const Run run = withFinger("", R"("$STRAINFINGER" info --can $BUS | sed "s/$BUS/BUS/")");
  LONGS_EQUAL(0, run.status);
  for (const char* row :
       {"interface,node,frame,field,value,meaning\n", "BUS,1,HEARTBEAT,state,run,What the finger is doing\n",
        "BUS,1,HEARTBEAT,protocol,2,", "BUS,1,HEARTBEAT,temperature_degc,,",
        "BUS,1,INFO,reset_cause,power_on,", "BUS,1,INFO,version_minor,1,", "BUS,1,GAUGES,out_of_use,none,",
        "BUS,1,GAUGES,zero_age_s,", "BUS,1,RESPONSE,erases,0,", "BUS,1,RESPONSE,resynchronised,0,"})
    STRCMP_CONTAINS(row, run.out.c_str());
}

TEST(InfoCommand, OtherTablesThanTheConfigsAreAMismatch) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" info --can $BUS -c <(echo 'schema = 1') >/dev/null && echo its tables
"$STRAINFINGER" info --can $BUS -c <(printf 'schema = 1\n[gauges]\ncount = 18\n') >/dev/null)");
  LONGS_EQUAL(5, run.status);
  STRCMP_EQUAL("its tables\n", run.out.c_str());
  STRCMP_CONTAINS("its tables are not those of the config", run.err.c_str());
}

TEST(InfoCommand, NobodyThereIsTold) {
  const Run run = runProgram("info --can udp:19983 --node 9");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS("udp:19983 node 9: no HEARTBEAT in 2000 ms", run.err.c_str());
  STRCMP_CONTAINS("`strainfinger discover --can udp:19983`", run.err.c_str());
}

TEST(InfoCommand, AFingerThatOnlyTalksIsToldWithoutItsCounts) {
  const Run run = whileHearing(
      "(1.000000) can0 701#2200004D0E1900A7\n(1.100000) can0 481#44030001B62A005C\n"
      "(1.200000) can0 081#200000003D00FE01\n",
      "info");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS(",HEARTBEAT,faults,none,", run.out.c_str());
  STRCMP_CONTAINS(",INFO,crash,hang,", run.out.c_str());
  STRCMP_CONTAINS(",GAUGES,out_of_use,5,", run.out.c_str());
  STRCMP_CONTAINS(",RESPONSE,erases,,", run.out.c_str());
  STRCMP_CONTAINS("it is heard, but answers no request", run.err.c_str());
}

TEST(InfoCommand, AnotherProtocolIsAMismatch) {
  const Run run = whileHearing(kForeign, "info");
  LONGS_EQUAL(5, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  STRCMP_CONTAINS("speaks protocol 3, this program 2", run.err.c_str());
}

TEST(InfoCommand, AFingerInFaultIsToldWithIt) {
  const Run run = whileHearing("(1.000000) can0 701#2301004D0E190000\n(1.100000) can0 481#0100000100000000\n",
                               "info -c <(echo 'schema = 1')");
  STRCMP_CONTAINS(",HEARTBEAT,faults,tables,", run.out.c_str());
  STRCMP_CONTAINS(",RESPONSE,erases,,", run.out.c_str());
  STRCMP_CONTAINS("fault tables: ", run.err.c_str());
  CHECK_TRUE(run.err.find("of the config") == std::string::npos);
}

// One HEARTBEAT, two seconds ago.
TEST(InfoCommand, AFingerThatFellSilentIsNotPassedOffAsThere) {
  const Run run = whileHearing("(1.000000) can0 701#2200004D0E1900A7\n", "info");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS(",HEARTBEAT,state,run,", run.out.c_str());
  STRCMP_CONTAINS("node 1: silent for ", run.err.c_str());
}

TEST(InfoCommand, IsInterrupted) {
  const Run run = runShell(R"("$STRAINFINGER" info --can udp:19975 & interrupt $!; wait $!)");
  LONGS_EQUAL(130, run.status);
}

TEST(InfoCommand, NeedsABusAndANodeThatThereCanBe) {
  checkRefused("info", "--can");
  checkRefused("info --can udp:19980 --node 0", "--node");
  checkRefused("info --can udp:19980 --node 64", "--node");
}
