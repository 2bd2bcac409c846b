#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "tests/commands/program.hpp"

using namespace strainfinger;

TEST_GROUP(Decode) {
  const std::string contact_ = "(1609779922.655421) can0 185#E8032201808161A3\n";
  const std::string force_ = "(1609779922.655421) can0 285#22011EFF070981A3\n";
  const std::string patch_ = "(1609779922.655421) can0 385#F8079600110281A3\n";
  const std::string contact2_ = "(1609779922.655421) can0 205#0C4E360180815FA3\n";
  const std::string force2_ = "(1609779922.655421) can0 305#9A012300090981A3\n";
  const std::string heartbeat_ = "(1609779922.655421) can0 705#2200004D0E1900A7\n";
  const std::string other_ = "(1609779922.655421) can0 080#00\n";

  /// The rows below the header.
  static std::string rows(const Run& run) { return run.out.substr(run.out.find('\n') + 1); }
  static void checkSays(const char* text, const Run& run) { STRCMP_CONTAINS(text, run.err.c_str()); }
};

TEST(Decode, PrintsARowAFrame) {
  const Run run = runProgram("decode", contact_ + force_ + patch_ + contact2_ + force2_ + heartbeat_);
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "1609779922.655421,can0,5,CONTACT,10,2.9,,contact+simulated,97,163,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,\n"
      "1609779922.655421,can0,5,FORCE,,,,contact+simulated,,163,0.29,-0.226,0.0035,0.0045,,,,,,,,,,,,,,,,,,,,"
      ",,,,,,,\n"
      "1609779922.655421,can0,5,PATCH,,,,contact+simulated,,163,,,,,0.00204,0.00015,1.0625,2,,,,,,,,,,,,,,,,,"
      ",,,,,,\n"
      "1609779922.655421,can0,5,CONTACT2,199.8,3.1,,contact+simulated,95,163,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,,\n"
      "1609779922.655421,can0,5,FORCE2,,,,contact+simulated,,163,0.41,0.035,0.0045,0.0045,,,,,,,,,,,,,,,,,,,,"
      ",,,,,,,\n"
      "1609779922.655421,can0,5,HEARTBEAT,,,,,,,,,,,,,,,run,2,,3661,25,0,0,167,,,,,,,,,,,,,,,\n",
      rows(run).c_str());
}

TEST(Decode, OfALogATimeIsRead) {
  const std::string force = " can0 285#22011EFF070981A3\n";
  const std::string log = "(10.000000)" + force + "(10.500000)" + force + "(11.000000)" + force;
  const auto timesOf = [&](const std::string& window) {
    const Run run =
        runShell("\"$STRAINFINGER\" decode " + window + " | tail -n +2 | cut -d, -f1 | tr '\\n' ' '", log);
    LONGS_EQUAL(0, run.status);
    return run.out;
  };
  STRCMP_EQUAL("10.500000 11.000000 ", timesOf("--from 10.5").c_str());
  STRCMP_EQUAL("10.000000 10.500000 ", timesOf("--to +0.5").c_str());
  STRCMP_EQUAL("10.500000 ", timesOf("--from 1970-01-01T00:00:10.25Z --to 10.75").c_str());
  const Run outside = runProgram("decode --from +2", log);
  LONGS_EQUAL(1, outside.status);
  checkSays("decode: no frame is of that time: they are from 10 s to 11 s", outside);
  checkRefused("decode --from 3 --to 2", "--from: is later than --to");
  checkSays("decode: skipped 2 of other times\n", runProgram("decode --from 11", log));
  checkRefused("decode --from yesterday", "--from: no time: give seconds as the log has them");
  const Run none = runProgram("decode --from 1", " can0  285   [8]  22 01 1E FF 07 09 81 A3\n");
  LONGS_EQUAL(1, none.status);
  checkSays("stdin:1: a frame without a time", none);
}

TEST(Decode, OfEachLogSecondsAfterItsFirstFrameAreRead) {
  const Run run = runShell(
      "folder=$(mktemp -d); cd $folder; trap 'rm -rf $folder' EXIT\n"
      "for at in 10 20; do for after in 0 1; do echo \"($((at + after)).000000) can0 285#22011EFF070981A3\"; "
      "done >$at.log; done\n\"$STRAINFINGER\" decode --from +1 10.log 20.log | tail -n +2 | cut -d, -f1");
  STRCMP_EQUAL("11.000000\n21.000000\n", run.out.c_str());
}

TEST(Decode, AnotherProtocolIsKnownFromHeartbeatsOfOtherTimes) {
  const std::string heartbeat = "(10.000000) can0 705#4200004D0E1900A7\n";
  const Run run = runProgram("decode --from +1", heartbeat + "(11.000000) can0 285#22011EFF070981A3\n");
  LONGS_EQUAL(5, run.status);
  STRCMP_EQUAL("", rows(run).c_str());
  checkSays("stdin:2: can0 node 5 speaks protocol 4, this program 2", run);
}

TEST(Decode, ReadsAnyFormOfCandump) {
  const Run run = runProgram("decode",
                             "  can0  285   [8]  22 01 1E FF 07 09 81 A3\r\n"
                             " (003.000017)  can0  RX - -  285   [8]  22 01 1E FF 07 09 81 A3\n");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("\n,can0,5,FORCE,", run.out.c_str());
  STRCMP_CONTAINS("\n3.000017,can0,5,FORCE,", run.out.c_str());
  checkSays("(screen, no time)", run);
}

TEST(Decode, ReadsALogThatBeginsWithAByteOrderMark) {
  const Run run = runProgram("decode", "\xEF\xBB\xBF(1609779922.655421) can0 285#22011EFF070981A3\n");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("1609779922.655421,can0,5,FORCE,", run.out.c_str());
}

TEST(Decode, ReadsWhatCanUtilsMakesOfALog) {
  // log2long prints with the code that candump prints with; asc2log and log2asc are can-utils' too.
  const std::string log =
      contact_ + "(1609779922.655421) can0 12345678#11\n(1609779922.655421) can0 185#R8\n" +
      "(1609779922.755421) can0 20000080#0000000000000000\n(1609779922.855421) can0 185##311\n" + force_;
  const Run screen = runShell("log2long | \"$STRAINFINGER\" decode", log);
  STRCMP_EQUAL(runProgram("decode", contact_ + force_).out.c_str(), screen.out.c_str());
  checkSays("(screen, absolute time)", screen);
  const Run again =
      runShell("log2asc can0 | asc2log 2>/dev/null | \"$STRAINFINGER\" decode | cut -d, -f2-", contact_);
  STRCMP_EQUAL(runShell("\"$STRAINFINGER\" decode | cut -d, -f2-", contact_).out.c_str(), again.out.c_str());
}

TEST(Decode, PrintsObjects) {
  const Run run = runProgram("decode --json", force_);
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "{\"time_s\":1609779922.655421,\"interface\":\"can0\",\"node\":5,\"frame\":\"FORCE\",\"normal_n\":0.29,"
      "\"tangential_n\":-0.226,\"sigma_normal_n\":0.0035,\"sigma_tangential_n\":0.0045,"
      "\"flags\":\"contact+simulated\",\"sequence\":163}\n",
      run.out.c_str());
}

TEST(Decode, CountsWhatIsNoFingers) {
  const Run run = runProgram("decode", other_ + contact_ + other_);
  LONGS_EQUAL(0, run.status);
  checkSays("3 lines (log, absolute time), 1 frames decoded, 2 others skipped", run);
  checkSays("skipped 2 with identifiers that are no finger's", run);
}

TEST(Decode, NamesWhatItSkips) {
  const std::string t = "(1609779922.655421) can0 ";
  const Run run =
      runProgram("decode --node 5", t + "12345678#11\n" + t + "185#R8\n" + t + "20000080#0000000000000000\n" +
                                        t + "185##311\n" + t + "186#E8032201808161A3\n" + contact_ + t +
                                        "185#E803\n" + t + "285#\n");
  LONGS_EQUAL(0, run.status);
  checkSays("8 lines (log, absolute time), 1 frames decoded, 7 others skipped", run);
  for (const char* text : {"skipped 1 of other nodes\n", "skipped 1 with extended (29-bit) identifiers\n",
                           "skipped 1 remote requests\n", "skipped 1 of CAN FD\n", "skipped 1 error frames",
                           "skipped 2 malformed: not the length of such a frame\n",
                           "stdin:7: CONTACT of node 5 has 2 bytes, not 8\n"})
    checkSays(text, run);
}

TEST(Decode, ShowsResponses) {
  const Run run = runProgram("decode", "(1609779922.655421) can0 585#0281040000000000\n");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("can0,5,RESPONSE,", run.out.c_str());
  STRCMP_CONTAINS(",tare,,,touched,\n", run.out.c_str());
  checkSays("1 frames decoded, 0 others skipped", run);
}

TEST(Decode, PrintsARowATouch) {
  const Run run =
      runProgram("decode --touches", contact_ + force_ + patch_ + contact2_ + force2_ + heartbeat_);
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "time_s,interface,node,angle_deg,normal_n,tangential_n,width_m,sigma_angle_deg,sigma_normal_n,"
      "sigma_tangential_n,sigma_width_m,quality_percent,chi,flags,sequence,angle2_deg,normal2_n,tangential2_"
      "n,alternative_deg,contacts,sigma_angle2_deg,sigma_normal2_n,sigma_tangential2_n,quality2_percent,"
      "alternative2_deg\n"
      "1609779922.655421,can0,5,10,0.29,-0.226,0.00204,2.9,0.0035,0.0045,0.00015,97,1.0625,contact+simulated,"
      "163,199.8,0.41,0.035,,2,3.1,0.0045,0.0045,95,\n",
      run.out.c_str());
}

TEST(Decode, ARowHasWhatIsLeftOfATouch) {
  const Run run = runProgram("decode --touches", contact_ + patch_);
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL(
      "1609779922.655421,can0,5,10,,,0.00204,2.9,,,0.00015,97,1.0625,contact+simulated,163,,,,,2,,,,,\n",
      rows(run).c_str());
}

TEST(Decode, TellsTwoFingersOfOneNumberFromLosses) {
  const Run run = runShell(
      "\"$STRAINFINGER\" run --duration 2 >a; \"$STRAINFINGER\" run --seed 2 --duration 2 | tail -n +2 >b\n"
      "paste -d '\\n' a b | grep . | \"$STRAINFINGER\" decode; rm a b");
  checkSays("two fingers have this node number", run);
  CHECK(run.err.find(" lost, ") == std::string::npos);
}

TEST(Decode, ReadsFilesInTheirOrder) {
  const Run run = runShell(
      "cd $(mktemp -d); cat >b; echo '(1.000000) can1 185#E8032201808161A3' >a\n"
      "\"$STRAINFINGER\" decode a b - b <a; rm a b",
      force_ + "rubbish\n");
  LONGS_EQUAL(0, run.status);
  checkSays("b:2:8: ", run);
  checkSays("6 lines", run);
  const std::size_t first = run.out.find("can1,5,CONTACT"), second = run.out.find("can0,5,FORCE");
  CHECK(first < second && second < run.out.find("can1,5,CONTACT", second));
}

TEST(Decode, TimesThatGoBackAreTold) {
  const auto decoded = [](const std::string& files, const std::string& b) {
    return runShell(
        "cd $(mktemp -d); cat >b; echo '(1609779000.000000) can0 185#E8032201808161A3' >a\n"
        "\"$STRAINFINGER\" decode " +
            files + "; rm -r $PWD",
        b);
  };
  checkSays(
      "decode: warning: a:1: the times go back by 923 s here: the clock was set, logs of several runs were "
      "joined, or they are differences (candump -td); where files are given twice, or not in their order, "
      "losses are not counted right\n",
      decoded("b a", contact_));
  checkSays("decode: warning: a:1: the times go back", decoded("a b a", contact_));
  CHECK(decoded("a b", contact_).err.find("warning") == std::string::npos);
  // The log of another bus has a clock of its own.
  CHECK(decoded("b a", "(1609779922.655421) can1 185#E8032201808161A3\n").err.find("warning") ==
        std::string::npos);
  std::string differences;
  for (int i = 0; i < 8; ++i) differences += " (000.00" + std::to_string(9 - i) + "000)  can0  185   [0]\n";
  checkSays("decode: warning: b: 7 of 8 frames have an earlier time than the one before",
            decoded("b", differences));
}

TEST(Decode, RefusesFilesThatAreNotThereBeforeItPrints) {
  const Run run = runShell("\"$STRAINFINGER\" decode /dev/stdin /nonexistent", contact_);
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  checkSays("/nonexistent: cannot read: No such file or directory", run);
}

TEST(Decode, ReadsAPipeThatHasAName) {
  const Run run = runShell(
      "cd $(mktemp -d); mkfifo a; echo '(1.000000) can1 185#E8032201808161A3' >a &\n"
      "timeout -s KILL 10 \"$STRAINFINGER\" decode a; status=$?; rm a; exit $status");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("can1,5,CONTACT", run.out.c_str());
}

TEST(Decode, AnUnreadableStdinIsAFailure) {
  for (const char* stdin : {"</", "<&-"}) {
    const Run run = runProgram(std::string("decode ") + stdin);
    LONGS_EQUAL(1, run.status);
    checkSays("strainfinger: stdin: cannot read: ", run);
  }
}

TEST(Decode, CtrlCStillPrintsTheSummary) {
  const Run run = runShell(
      "pipe=$(mktemp -u); mkfifo $pipe; exec 3<>$pipe; cat >&3\n"
      "\"$STRAINFINGER\" decode <$pipe & interrupt $!; wait $!; status=$?; rm $pipe; exit $status",
      contact_);
  LONGS_EQUAL(130, run.status);
  STRCMP_CONTAINS("CONTACT", run.out.c_str());
  checkSays("1 frames decoded", run);
}

TEST(Decode, CtrlCEndsItWhereNobodyWritesIntoThePipeYet) {
  const Run run = runShell(
      "pipe=$(mktemp -u); mkfifo $pipe\n"
      "\"$STRAINFINGER\" decode $pipe & interrupt $!; wait $!; status=$?; rm $pipe; exit $status");
  LONGS_EQUAL(130, run.status);
  checkSays("0 frames decoded", run);
}

TEST(Decode, WaitsForWhoeverOpensThePipeLater) {
  const Run run = runShell(
      "pipe=$(mktemp -u); mkfifo $pipe\n"
      "\"$STRAINFINGER\" decode $pipe & sleep 0.3; cat >$pipe; wait $!; status=$?; rm $pipe; exit $status",
      contact_);
  LONGS_EQUAL(0, run.status);
  checkSays("1 frames decoded", run);
}

TEST(Decode, FollowsAFileThatGrows) {
  const Run run = runShell(
      "log=$(mktemp); \"$STRAINFINGER\" decode --follow $log & sleep 0.3; head -c 20 >>$log; sleep 0.2; cat "
      ">>$log\n"
      "interrupt $!; wait $!; status=$?; rm $log; exit $status",
      contact_ + force_);
  LONGS_EQUAL(130, run.status);
  STRCMP_CONTAINS("FORCE", run.out.c_str());
  checkSays("2 frames decoded", run);
}

// As where `record` is started at the same time.
TEST(Decode, FollowsAFileThatIsNotThereYet) {
  const Run run = runShell(
      "log=$(mktemp -u); \"$STRAINFINGER\" decode --follow $log & sleep 0.3; cat >$log\n"
      "sleep 0.6; interrupt $!; wait $!; status=$?; rm $log; exit $status",
      contact_ + force_);
  LONGS_EQUAL(130, run.status);
  checkSays("2 frames decoded", run);
}

// As logrotate does: the name is away for a while, and who writes has the old file still.
TEST(Decode, FollowsTheNameWhenAnotherFileTakesIt) {
  const Run run = runShell(
      "log=$(mktemp); cat >$log.next; \"$STRAINFINGER\" decode --follow $log &\n"
      "until ls -l /proc/$!/fd | grep -q $log; do sleep 0.05; done\n"
      "mv $log $log.1; sleep 0.3; head -n 1 $log.next >>$log.1\n"
      "tail -n 1 $log.next >$log.2; echo nonsense >>$log.2; mv $log.2 $log; sleep 0.6\n"
      "head -n 1 $log.next >>$log; sleep 0.4; interrupt $!; wait $!; status=$?; rm $log $log.*; exit $status",
      contact_ + force_);
  LONGS_EQUAL(1, run.status);  // for the nonsense
  checkSays("3 frames decoded", run);
  checkSays(":2:", run);  // lines count from the new file's start
  STRCMP_CONTAINS("FORCE", run.out.c_str());
}

TEST(Decode, FollowsOneFile) {
  checkRefused("decode --follow", "--follow needs one FILE");
  checkRefused("decode --follow -", "--follow needs one FILE");
  checkRefused("decode --follow a b", "--follow needs one FILE");
}

TEST(Decode, AMistakeInTheConfigIsToldAsEverywhere) {
  checkRefused("decode -c /nowhere.toml", "/nowhere.toml");
}

TEST(Decode, NumbersThatCannotBeAreErrors) {
  const Run run =
      runProgram("decode",
                 "DROPCOUNT: dropped 4294967296 CAN frames on 'can0' socket (total drops 4)\n"
                 "(16097799229.655421) can0 185#\n (2021-02-31 18:05:22.655421)  can0  185   [0]\n"
                 "(1609779922.655421) can0 800#\n");
  LONGS_EQUAL(1, run.status);
  checkSays("4 of 4 lines could not be read", run);
  checkSays("stdin:3:3: no such date", run);
}

TEST(Decode, CountsWhatWasLost) {
  const Run run = runProgram("decode", "DROPCOUNT: dropped 4 CAN frames on 'can0' socket (total drops 4)\n" +
                                           contact_ + "(1609779922.655421) can0 185#E8032201808161A6\n");
  LONGS_EQUAL(0, run.status);
  checkSays("can0 node 5: 2 frames of touches received, 2 lost", run);
  checkSays("candump dropped 4 frames", run);
}

TEST(Decode, PicksNodes) {
  const Run run = runProgram("decode --node 1,2", contact_);
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL("", rows(run).c_str());
  STRCMP_CONTAINS("CONTACT", runProgram("decode --node 1,5", contact_).out.c_str());
  STRCMP_EQUAL("", rows(runProgram("decode --node 5", "(1.000000) can0 18D#E8032201808161A3\n")).c_str());
  LONGS_EQUAL(2, runProgram("decode --node 64", contact_).status);
  LONGS_EQUAL(2, runProgram("decode --node 1,,5", contact_).status);
}

TEST(Decode, GoesOnAfterALineItCannotRead) {
  const Run run = runProgram("decode", contact_ + "(1609779922.655421) can0 185#E8x3\n" + force_);
  LONGS_EQUAL(1, run.status);
  checkSays("stdin:2:32: expected data", run);
  checkSays("1 of 3 lines could not be read", run);
  STRCMP_CONTAINS("FORCE", run.out.c_str());
}

TEST(Decode, ACompressedLogIsNamedOnce) {
  const Run run = runShell(
      "cd $(mktemp -d); gzip -c >x.log.gz; for command in decode 'plot -o x.svg' 'replay --can udp:19976' "
      "strains 'locate <'; do\n"
      "eval \"\\\"$STRAINFINGER\\\" $command x.log.gz >/dev/null\"; done; rm -r $PWD",
      contact_);
  LONGS_EQUAL(5, std::ranges::count(run.err, '\n'));
  checkSays("strainfinger: x.log.gz is compressed with gzip: `zcat x.log.gz | strainfinger decode`", run);
  checkSays("strainfinger: stdin is compressed with gzip: `zcat FILE | strainfinger decode`", run);
}

TEST(Decode, WhatATerminalWouldObeyIsInNoRow) {
  const Run run = runProgram("decode", "(1609779922.655421) ca\x07 185#E8032201808161A3\n");
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL("", rows(run).c_str());
  checkSays("an interface's name has printable ASCII characters only", run);
}

TEST(Decode, OfManyLinesThatItCannotReadSomeAreTold) {
  std::string rubbish;
  for (int i = 0; i < 25; ++i) rubbish += "rubbish\n";
  const Run run = runProgram("decode", rubbish + "\n");
  LONGS_EQUAL(1, run.status);
  checkSays("stdin:20:8: ", run);
  CHECK(run.err.find("stdin:21:8: ") == std::string::npos);
  checkSays("\nstdin: and 5 more lines that cannot be read\n", run);
  checkSays("25 of 26 lines could not be read: this is no text of candump", run);
  checkSays("25 of 26 lines could not be read; the others are decoded",
            runProgram("decode", rubbish + contact_));
}

TEST(Decode, StrictStopsAtALineItCannotRead) {
  const Run run = runProgram("decode --strict", contact_ + "rubbish\n" + force_);
  LONGS_EQUAL(1, run.status);
  checkSays("strainfinger: stdin:2:8: ", run);
  STRCMP_CONTAINS("CONTACT", run.out.c_str());
  CHECK(run.out.find("FORCE") == std::string::npos);
}

TEST(Decode, StrictPrintsTheTouchOfWhichNoMoreWillCome) {
  const Run run = runProgram("decode --strict --touches", contact_ + force_ + "rubbish\n");
  LONGS_EQUAL(1, run.status);
  LONGS_EQUAL(2, std::ranges::count(run.out, '\n'));
}

TEST(Decode, ReadsALastLineWithoutLineEnd) {
  const Run run = runProgram("decode", contact_.substr(0, contact_.size() - 1));
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("CONTACT", run.out.c_str());
}

TEST(Decode, NothingInIsOnlyAHeader) {
  const Run run = runProgram("decode");
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL("", rows(run).c_str());
  checkSays("0 lines (no frames)", run);
}

TEST(Decode, RefusesAnotherProtocol) {
  const Run run = runProgram("decode", "(1609779922.655421) can0 705#3200004D0E1900A7\n");
  LONGS_EQUAL(5, run.status);
  checkSays("node 5 speaks protocol 3, this program 2", run);
}

TEST(Decode, AFingerOfAnotherProtocolIsToldAtOnceAndHasNoRows) {
  const std::string foreign = "(1609779922.655421) can0 705#3200004D0E1900A7\n";
  const std::string other = "(1609779922.655421) can1 185#E8032201808161A3\n";
  for (const std::string command : {"decode", "decode --touches"}) {
    const Run run = runProgram(command, foreign + contact_ + "rubbish\n" + foreign + force_ + patch_ + other);
    STRCMP_CONTAINS("can1,5,", rows(run).c_str());
    CHECK(rows(run).find("can0") == std::string::npos);
    const std::string warning =
        "decode: warning: stdin:1: can0 node 5 speaks protocol 3, this program 2: use the strainfinger of "
        "its firmware; what it says from here on is left out\n";
    STRCMP_EQUAL(warning.c_str(), run.err.substr(0, warning.size()).c_str());
    CHECK(run.err.find("warning", warning.size()) == std::string::npos);
    checkSays("skipped 5 of fingers that speak another protocol\n", run);
    CHECK(run.err.find("can0 node 5: ") == std::string::npos);
  }
  const Run newFirmware = runProgram("decode", foreign + contact_ + heartbeat_ + force_);
  LONGS_EQUAL(0, newFirmware.status);
  LONGS_EQUAL(2, std::ranges::count(rows(newFirmware), '\n'));
}

TEST(Decode, RefusesTheHeartbeatsOfTheFirstProtocol) {
  const Run run = runProgram("decode", "(1609779922.655421) can0 705#12004D0E190000A7\n");
  LONGS_EQUAL(5, run.status);
  checkSays("node 5 speaks protocol 1, this program 2", run);
}

TEST(Decode, PrintsEachRowWhileItsInputIsStillOpen) {
  // The writer keeps the pipe open until it has seen the row; without the flush this would end by the
  // timeout.
  const Run run = runShell(
      "fifo=$(mktemp -u); mkfifo $fifo\n"
      "{ echo '(0000000001.000000) can0 185#E8032201808161A3'; read -t 10 < $fifo && echo "
      "seen >&2; } |\n"
      "  \"$STRAINFINGER\" decode | grep --line-buffered CONTACT > $fifo\n"
      "rm $fifo");
  checkSays("seen", run);
}

TEST(Decode, AReaderThatLeavesEndsItQuietly) {
  std::string many;
  for (int i = 0; i < 5000; ++i) many += contact_;
  const Run run = runShell("\"$STRAINFINGER\" decode | head -n 1; echo ${PIPESTATUS[0]}", many);
  STRCMP_CONTAINS("time_s", run.out.c_str());
  STRCMP_CONTAINS("\n141\n", run.out.c_str());  // 128 + SIGPIPE, as filters end
  STRCMP_EQUAL("", run.err.c_str());
}

TEST(Decode, AFullDiskIsAFailure) {
  const Run run = runProgram("decode > /dev/full", contact_);
  LONGS_EQUAL(1, run.status);
  checkSays("cannot write the output", run);
}
