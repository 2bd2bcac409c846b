#include <CppUTest/TestHarness.h>

#include <string>

#include "tests/commands/program.hpp"

using namespace strainfinger;

TEST_GROUP(Record) {
  /// In a folder of its own, with a bus of its own in $bus; `record` records it into x.log until it is
  /// stopped.
  static Run inFolder(const std::string& commands, const std::string& input = "") {
    return runShell(
        "folder=$(mktemp -d); cat >$folder/in; cd $folder; trap 'rm -rf $folder' EXIT\n"
        "bus=udp:$((20000 + $$ % 20000))\n"
        "record() { \"$STRAINFINGER\" record --can $bus -o x.log \"$@\" & recorder=$!\n"
        "           until [ -e x.toml ] || ! kill -0 $recorder 2>&-; do sleep 0.02; done; }\n"
        "replay() { \"$STRAINFINGER\" replay --can $bus --speed 1000 \"$@\"; }\n"
        "stop() { sleep 0.4; kill -$1 $recorder; wait $recorder; }\n" +
            commands,
        input);
  }

  /// A log of so many frames, a millisecond apart.
  static std::string frames(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      std::string time = std::to_string(1'000'000 + i);
      text += "(1609779" + time.substr(1, 3) + "." + time.substr(4) + "000) can0 181#" +
              std::string(14, '0') + "55\n";
    }
    return text;
  }
  static void checkSays(const char* text, const Run& run) { STRCMP_CONTAINS(text, run.err.c_str()); }
};

TEST(Record, WhatIsReplayedIsWhatWasRecorded) {
  const Run run =
      inFolder("record; replay in; stop INT; cut -d' ' -f3 in >a; cut -d' ' -f3 x.log | cmp a - && echo same",
               frames(500));
  STRCMP_EQUAL("same\n", run.out.c_str());
  checkSays("replay: 500 of 500 frames sent, 0 of other kinds left out", run);
  checkSays("record: 500 frames in ", run);
  checkSays(" 0 missed: x.log, x.toml", run);
}

TEST(Record, CtrlCIsTheEnd) { LONGS_EQUAL(130, inFolder("record; stop INT").status); }

TEST(Record, EndsAfterItsDuration) {
  const Run run = inFolder("record --duration 0.3; wait $recorder");
  LONGS_EQUAL(0, run.status);
  checkSays("record: 0 frames in 0.", run);
  checkSays("record: warning: nothing was heard on udp:", run);
}

TEST(Record, GoesOnWithAnotherLogOfWhichNoFrameIsLost) {
  const Run run = inFolder(
      R"("$STRAINFINGER" record --can $bus -o x.log --new-log-every 2 --duration 7 --json >logs & recorder=$!
for i in {1..500}; do [ -e x-*.toml ] && break; sleep 0.02; done
"$STRAINFINGER" replay in --can $bus; wait $recorder
cat x-*.log | cut -d' ' -f3 | sort | cmp <(cut -d' ' -f3 in | sort) - && echo same
logs=$(wc -l <logs); [ $logs -ge 2 ] && [ $(ls x-*.log | wc -l) = $logs ] && echo several
[ $(grep -l '^end = ' x-*.toml | wc -l) = $logs ] && echo complete
grep -o '"frames":[0-9]*' logs | cut -d: -f2 | paste -sd+ | sed 's/^/echo $((/; s/$/))/' | bash)",
      frames(4000));
  STRCMP_EQUAL("same\nseveral\ncomplete\n4000\n", run.out.c_str());
  checkSays(" 0 missed: x-20", run);
}

TEST(Record, TablesThatChangeAreTold) {
  const Run run =
      inFolder("record; replay in; stop INT; grep table_crc x.toml; \"$STRAINFINGER\" decode in >/dev/null",
               "(1.000000) can0 705#2200000A000000A7\n(1.500000) can0 705#2300000A00000000\n(2.000000) can0 "
               "705#2200000B0000008F\n");
  STRCMP_EQUAL("table_crc = \"8F\"\ntable_crc_before = [\"A7\"]\n", run.out.c_str());
  checkSays("record: warning: node 5: its tables changed meanwhile (last bytes of their CRC-32: A7, 8F)",
            run);
  checkSays("decode: can0 node 5: its tables changed meanwhile", run);
}

TEST(Record, NotesTheConfigAndTheFingers) {
  const Run run = inFolder(
      "printf 'schema = 1\\n[can]\\nnode = 9\\n' >c.toml; record -c c.toml; replay in; stop INT; cat x.toml\n"
      "\"$STRAINFINGER\" dbc -c x.toml | grep -c FINGER_9",
      "(1.000000) can0 705#2200004D0E1900A7\n(1.000000) can0 485#440300010000005C\n");
  for (const char* text : {"\n[can]\n", "node = 9\n", "\n[recording]\nprogram = \"0.",
                           "\nbus = \"udp:", "\nframes = 2\nmissed = 0\ngaps = 0\n", "\nconfig_crc32 = \"",
                           "\n[[recording.finger]]\nnode = 5\nversion = \"0.1\"\nboard = 92\nprotocol = 2\n",
                           "\ntable_crc = \"A7\"\n"})
    STRCMP_CONTAINS(text, run.out.c_str());
  CHECK(run.out.back() == '\n' && run.out.substr(run.out.size() - 3) != "\n0\n");
}

TEST(Record, SurvivesBeingKilled) {
  const Run run = inFolder(
      "record; replay in; sleep 0.5; kill -9 $recorder; wait $recorder 2>&-\n"
      "\"$STRAINFINGER\" decode x.log >rows; echo $? $(wc -l <rows); grep -c '^.recording.$' x.toml",
      frames(300));
  STRCMP_EQUAL("0 301\n1\n", run.out.c_str());
}

TEST(Record, AFullDiskIsSaidAndLeavesWholeLines) {
  const Run run = inFolder(
      "ulimit -f 16; record; replay in; wait $recorder; echo $?; tail -c 1 x.log | od -An -c\n"
      "\"$STRAINFINGER\" decode x.log >/dev/null",
      frames(800));
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("1\n  \\n\n", run.out.c_str());
  checkSays("x.log: cannot write: File too large; what was written before stays\n", run);
}

TEST(Record, ALogThatIsRemovedMeanwhileIsSaidAtOnce) {
  const Run run = inFolder("record; replay in; sleep 0.4; rm x.log; wait $recorder", frames(10));
  LONGS_EQUAL(1, run.status);
  checkSays("x.log: it was removed while it was written: all its frames, up to 20", run);
}

TEST(Record, ALogThatIsCutMeanwhileIsSaidAtOnce) {
  const Run run = inFolder("record; replay in; sleep 0.4; truncate -s 47 x.log; wait $recorder", frames(10));
  LONGS_EQUAL(1, run.status);
  checkSays("x.log: it was cut while it was written", run);
  checkSays("what came behind its first 47 bytes, up to 20", run);
}

TEST(Record, ALogThatIsRenamedMeanwhileIsWholeUnderItsNewName) {
  const Run run = inFolder(
      "record; replay in; sleep 0.4; mv x.log y.log; touch x.log; replay in; stop INT; grep -c . y.log",
      frames(10));
  STRCMP_EQUAL("20\n", run.out.c_str());
  checkSays("record: warning: x.log was renamed meanwhile: all is in /", run);
  checkSays("/y.log\n", run);
  const Run own = inFolder("record; stop INT");
  CHECK(own.err.find("renamed") == std::string::npos);
}

TEST(Record, NeverWritesOverAFile) {
  const Run run = inFolder("echo old >x.log; record; wait $recorder; status=$?; cat x.log; exit $status");
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL("old\n", run.out.c_str());
  checkSays("x.log: cannot make the file: File exists: remove it, or write to another file", run);
}

TEST(Record, NobodyIsToldToRemoveADevice) {
  for (const std::string path : {"/dev/null", "/dev/stdout", "pipe"}) {
    const Run run = inFolder("mkfifo pipe; \"$STRAINFINGER\" record --can $bus -o " + path);
    LONGS_EQUAL(1, run.status);
    checkSays(
        (path + ": cannot make the file: File exists: a log needs a regular file of its own; `candump -L")
            .c_str(),
        run);
  }
}

TEST(Record, NeverWritesOverTheNotesOfAnotherLog) {
  const Run run = inFolder(
      "echo old >x.toml; \"$STRAINFINGER\" record --can $bus -o x.log; status=$?; cat x.toml; ls; exit "
      "$status");
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL("old\nin\nx.toml\n", run.out.c_str());
  checkSays("x.toml: there is such a file already, where the notes of x.log belong: write to another file",
            run);
}

TEST(Record, RefusesWhatCannotBe) {
  checkRefused("record --can udp -o x.toml", "a log cannot end in .toml");
  checkRefused("record -o x.log", "--can is required");
  checkRefused("record --can udp", "--output is required");
  checkRefused("record --can udp -o x.log --duration nan", "--duration");
  LONGS_EQUAL(3, runProgram("record --can nobus -o /tmp/x.log").status);
  LONGS_EQUAL(1, runProgram("record --can udp -o /nonexistent/x.log").status);
}

TEST(Record, ReplaySendsALogThatWasCutOffUpToItsLastWholeLine) {
  const Run run = inFolder(
      "record; \"$STRAINFINGER\" replay in --can $bus; stop INT; grep -c . x.log",
      "(1.000000) can0 181#0000000000000054\n(1.010000) can0 181#0000000000000055\n(1.020000) can0 181#000");
  STRCMP_EQUAL("2\n", run.out.c_str());
  checkSays("in:3: the log breaks off in this line, which is left out", run);
}

TEST(Record, ReplayKeepsTheTimesOfTheLog) {
  const Run run = inFolder(
      "record; \"$STRAINFINGER\" replay in --can $bus --speed 0.5; stop INT\n"
      "\"$STRAINFINGER\" decode x.log | awk -F, 'NR == 2 {t = $1} NR == 3 {d = $1 - t; print 0.59 < d && d < "
      "0.9}'",
      "(1.000000) can0 181#0000000000000054\n(1.300000) can0 181#0000000000000055\n");
  STRCMP_EQUAL("1\n", run.out.c_str());
}

// From before a clock was set: at this speed 540 years, which is none that a clock can tell.
TEST(Record, ReplayWaitsForWhatIsFarAway) {
  const Run run =
      inFolder("\"$STRAINFINGER\" replay in --can $bus --speed 0.1 & interrupt $!; wait $!",
               "(0.000000) can0 181#0000000000000054\n(1700000000.000000) can0 181#0000000000000055\n");
  LONGS_EQUAL(130, run.status);
  checkSays("replay: 1 of 2 frames sent", run);
}

TEST(Record, ReplayOfManyInterfacesNamesSome) {
  std::string log;
  for (int i = 0; i < 1000; ++i) log += "(1.000000) can" + std::to_string(i) + " 181#0000000000000055\n";
  const Run run = inFolder("replay in", log);
  checkSays("(can0, can1, can10, can100, can101 and 995 more)", run);
}

TEST(Record, ReplayLeavesOutWhatFingersDontSend) {
  const Run run = inFolder("replay in",
                           "(1.000000) can0 12345678#11\n(1.000000) can0 181#R8\n(1.000000) can0 123#11\n\n"
                           "DROPCOUNT: dropped 4 CAN frames on 'can0' socket (total drops 4)\n");
  LONGS_EQUAL(0, run.status);
  checkSays("1 of 1 frames sent, 2 of other kinds left out", run);
}

// A finger that is there would take a new zero, or other tables.
TEST(Record, ReplaySendsRequestsOnlyWhenAsked) {
  const std::string log =
      "(1.000000) can0 181#0000000000000055\n(1.000000) can0 601#01\n(1.000000) can0 201#11\n";
  const Run run = inFolder("record; replay in; stop INT; cut -d' ' -f3 x.log", log);
  STRCMP_EQUAL("181#0000000000000055\n201#11\n", run.out.c_str());
  checkSays(
      "replay: 2 of 2 frames sent, 0 of other kinds left out\n"
      "replay: 1 requests to fingers left out, too: --requests sends them\n",
      run);
  const Run all = inFolder("record; replay in --requests; stop INT; cut -d' ' -f3 x.log", log);
  STRCMP_EQUAL("181#0000000000000055\n601#01\n201#11\n", all.out.c_str());
  checkSays("replay: 3 of 3 frames sent", all);
}

TEST(Record, ReplayOfATimeSendsWhatIsOfIt) {
  const char* const log =
      "(1.000000) can0 181#0000000000000055\n(2.000000) can0 181#0000000000000056\n(3.000000) can0 182#00\n";
  const Run run = inFolder("record; replay in --from +0.5 --to 2; stop INT; cut -d' ' -f3 x.log", log);
  STRCMP_EQUAL("181#0000000000000056\n", run.out.c_str());
  checkSays("replay: 1 of 1 frames sent", run);
}

TEST(Record, WhatCannotBeComputedAgainIsToldWhy) {
  const auto recomputed = [](const char* config, const char* log) {
    const Run run = inFolder(std::string("printf 'schema = 1\\n") + config +
                                 "' >c.toml; \"$STRAINFINGER\" replay in --recompute -c c.toml",
                             log);
    LONGS_EQUAL(1, run.status);
    return run.err;
  };
  const char* const rawOfNode2 = "(1.000000) can0 402#0000000000000000\n";
  STRCMP_CONTAINS("has no readings (RAW) of node 1: `strainfinger strains` asks",
                  recomputed("", "(1.000000) can0 181#0000000000000055\n").c_str());
  STRCMP_CONTAINS("has no readings (RAW) of node 1, but of 2: give that finger's config (-c)",
                  recomputed("", rawOfNode2).c_str());
  STRCMP_CONTAINS("nothing to compare: the recording needs RAW of every sample set of node 2",
                  recomputed("[can]\\nnode = 2\\n", rawOfNode2).c_str());
  STRCMP_CONTAINS("with 20 gauges a bus of 1000000 bit/s carries 862 sample sets a second, not all 1000",
                  recomputed("[gauges]\\ncount = 20\\n[can]\\nnode = 2\\n", rawOfNode2).c_str());
}

TEST(Record, ReplayOfSeveralInterfacesSaysThatTheyMix) {
  const char* const log = "(1.000000) can0 181#0000000000000055\n(1.000000) can1 181#0000000000000056\n";
  const Run run = inFolder("replay in", log);
  LONGS_EQUAL(0, run.status);
  checkSays("replay: warning: in: what it has of several interfaces (can0, can1) all goes to udp:", run);
  const Run one = inFolder("record; replay in --interface can1; stop INT; cut -d' ' -f3 x.log", log);
  STRCMP_EQUAL("181#0000000000000056\n", one.out.c_str());
  CHECK(one.err.find("warning") == std::string::npos);
  const Run others =
      inFolder("replay in --interface can0", "(1.000000) can0 181#00\n(1.000000) can1 18100000#00\n");
  checkSays("replay: 1 of 1 frames sent, 0 of other kinds left out", others);
  const Run none = inFolder("replay in --interface can2", log);
  LONGS_EQUAL(1, none.status);
  checkSays("in: no frame of can2 in it", none);
}

TEST(Record, OfOneNodeOnSeveralInterfacesOneIsComputedAgain) {
  const char* const log = "(1.000000) can0 401#0000000000000000\n(1.000000) can1 181#0000000000000055\n";
  const Run both = inFolder("\"$STRAINFINGER\" replay in --recompute", log);
  LONGS_EQUAL(2, both.status);
  checkSays("in: there is a node 1 on can0 and one on can1: choose with --interface", both);
  const Run other = inFolder("\"$STRAINFINGER\" replay in --recompute --interface can1", log);
  LONGS_EQUAL(1, other.status);
  checkSays("has no readings (RAW) of node 1", other);
}

TEST(Record, ReplaySendsNothingOfALogItCannotRead) {
  const Run run = inFolder("record; replay in; echo $?; stop INT; cat x.log", frames(3) + "rubbish\n");
  STRCMP_EQUAL("1\n", run.out.c_str());
  checkSays("in:4:8: ", run);
  const Run timeless = inFolder("replay in", "  can0  185   [2]  E8 03\n");
  LONGS_EQUAL(1, timeless.status);
  checkSays("in:1: a frame without a time", timeless);
}

TEST(Record, ReplayRefusesWhatCannotBe) {
  checkRefused("replay - --can udp", "the log must be a file");
  const Run pipe = runShell(R"("$STRAINFINGER" replay --can udp:19977 <(echo))");
  LONGS_EQUAL(2, pipe.status);
  STRCMP_CONTAINS("not a pipe: it is read twice", pipe.err.c_str());
  checkRefused("replay x.log", "give either --can");
  checkRefused("replay x.log --can udp --recompute", "give either --can");
  checkRefused("replay x.log --recompute --speed 2", "--speed and --requests go with --can");
  for (const std::string speed : {"0", "nan"})
    checkRefused("replay x.log --can udp --speed " + speed, "--speed");
  LONGS_EQUAL(1, runProgram("replay /nonexistent --can udp").status);
}

TEST(Record, CtrlCEndsAReplay) {
  const Run run = inFolder("\"$STRAINFINGER\" replay in --can $bus & interrupt $!; wait $!",
                           "(1.000000) can0 181#00\n(1000.000000) can0 181#00\n");
  LONGS_EQUAL(130, run.status);
  checkSays("1 of 2 frames sent", run);
}
