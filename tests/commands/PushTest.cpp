// `push`, to a finger that runs beside it.
#include <unistd.h>

#include <string>

#include <CppUTest/TestHarness.h>

#include "tests/commands/with_finger.hpp"

using namespace strainfinger;

namespace {

/// Nothing touches the finger; another one's config.
const std::string kUntouched = R"(--scenario <(echo "schema = 1"))";
constexpr const char* kOther = R"(
printf 'schema = 1\n[gauges]\nradius_m = 9.5e-3\n' >$other
)";
/// A file of its own, gone when the script ends.
const std::string kFiles = "files=$(mktemp -d); other=$files/other.toml; tables=$files/tables\n";

Run withUntouchedFinger(const std::string& script) {
  return withFinger(kUntouched, kFiles + kOther + script + "\nstatus=$?; rm -r $files; exit $status");
}

/// Pushes to a finger that does everything as told by common/BUS_REQUESTS.md, but never starts anew although
/// its HEARTBEATs are those of one that works with the default tables, and that answers a word with `due`,
/// which may use the word's number `word`.
Run pushToAFake(const std::string& due) {
  return runShell("BUS=udp:" + std::to_string(20'000 + getpid() % 40'000) + R"(
exec 3< <(exec /usr/bin/python3 -c '
import socket, struct, sys, time
group, port = "239.255.67.65", int(sys.argv[1])
hears, speaks = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
hears.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
hears.bind((group, port))
hears.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + socket.inet_aton("127.0.0.1"))
hears.settimeout(0.05)
speaks.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
speaks.bind(("127.0.0.1", 0))
def say(identifier, data):
  speaks.sendto(bytes([1, identifier >> 8, identifier & 255, 8]) + data, (group, port))
print("listens", flush=True)
said_s = 0
while True:
  if time.monotonic() - said_s > 0.1:
    said_s = time.monotonic()
    say(0x701, struct.pack("<BHHbBB", 0x22, 0, 523, 25, 0, 0x2C))
  try:
    heard = hears.recv(16)
  except TimeoutError:
    continue
  if heard[1:3] != b"\x06\x01":
    continue
  command, word = struct.unpack("<BH", heard[5:8])
  say(0x581, struct.pack("<BBBIB", 6, 0x80 | command, 0, )" +
                  due + R"( if command == 8 else 0, 0))' ${BUS#udp:}); fake=$!
trap 'kill $fake' EXIT
read -r -u 3
"$STRAINFINGER" push --can $BUS)");
}

}  // namespace

TEST_GROUP(PushCommand) {};

TEST(PushCommand, AFingerThatAnswersAnotherWordIsQuoted) {
  const Run run = pushToAFake("word + 1 if word < 5 else 77");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("ended after 5 of 6142 words", run.err.c_str());
  STRCMP_CONTAINS("node 1: word 5: it answered that word 77 is due, where word 6 is: push again",
                  run.err.c_str());
}

TEST(PushCommand, AFingerThatDidNotStartAnewIsNotTakenForOneThatWorksWithTheTables) {
  const Run run = pushToAFake("word + 1");
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  STRCMP_CONTAINS("did not start anew when it was told to: it is up for 523 s", run.err.c_str());
}

TEST(PushCommand, AFingerWorksWithTheTablesOfAConfigFromItsNextStartOn) {
  const Run run = withUntouchedFinger(R"(
"$STRAINFINGER" push --can $BUS -c $other | sed "s/$BUS/BUS/"
"$STRAINFINGER" tables -c $other -o $tables 2>&1 | grep -o 'CRC-32 .*'
"$STRAINFINGER" info --can $BUS -c $other | grep -oE '(state|reset_cause),[a-z_]*')");
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "interface,node,table_crc,bytes\nBUS,1,02F190F1,24568\nCRC-32 "
      "02F190F1\nstate,run\nreset_cause,software\n",
      run.out.c_str());
}

TEST(PushCommand, AFileIsCheckedBeforeTheFingerIsStopped) {
  const Run run = withUntouchedFinger(R"(
"$STRAINFINGER" tables -o $tables 2>/dev/null
"$STRAINFINGER" push $tables --can $BUS -c $other; echo "another finger's: $?"
printf X | dd of=$tables bs=1 seek=9999 conv=notrunc 2>/dev/null
"$STRAINFINGER" push $tables --can $BUS; echo "damaged: $?"
"$STRAINFINGER" info --can $BUS | grep -o 'reset_cause,[a-z_]*')");
  STRCMP_EQUAL("another finger's: 5\ndamaged: 6\nreset_cause,power_on\n", run.out.c_str());
  STRCMP_CONTAINS("gauges.radius_m", run.err.c_str());
}

TEST(PushCommand, ATouchedFingerRefuses) {
  const Run run = withFinger(
      "--scenario <(printf 'schema = 1\\n[[touch]]\\nstart_s = 0.1\\nend_s = "
      "100\\nangle_deg = 100\\nnormal_n_per_m = 20\\n')",
      "sleep 0.5; \"$STRAINFINGER\" push --can $BUS");
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  STRCMP_CONTAINS("load: Refused: something touches the finger", run.err.c_str());
}

TEST(PushCommand, ATerminalThatIsClosedMeanwhileDoesntEndIt) {
  const Run run = withUntouchedFinger(R"(
/usr/bin/python3 -c '
import os, pty, subprocess, sys
ours, its = pty.openpty()
push = subprocess.Popen(sys.argv[1:], stderr=its)
os.close(its)
os.read(ours, 1)  # of how far it is
os.close(ours)
sys.exit(push.wait() % 256)' "$STRAINFINGER" push --can $BUS -c $other >/dev/null)");
  LONGS_EQUAL(0, run.status);
}

TEST(PushCommand, InterruptedItLeavesAFingerThatWaitsForTables) {
  const Run run = withUntouchedFinger(R"(
"$STRAINFINGER" push --can $BUS & push=$!
for i in {1..20}; do "$STRAINFINGER" discover --can $BUS --duration 0.3 | grep -q ,fault, && break; done
kill -INT $push; sleep 1; kill -HUP $push; wait $push; echo "$?"
"$STRAINFINGER" doctor --can $BUS --duration 1 | grep -A1 'fault tables'
"$STRAINFINGER" tare --can $BUS; echo "$?"
"$STRAINFINGER" push --can $BUS | sed "s/$BUS/BUS/"; "$STRAINFINGER" tare --can $BUS | sed "s/$BUS/BUS/")");
  STRCMP_CONTAINS("130\n", run.out.c_str());
  STRCMP_CONTAINS("has no tables until they are pushed again", run.err.c_str());
  STRCMP_CONTAINS("what to do: `strainfinger push --can ", run.out.c_str());
  STRCMP_CONTAINS(
      "tare: Not now: the zero is being taken, the end of a touch has not been sent yet, or the finger has "
      "no samples or no tables (busy)",
      run.err.c_str());
  STRCMP_CONTAINS("BUS,1,A38B572C,24568\ninterface,node,command,status\nBUS,1,tare,done\n", run.out.c_str());
}

TEST(PushCommand, OneSignalDoesNotEndItHalfWay) {
  const Run run = withUntouchedFinger(R"(
"$STRAINFINGER" push --can $BUS -c $other >/dev/null & push=$!
for i in {1..20}; do "$STRAINFINGER" discover --can $BUS --duration 0.3 | grep -q ,fault, && break; done
kill -HUP $push; kill -TERM $push; wait $push; echo "$?"; sleep 1
"$STRAINFINGER" discover --can $BUS --duration 0.5 | tail -n 1 | cut -d, -f3,10)");
  STRCMP_EQUAL("130\nrun,F1\n", run.out.c_str());
  STRCMP_CONTAINS(
      "push: goes on to the end, without which the finger has no tables; once more (Ctrl-C) ends it",
      run.err.c_str());
}

TEST(PushCommand, TheTablesThatWereThereAreNamed) {
  const Run run = withUntouchedFinger("\"$STRAINFINGER\" push --can $BUS -c $other");
  STRCMP_CONTAINS("has tables whose CRC-32 ends with 2C: their file, or the config they were made from",
                  run.err.c_str());
}

TEST(PushCommand, AmongSeveralFingersItIsNotGuessedWhichIsMeant) {
  const Run run = withUntouchedFinger(R"(
"$STRAINFINGER" run --can $BUS -n 4 --scenario <(echo "schema = 1") 2>/dev/null & other_finger=$!; sleep 1
"$STRAINFINGER" tables -o $tables 2>/dev/null
"$STRAINFINGER" push $tables --can $BUS; echo "$?"; kill $other_finger)");
  STRCMP_EQUAL("2\n", run.out.c_str());
  STRCMP_CONTAINS("has the fingers 1, 4: say with -n, or with its config (-c), which of them is to get",
                  run.err.c_str());
}

TEST(PushCommand, TheDefaultFingersTablesThatNobodyNamedReplaceNoOthers) {
  const Run run = withFinger(kUntouched + " -c <(printf 'schema = 1\\n[gauges]\\nradius_m = 9.5e-3\\n')",
                             "sleep 0.5; \"$STRAINFINGER\" push --can $BUS");
  LONGS_EQUAL(2, run.status);
  STRCMP_CONTAINS(
      "has tables of its own (their CRC-32 ends with F1), and these are the default finger's (2C): name",
      run.err.c_str());
}

// The first finger to answer would not notice, and both would lose their tables.
TEST(PushCommand, TwoFingersOfOneNumberKeepTheirTables) {
  const Run run = withFingerAndTwin(kUntouched, R"("$STRAINFINGER" push --can $BUS; echo "push: $?"
endTwin; "$STRAINFINGER" info --can $BUS | grep -oE '(state|reset_cause),[a-z_]*')");
  STRCMP_EQUAL("push: 1\nstate,run\nreset_cause,power_on\n", run.out.c_str());
  STRCMP_CONTAINS("node 1: two fingers have this node number: take one off the bus", run.err.c_str());
}

TEST(PushCommand, InterruptedWhileNobodyAnswersItEndsAtOnce) {
  const Run run = runShell(R"("$STRAINFINGER" push --can udp:19984 -n 9 & interrupt $!; wait $!)");
  LONGS_EQUAL(130, run.status);
  STRCMP_CONTAINS("udp:19984 node 9: interrupted before it answered", run.err.c_str());
}

TEST(PushCommand, NobodyThere) {
  const Run run = runProgram("push --can udp:19984");
  LONGS_EQUAL(4, run.status);
  STRCMP_CONTAINS("no answer", run.err.c_str());
}

// One whose board reads fewer gauges: it takes every word, and starts in state fault.
TEST(PushCommand, AFingerThatDoesNotWorkWithTheTablesIsToldFirstWhatTheyAreFor) {
  const Run run = runShell(R"(bus=udp:$((20000 + $$ % 20000))
/usr/bin/python3 - $bus <<'END' & finger=$!
import socket, sys, time
group = ("239.255.67.65", int(sys.argv[1][4:]))
hears = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
hears.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
hears.bind(group)
hears.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group[0]) + socket.inet_aton("127.0.0.1"))
speaks = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
speaks.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
while True:
    heard = hears.recv(16)
    if heard[1:3] != b"\x06\x01":
        continue
    say = lambda id, data: speaks.sendto(heard[:1] + id + bytes([8]) + data.ljust(8, b"\0"), group)
    next_word = int.from_bytes(heard[6:8], "little") + 1
    say(b"\x05\x81", bytes([6, heard[5] | 0x80, 0]) + next_word.to_bytes(4, "little"))
    for beat in range(2 if heard[5] == 9 else 0):
        time.sleep(0.2)
        say(b"\x07\x01", bytes([0x23, 0x01]))
END
sleep 0.5; timeout 60 "$STRAINFINGER" push --can $bus -c <(printf 'schema = 1\n[gauges]\ncount = 12\n')
status=$?; kill $finger; exit $status)");
  LONGS_EQUAL(6, run.status);
  STRCMP_CONTAINS(
      "took the tables, but does not work with them: state fault, table_crc 00, not DB: they are for 12 "
      "gauges: if its board reads fewer, push the tables of its own config (-c); else push them again",
      run.err.c_str());
}

TEST(PushCommand, AFingerRestartsWhenItIsTold) {
  const Run run = withUntouchedFinger(R"("$STRAINFINGER" config --can $BUS --restart | sed "s/$BUS/BUS/"
"$STRAINFINGER" info --can $BUS | grep -o 'reset_cause,[a-z_]*')");
  STRCMP_EQUAL("interface,node,command,status\nBUS,1,restart,done\nreset_cause,software\n", run.out.c_str());
}
