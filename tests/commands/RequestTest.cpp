// `tare` and `config` as far as they go without CAN; with it: tests/vcan/scenarios.
#include <CppUTest/TestHarness.h>

#include <string>

#include "tests/commands/with_finger.hpp"

using namespace strainfinger;

TEST_GROUP(RequestCommands) {
  static void checkRefused(const std::string& arguments, int status, const char* message) {
    const Run run = runProgram(arguments);
    LONGS_EQUAL(status, run.status);
    STRCMP_CONTAINS(message, run.err.c_str());
    STRCMP_EQUAL("", run.out.c_str());
  }
};

TEST(RequestCommands, NeedAnInterface) {
  checkRefused("tare", 2, "--can");
  checkRefused("config --contact-rate-hz 100", 2, "--can");
}

TEST(RequestCommands, AMissingInterfaceIsSaidWithItsRemedy) {
  checkRefused("tare --can nocan7", 3, "nocan7");
  checkRefused("config --can nocan7 --contact-rate-hz 100", 3, "nocan7");
  checkRefused("config --can nocan7 --keep", 3, "nocan7");
  checkRefused("config --can nocan7 --set-node 2", 3, "nocan7");
  checkRefused("config --can nocan7 --set-node 64", 2, "--set-node");
}

TEST(RequestCommands, NodesAreThoseOfFingers) {
  for (const char* node : {"0", "64", "x", "-1"})
    checkRefused(std::string("tare --can nocan7 --node ").append(node), 2, "--node");
}

TEST(RequestCommands, RatesAreThoseAFingerTakes) {
  for (const char* rate : {"19", "1001", "100.5", "nan", "x", "-100"})
    checkRefused(std::string("config --can nocan7 --contact-rate-hz ").append(rate), 2, "--contact-rate-hz");
}

TEST(RequestCommands, ThereIsSomethingToConfigure) {
  checkRefused("config --can nocan7", 2, "give --contact-rate-hz, --keep, --set-node or --restart");
}

TEST(RequestCommands, TheConfigFileIsRead) {
  checkRefused("tare --can nocan7 -c /nowhere.toml", 2, "/nowhere.toml");
}

TEST(RequestCommands, ARateIsNotForgottenAtOnce) {
  checkRefused("config --can nocan7 --contact-rate-hz 100 --restart", 2, "give --keep as well");
  checkRefused("config --can nocan7 --contact-rate-hz 100 --keep --restart", 3, "nocan7");
}

// Which the finger does not know: it has no idea of the bit rate.
TEST(RequestCommands, ARateThatTheBusCannotCarryIsRefused) {
  const Run run = runShell(R"sh(config=$(mktemp) && trap 'rm $config' EXIT
printf 'schema = 1\n[can]\nbitrate = 125000\ncontact_rate_hz = 200\n' >$config
"$STRAINFINGER" config -c $config --can nocan7 --contact-rate-hz 309; echo $?
"$STRAINFINGER" config -c $config --can nocan7 --contact-rate-hz 308; echo $?)sh");
  STRCMP_EQUAL("2\n3\n", run.out.c_str());
  STRCMP_CONTAINS("config: --contact-rate-hz 309: at can.bitrate = 125000 the bus carries 308 at most",
                  run.err.c_str());
}

TEST(RequestCommands, TwoFingersOfOneNumberAreToldNothing) {
  const Run run = withFingerAndTwin("", R"(
for command in "tare --force" "config --contact-rate-hz 50" info "strains --rows 3"; do
  "$STRAINFINGER" $command --can $BUS; echo "$command: $?"
done)");
  STRCMP_EQUAL("tare --force: 1\nconfig --contact-rate-hz 50: 1\ninfo: 1\nstrains --rows 3: 1\n",
               run.out.c_str());
  STRCMP_CONTAINS("node 1: two fingers have this node number: take one off the bus", run.err.c_str());
}

TEST(RequestCommands, ANumberThatAnotherFingerHasIsNotGiven) {
  const Run run = withFinger("", R"(
"$STRAINFINGER" run --can $BUS -n 2 --duration 30 2>/dev/null & other=$!
trap 'kill -INT $other $finger 2>/dev/null; wait $other $finger' EXIT
for _ in $(seq 100); do "$STRAINFINGER" config --can $BUS -n 2 --contact-rate-hz 50 >/dev/null 2>&1 && break; done
"$STRAINFINGER" config --can $BUS -n 1 --set-node 2)");
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  STRCMP_CONTAINS(
      "node 2: there is a finger of this number already: choose another; `strainfinger discover --can udp:",
      run.err.c_str());
}
