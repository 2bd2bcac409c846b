// `strains`, from a finger that runs beside it on a bus between programs.
#include <CppUTest/TestHarness.h>
#include <string>

#include "tests/commands/with_finger.hpp"

using namespace strainfinger;

TEST_GROUP(StrainsCommand) {};

TEST(StrainsCommand, PrintsRowsThatLocateTakes) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" strains --can $BUS --rate 50 --duration 1.5 >strains.$$.csv || exit
head -1 strains.$$.csv
wc -l <strains.$$.csv
"$STRAINFINGER" locate <strains.$$.csv | head -1
"$STRAINFINGER" shape <strains.$$.csv | wc -l
rm strains.$$.csv)");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("time_s,strain_0,strain_1,", run.out.c_str());
  STRCMP_CONTAINS("\ntime_s,contact,angle_deg,", run.out.c_str());
  STRCMP_CONTAINS(" sets, 0 incomplete", run.err.c_str());
}

TEST(StrainsCommand, JsonHasTheTimeAsANumber) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" strains --can $BUS --rate 100 --rows 1 --json)");
  LONGS_EQUAL(0, run.status);
  const std::string key = "{\"time_s\":";
  STRCMP_EQUAL(key.c_str(), run.out.substr(0, key.size()).c_str());
  CHECK_TRUE(std::stod(run.out.substr(key.size())) > 1.6e9);
}

TEST(StrainsCommand, AConfigThatIsNotTheFingersIsNamed) {
  const Run run = withFinger("", R"(
printf 'schema = 1\n[gauges]\nfull_scale_strain = 0.015\n' >half.$$.toml
printf 'schema = 1\n' >own.$$.toml
"$STRAINFINGER" strains --can $BUS --duration 0.5 -c half.$$.toml >strains.$$.csv && echo taken
"$STRAINFINGER" strains --can $BUS --duration 0.5 -c own.$$.toml >strains.$$.csv
rm half.$$.toml own.$$.toml strains.$$.csv)");
  STRCMP_CONTAINS("taken", run.out.c_str());
  const std::string said = "the finger's tables are not those of half.";
  STRCMP_CONTAINS(said.c_str(), run.err.c_str());
  STRCMP_CONTAINS("gauges.full_scale_strain", run.err.c_str());
  CHECK_EQUAL(std::string::npos, run.err.find("those of own."));
}

TEST(StrainsCommand, EndsWithItsLastRow) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" strains --can $BUS --rate 100 --rows 7 | wc -l)");
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL("8\n", run.out.c_str());
  STRCMP_CONTAINS("strains: 7 sets, 0 incomplete", run.err.c_str());
}

TEST(StrainsCommand, ARowIsThereWhenItHasCome) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" strains --can $BUS --rate 20 >strains.$$.csv & strains=$!
listening $strains; sleep 1; kill -9 $strains; wait $strains
awk -F, 'NF != 17 { print "half a row" } END { print (NR > 5 ? "rows" : "no rows") }' strains.$$.csv
tail -c 1 strains.$$.csv | wc -l
rm strains.$$.csv)");
  STRCMP_EQUAL("rows\n1\n", run.out.c_str());
}

namespace {

/// In a script: says whether HEARTBEATs, and whether RAW, come.
const std::string kListen = R"(listen() { /usr/bin/python3 - $BUS <<'END'
import socket, sys, time
group = "239.255.67.65"
bus = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
bus.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
bus.bind((group, int(sys.argv[1][4:])))
bus.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + socket.inet_aton("127.0.0.1"))
end, functions = time.monotonic() + 0.5, set()
while time.monotonic() < end:
    functions.add(int.from_bytes(bus.recv(16)[1:3], "big") & 0x780)
print(0x700 in functions, 0x400 in functions)
END
}
)";

}  // namespace

TEST(StrainsCommand, TheFingerSendsNoMoreWhenItEnds) {
  const Run run = withFinger("", kListen + R"(
"$STRAINFINGER" strains --can $BUS --rate 100 --duration 0.5 >/dev/null || exit
listen)");
  STRCMP_EQUAL("True False\n", run.out.c_str());
}

TEST(StrainsCommand, TheFingerSendsNoMoreWhenTheTerminalIsClosed) {
  const Run run = withFinger("", kListen + R"(
env --default-signal=HUP "$STRAINFINGER" strains --can $BUS --rate 100 >/dev/null & strains=$!
listening $strains; sleep 0.5; listen; kill -HUP $strains; wait $strains; echo $?
listen)");
  STRCMP_EQUAL("True True\n130\nTrue False\n", run.out.c_str());
}

TEST(StrainsCommand, TheFingerSendsNoMoreWhenTheReaderLeaves) {
  const Run run = withFinger("", kListen + R"(
"$STRAINFINGER" strains --can $BUS --rate 500 | head -1 >/dev/null; echo ${PIPESTATUS[0]}
listen)");
  STRCMP_EQUAL("141\nTrue False\n", run.out.c_str());  // 128 + SIGPIPE, as filters end
  STRCMP_EQUAL("", run.err.c_str());
}

TEST(StrainsCommand, ARateBeyondTheBusIsRefusedWithTheFastest) {
  const Run run = withFinger("-c <(echo -e 'schema = 1\n[can]\nbitrate = 125000\ncontact_rate_hz = 200')",
                             R"("$STRAINFINGER" strains --can $BUS --rate 1000 --duration 1)");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("125 Hz is the fastest (too_fast)", run.err.c_str());
  STRCMP_EQUAL("", run.out.c_str());
}

TEST(StrainsCommand, AnotherRingThanTheConfigsIsTold) {
  for (const std::string duration : {"1", "6"}) {
    const Run run = withFinger("", R"("$STRAINFINGER" strains --can $BUS -c <(echo -e 'schema = 1
[gauges]
count = 24') --duration )" + duration);
    LONGS_EQUAL(5, run.status);
    STRCMP_CONTAINS(
        "no whole set of readings: the config has gauges.count = 24, the finger sends 16: give this "
        "finger's config, -c",
        run.err.c_str());
  }
}

TEST(StrainsCommand, NoReadingsInItsDurationIsNotSuccess) {
  const Run run = withFinger("", R"("$STRAINFINGER" strains --can $BUS --rate 1 --duration 0.01)");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS(" in 0.01 s: is the bus free enough?", run.err.c_str());
}

TEST(StrainsCommand, AFingerThatFallsSilentIsTold) {
  const Run run = runShell(R"(
bus=udp:$((20000 + $$ % 20000))
"$STRAINFINGER" run --can $bus --duration 3 2>&- & finger=$!
until "$STRAINFINGER" discover --can $bus --duration 0.3 >/dev/null 2>&1; do :; done
"$STRAINFINGER" strains --can $bus --rate 50 | wc -l; status=${PIPESTATUS[0]}
wait $finger; exit $status)");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS(" node 1: silent for 3 s after ", run.err.c_str());
  CHECK_COMPARE(std::stoi(run.out), >, 20);
}

TEST(StrainsCommand, AnotherProgramThatEndsTheReadingsIsTold) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" strains --can $BUS --rate 50 >/dev/null & first=$!
listening $first; sleep 0.5
"$STRAINFINGER" strains --can $BUS --rate 50 --rows 5 >/dev/null; wait $first)");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS(
      " sets, though it is alive: another program asked this finger, too (raw): let one at a time",
      run.err.c_str());
  CHECK_TRUE(run.err.find("unplugged") == std::string::npos);
}

TEST(StrainsCommand, AnotherProgramThatMayHaveChangedTheRateIsTold) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" strains --can $BUS --rate 50 --duration 2 >/dev/null & first=$!
listening $first; sleep 0.5
"$STRAINFINGER" strains --can $BUS --rate 50 --rows 5 >/dev/null; wait $first)");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("let one at a time do so: the rate may not be --rate", run.err.c_str());
}

TEST(StrainsCommand, AFingerThatStartedAnewIsToldFromOneThatIsOff) {
  const Run run = runShell(R"(
bus=udp:$((20000 + $$ % 20000))
for seconds in 3 6; do "$STRAINFINGER" run --can $bus --duration $seconds 2>&-; done &
until "$STRAINFINGER" discover --can $bus --duration 0.3 >/dev/null 2>&1; do :; done
"$STRAINFINGER" strains --can $bus --rate 50 >/dev/null; status=$?
wait; exit $status)");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS("though it is alive: it started anew", run.err.c_str());
}

TEST(StrainsCommand, NobodyThereIsTold) {
  const Run run = runProgram("strains --can udp:19998 --duration 1");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS("udp:19998 node 1: no answer", run.err.c_str());
}

TEST(StrainsCommand, IsInterruptedWhileNobodyAnswers) {
  const Run run = runShell(R"("$STRAINFINGER" strains --can udp:19997 & interrupt $!; wait $!)");
  LONGS_EQUAL(130, run.status);
  STRCMP_CONTAINS("udp:19997 node 1: interrupted before it answered", run.err.c_str());
}

TEST(StrainsCommand, ALogHasTheRowsThatWereThere) {
  const Run run = withFinger("", R"(
cd $(mktemp -d); trap 'rm -r $PWD; kill -INT $finger; wait $finger' EXIT
"$STRAINFINGER" record --can $BUS -o x.log 2>/dev/null & recorder=$!; listening $recorder
"$STRAINFINGER" strains --can $BUS --rate 100 --rows 20 >live.csv || exit
sleep 0.4; kill -INT $recorder; wait $recorder
"$STRAINFINGER" strains x.log --rows 20 >log.csv || exit
cut -d, -f2- live.csv >live; cut -d, -f2- log.csv | cmp live - && wc -l <log.csv
sed 's/ udp[^ ]* / can7 /' x.log >y.log
"$STRAINFINGER" strains --rows 20 - y.log <y.log --interface can7 | cmp log.csv - && echo same
head -n 1 log.csv; [ $(sed -n 2p log.csv | cut -d. -f1) -gt 1600000000 ] && echo since 1970)");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("21\nsame\ntime_s,strain_0,strain_1,", run.out.c_str());
  STRCMP_CONTAINS("\nsince 1970\n", run.out.c_str());
  STRCMP_CONTAINS("strains: 20 sets, 0 incomplete, ", run.err.c_str());
}

namespace {

/// Zeros and two sample sets of a finger of twelve gauges; the first is before the zeros. Of the others gauge
/// 0 is a code above its zero, gauge 3 one below.
std::string logOfTwelve() {
  std::string log;
  for (const std::string page :
       {"0000", "0100", "0200", "0300", "2002", "2102", "2202", "2302", "0003", "0103", "0203", "0303"}) {
    log += "(1.0" + page.substr(2) + "000) can0 401#" + page;
    log += page == "2102" || page == "0003" ? "0180" : "0080";
    log += "00800080\n";
  }
  return log;
}

/// `strains` of that finger's logs.
Run strainsOf(const std::string& arguments, const std::string& log) {
  return runShell(
      "\"$STRAINFINGER\" strains -c <(printf 'schema = 1\\n[gauges]\\ncount = 12\\nfull_scale_strain "
      "= 0.03125\\n') " +
          arguments,
      log);
}

}  // namespace

TEST(StrainsCommand, ALogsStrainsAreThoseOfItsCodesLessItsZeros) {
  const Run run = strainsOf("-", logOfTwelve());
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "time_s,strain_0,strain_1,strain_2,strain_3,strain_4,strain_5,strain_6,strain_7,strain_8,strain_9,"
      "strain_10,strain_11\n"
      "1.003000,9.5367431640625e-07,0,0,-9.5367431640625e-07,0,0,0,0,0,0,0,0\n",
      run.out.c_str());
  STRCMP_CONTAINS("strains: 1 sets, 0 incomplete, 1 before the finger told its zeros\n", run.err.c_str());
  const Run json = strainsOf("- --json", logOfTwelve());
  STRCMP_CONTAINS("{\"time_s\":1.003,\"strain_0\":9.5367431640625e-07,", json.out.c_str());
}

TEST(StrainsCommand, WhatALogLacksIsTold) {
  const Run none = strainsOf("- -n 2", logOfTwelve());
  LONGS_EQUAL(1, none.status);
  STRCMP_CONTAINS("no readings (RAW) of node 2 with their zeros", none.err.c_str());
  const Run ring = runProgram("strains -", logOfTwelve());
  LONGS_EQUAL(5, ring.status);
  STRCMP_CONTAINS("the config has gauges.count = 16, the finger sends 12", ring.err.c_str());
  const Run elsewhere = strainsOf("- --interface can1", logOfTwelve());
  LONGS_EQUAL(1, elsewhere.status);
  STRCMP_CONTAINS("stdin: no frame of can1 in it", elsewhere.err.c_str());
  const Run foreign = strainsOf("-", "(1.000000) can0 701#3200004D0E1900A7\n" + logOfTwelve());
  LONGS_EQUAL(5, foreign.status);
  STRCMP_CONTAINS("-: node 1 speaks protocol 3, this program 2", foreign.err.c_str());
}

TEST(StrainsCommand, RefusesWhatIsOutsideTheDomain) {
  checkRefused("strains x.log --can udp:19998", "either --can, to ask a finger, or FILE");
  checkRefused("strains x.log --rate 10", "--rate and --duration go with --can");
  for (const char* option : {"--interface can0", "--from 1", "--to 2"})
    checkRefused(std::string("strains --can udp:19998 ") + option,
                 "--interface, --from and --to go with FILE");
  checkRefused("strains", "--can");
  checkRefused("strains --can udp:19998 --rate 0", "--rate");
  checkRefused("strains --can udp:19998 --rate 1001", "--rate");
  for (const std::string rows : {"0", "-1", "1.5", "x"})
    checkRefused("strains --can udp:19998 --rows " + rows, "--rows");
  for (const std::string duration : {"0", "-1", "nan", "inf"})
    checkRefused("strains --can udp:19998 --duration " + duration, "--duration");
  checkRefused("strains --can loopback", "use udp on both sides");
}
