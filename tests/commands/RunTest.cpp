#include <unistd.h>

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tests/commands/program.hpp"

using namespace strainfinger;

TEST_GROUP(RunCommand) {
  static constexpr const char* kEarly =
      "schema = 1\n[[touch]]\nstart_s = 0.05\nend_s = 1\nangle_deg = 0\nnormal_n_per_m = 20\n";
  static constexpr const char* kNoTouch = "schema = 1\n";

  /// The third words of candump's lines whose identifier is this: 181#DATA.
  static std::vector<std::string> framesOf(const std::string& id, const std::string& log) {
    std::vector<std::string> frames;
    std::istringstream words(log);
    for (std::string word; words >> word;)
      if (word.starts_with(id + "#")) frames.push_back(word);
    return frames;
  }
  static void checkRefused(const Run& run, int status, const char* message) {
    STRCMP_CONTAINS(message, run.err.c_str());
    LONGS_EQUAL(status, run.status);
    STRCMP_EQUAL("", run.out.c_str());
  }
  /// With the input as the file of --scenario.
  static Run withScenario(const std::string& arguments, const char* scenario) {
    return runProgram("run --scenario /dev/stdin " + arguments, scenario);
  }
};

TEST(RunCommand, EachContactHasItsForceAndItsPatch) {
  const Run run = runProgram("run --can loopback --duration 2");
  LONGS_EQUAL(0, run.status);
  const auto contacts = framesOf("181", run.out), forces = framesOf("281", run.out),
             patches = framesOf("381", run.out);
  LONGS_EQUAL(contacts.size(), forces.size());
  LONGS_EQUAL(contacts.size(), patches.size());
  CHECK_TRUE(contacts.size() > 20);  // a finger that nobody calibrated says only what its errors don't cover
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const std::string sequence = contacts[i].substr(18);
    LONGS_EQUAL(i % 256, std::stoul(sequence, nullptr, 16));
    STRCMP_EQUAL(sequence.c_str(), forces[i].substr(18).c_str());
    STRCMP_EQUAL(sequence.c_str(), patches[i].substr(18).c_str());
  }
}

TEST(RunCommand, WarnsOfATouchThatSlips) {
  const auto errorsOf = [](const std::string& tangential_n_per_m) {
    const std::string touch =
        "schema = 1\n[[touch]]\nstart_s = 0.5\nend_s = 1\nangle_deg = 0\nnormal_n_per_m = 20\n"
        "tangential_n_per_m = " +
        tangential_n_per_m;
    return withScenario("", touch.c_str()).err;
  };
  STRCMP_CONTAINS(
      "run: warning: /dev/stdin: touch 1 slips even where it presses most: -30 N/m along are more than",
      errorsOf("-30").c_str());
  CHECK_TRUE(errorsOf("-20").find("slips") == std::string::npos);
}

TEST(RunCommand, DecodeReadsWhatItSends) {
  const Run run = runShell(R"("$STRAINFINGER" run --duration 2 | "$STRAINFINGER" decode)");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("(log, absolute time)", run.err.c_str());
  STRCMP_CONTAINS(", 0 others skipped", run.err.c_str());
  STRCMP_CONTAINS(" frames of touches received, 0 lost, 0 repeated, 0 restarts", run.err.c_str());
  STRCMP_CONTAINS(",loopback,1,CONTACT,", run.out.c_str());
}

TEST(RunCommand, PrintsLogLinesAsCandumpDoes) {
  const Run run = runProgram("run --duration 0.101");
  STRCMP_EQUAL("(0000000000.001000) loopback 701#", run.out.substr(0, 33).c_str());
  STRCMP_CONTAINS("\n(0000000000.101000) loopback 701#22", run.out.c_str());
  STRCMP_CONTAINS("\n(0000000000.001000) loopback 481#0100000100000000\n", run.out.c_str());
  LONGS_EQUAL(3, std::count(run.out.begin(), run.out.end(), '\n'));
}

TEST(RunCommand, TheNodeMayBeAnotherThanTheConfigs) {
  STRCMP_CONTAINS(" loopback 73F#", runProgram("run --duration 0.101 -n 63").out.c_str());
}

TEST(RunCommand, TheSeedDecidesTheOutput) {
  const Run one = runProgram("run --duration 1"), same = runProgram("run --duration 1 --seed 1"),
            other = runProgram("run --duration 1 --seed 2");
  STRCMP_EQUAL(one.out.c_str(), same.out.c_str());
  CHECK_FALSE(one.out == other.out);
}

TEST(RunCommand, SaysHowItWent) {
  const Run run = runProgram("run --duration 1");
  STRCMP_CONTAINS("run: 1.000 s: 1000 sample sets, 0 lost to a late machine; ", run.err.c_str());
  STRCMP_CONTAINS(" 10 HEARTBEAT; 0 touches deferred, 0 incomplete\n", run.err.c_str());
  STRCMP_CONTAINS("mm of arc; normal ", run.err.c_str());
}

TEST(RunCommand, SaysItAsAnObjectToo) {
  const Run run = runProgram("run --duration 1 --json");
  STRCMP_CONTAINS("{\"duration_s\":1.0,\"sample_sets\":1000,\"overruns\":0,", run.err.c_str());
  LONGS_EQUAL(1, std::count(run.err.begin(), run.err.end(), '\n'));
}

TEST(RunCommand, WithoutADurationTheScenarioRunsOnce) {
  STRCMP_CONTAINS("run: 10.000 s: 10000 sample sets", runProgram("run").err.c_str());
}

TEST(RunCommand, AScenarioWithoutAnEndNeedsADuration) {
  checkRefused(withScenario("", kNoTouch), 2, "give --duration S");
  LONGS_EQUAL(0, withScenario("--duration 0.1", kNoTouch).status);
}

TEST(RunCommand, ATouchDuringTheZeroIsRefused) {
  checkRefused(
      withScenario("", kEarly), 2,
      "/dev/stdin touches the finger at 0.050 s, while it takes the zero of its gauges: let the first "
      "touch start_s be 0.1 or later");
}

TEST(RunCommand, TheTruthStandsBesideTheEstimateAndNotInTheOutput) {
  const Run run = runProgram("run --duration 1 --truth"), plain = runProgram("run --duration 1");
  STRCMP_CONTAINS("  0.250 |      -        -        - | nothing\n", run.err.c_str());
  STRCMP_CONTAINS(" |  40.00    20.00", run.err.c_str());
  STRCMP_EQUAL(plain.out.c_str(), run.out.c_str());
}

TEST(RunCommand, DrawsPictures) {
  const Run run = runShell(
      "d=$(mktemp -d); \"$STRAINFINGER\" run --duration 1 --picture $d/a.png --picture $d/a.svg >/dev/null; "
      "head -c 4 $d/a.png | tail -c 3; grep -c '</svg>' $d/a.svg; rm -r $d");
  STRCMP_EQUAL("PNG1\n", run.out.c_str());
}

TEST(RunCommand, TheDrawnFitKnowsHowDeepEachGaugeIs) {
  const Run run = runShell(R"(
d=$(mktemp -d); cd $d
depths=$(printf '5e-5, -5e-5, %.0s' 1 2 3 4 5 6 7 8)
printf 'schema = 1\n[gauges]\nmodel_error = 0.0005\n[calibration]\ndepth_offset_m = [%s]\n' "${depths%, }" >f.toml
"$STRAINFINGER" run -c f.toml --picture a.svg >/dev/null 2>&1
tail -n +2 a-readings.csv | awk -F, '{ if ($3 > 5 * $4 || $3 < -5 * $4) ++many } END { print NR, many + 0 }'
rm -r $d)");
  STRCMP_EQUAL("16 0\n", run.out.c_str());
}

TEST(RunCommand, KeepsTimeOnABusAndObeys) {
  const Run run = runShell(R"(
"$STRAINFINGER" run --can udp:19997 --duration 4 & finger=$!
for _ in $(seq 10); do "$STRAINFINGER" config --can udp:19997 --contact-rate-hz 200 && break; done; wait $finger)");
  STRCMP_EQUAL("interface,node,command,status\nudp:19997,1,contact_rate,done\n", run.out.c_str());
  STRCMP_CONTAINS("run: 4.0", run.err.c_str());
  LONGS_EQUAL(0, run.status);
}

TEST(RunCommand, WritesWhatCalibrateShapeAndLocateRead) {
  const Run run = runShell(R"(
d=$(mktemp -d); cd $d
"$STRAINFINGER" run --strains s.csv --touches k.csv >/dev/null 2>&1
head -1 s.csv; head -1 k.csv; wc -l <s.csv; wc -l <k.csv
"$STRAINFINGER" calibrate --strains s.csv --touches k.csv | cut -d, -f3 | tail -n +2 | tr '\n' ' '
"$STRAINFINGER" locate <s.csv | cut -d, -f1-2 | head -1
rm -r $d)");
  STRCMP_CONTAINS("time_s,strain_0,", run.out.c_str());
  STRCMP_CONTAINS("\nangle_deg,normal_n_per_m,tangential_n_per_m\n", run.out.c_str());
  STRCMP_CONTAINS(" time_s,contact\n", run.out.c_str());
  STRCMP_CONTAINS("1.00", run.out.c_str());
}

TEST(RunCommand, RowsAreAsManyASecondAsAskedAndEvenlySpaced) {
  for (const int rate_hz : {100, 1000}) {
    const Run run = runProgram("run --duration 2 --rows-hz " + std::to_string(rate_hz) +
                               " --strains /dev/stderr 2>&1 >/dev/null");
    LONGS_EQUAL(0, run.status);
    std::istringstream lines(run.out.substr(run.out.find("time_s,")));
    std::string line;
    std::getline(lines, line);
    double before_s = -1;
    int rows = 0;
    while (std::getline(lines, line)) {
      const double time_s = std::stod(line);
      if (rows++ > 1) DOUBLES_EQUAL(1.0 / rate_hz, time_s - before_s, 1e-6);
      before_s = time_s;
    }
    CHECK_COMPARE(rows, >, 1.9 * rate_hz);  // the zero comes first, and may end between two rows
  }
}

// A load that begins at 0 while something already pulls, which would be no touch to `calibrate`.
TEST(RunCommand, NothingTouchesUntilItPresses) {
  const Run run =
      withScenario("--rows-hz 10 --touches /dev/stderr 2>&1 >/dev/null",
                   "schema = 1\n[[touch]]\nstart_s = 0.18\nend_s = 0.35\nangle_deg = 45\n"
                   "normal_n_per_m = [[0, 0], [0.05, 0], [0.1, 20]]\ntangential_n_per_m = 1.06\n");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("angle_deg,normal_n_per_m,tangential_n_per_m\n0,0,0\n0,0,0\n0,0,0\n45,20,1.06\n",
                  run.out.c_str());
}

// `locate` is tested with them; a row of touches has room for one.
TEST(RunCommand, WhileSeveralTouchesActThereAreRowsToo) {
  constexpr const char* kTwo =
      "schema = 1\n[[touch]]\nstart_s = 0.12\nend_s = 0.38\nangle_deg = 45\nnormal_n_per_m = 20\n"
      "[[touch]]\nstart_s = 0.25\nend_s = 0.38\nangle_deg = 225\nnormal_n_per_m = 20\n";
  const Run touches = withScenario("--rows-hz 10 --touches /dev/stderr 2>&1 >/dev/null", kTwo);
  STRCMP_CONTAINS("tangential_n_per_m\n0,0,0\n0,0,0\n45,20,0\n,,\n", touches.out.c_str());
  const Run strains = withScenario("--rows-hz 10 --strains /dev/stderr 2>&1 >/dev/null", kTwo);
  STRCMP_CONTAINS("\n0.300000,", strains.out.c_str());
}

TEST(RunCommand, AFileThatCannotBeWrittenIsAFailure) {
  const Run run = runProgram("run --duration 0.2 --strains /nowhere/s.csv");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("/nowhere/s.csv", run.err.c_str());
}

// A run may take hours.
TEST(RunCommand, AnOutputThatCannotBeIsToldBeforeTheRun) {
  for (const std::string option : {"--strains", "--touches", "--picture"}) {
    const Run run = runShell("folder=$(mktemp -d --suffix .svg) && trap 'rmdir \"$folder\"' EXIT && " +
                             ("\"$STRAINFINGER\" run --duration 0.2 " + option) + " \"$folder\"");
    LONGS_EQUAL(1, run.status);
    STRCMP_CONTAINS(": this is a folder; name a file", run.err.c_str());
    STRCMP_EQUAL("", run.out.c_str());
  }
}

// Root may write anywhere: for others to see.
TEST(RunCommand, AFolderThatCannotBeWrittenToIsToldBeforeTheRun) {
  if (::access("/usr", W_OK) == 0) return;
  const Run run = runProgram("run --duration 0.2 --strains /usr/s.csv");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("--strains /usr/s.csv: no file can be made in the folder /usr: ", run.err.c_str());
  STRCMP_EQUAL("", run.out.c_str());
}

TEST(RunCommand, TheNodeIsTheConfigs) {
  const Run run = runProgram("run --duration 1 -c /dev/stdin", "schema = 1\n[can]\nnode = 9\n");
  LONGS_EQUAL(0, framesOf("181", run.out).size());
  CHECK_FALSE(framesOf("189", run.out).empty());
}

TEST(RunCommand, RunsOnTablesFromAFile) {
  const Run run = runShell(
      "t=$(mktemp); \"$STRAINFINGER\" tables -o $t 2>/dev/null; cmp <(\"$STRAINFINGER\" run --duration 1 "
      "2>/dev/null) <(\"$STRAINFINGER\" run --duration 1 --tables $t 2>/dev/null) && echo same; rm $t");
  STRCMP_EQUAL("same\n", run.out.c_str());
}

TEST(RunCommand, RefusesTablesOfAnotherFinger) {
  const Run run = runShell(
      "t=$(mktemp); echo -e 'schema = 1\\n[gauges]\\ncount = 24' | \"$STRAINFINGER\" tables -c /dev/stdin -o "
      "$t; \"$STRAINFINGER\" run --tables $t; status=$?; rm $t; exit $status");
  checkRefused(run, 5, "gauges.count is 24, the config has 16");
}

TEST(RunCommand, UncalibratedItKnowsNoMoreThanAFingerThatNobodyCalibrated) {
  const Run run = runShell(R"(
    folder=$(mktemp -d) && trap 'rm -rf "$folder"' EXIT && cd "$folder"
    gains='[calibration]\ngain = [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n'
    printf "schema = 1\n[gauges]\nmodel_error = 0.001\n$gains" >sure
    printf "schema = 1\n[gauges]\nmodel_error = 0.1\n$gains" >unsure
    printf 'schema = 1\n' >default
    printf 'schema = 1\n[gauges]\nmodel_error = 0.1\n' >tenth
    told() {
      "$STRAINFINGER" run -c $1 --duration 1 $2 2>/dev/null | "$STRAINFINGER" decode --touches 2>/dev/null | cut -d, -f1-13
    }
    cmp <(told sure --uncalibrated) <(told default) && echo as one of the default error
    cmp <(told unsure --uncalibrated) <(told tenth) && echo as one of the larger error
    cmp -s <(told sure --uncalibrated) <(told sure) || echo otherwise than calibrated
    [ $(told default | wc -l) -gt 100 ] && echo of many touches)");
  STRCMP_EQUAL(
      "as one of the default error\nas one of the larger error\notherwise than calibrated\nof many touches\n",
      run.out.c_str());
}

TEST(RunCommand, UncalibratedTablesAreNoFiles) {
  checkRefused(runProgram("run --uncalibrated --tables x"), 2, "--uncalibrated makes tables of its own");
}

TEST(RunCommand, RefusesDamagedTables) {
  const Run run = runShell(
      "t=$(mktemp); \"$STRAINFINGER\" tables -o $t; printf X | dd of=$t bs=1 seek=500 conv=notrunc "
      "2>/dev/null; \"$STRAINFINGER\" run --tables $t; status=$?; rm $t; exit $status");
  checkRefused(run, 6, "CRC-32 does not match");
}

TEST(RunCommand, ThreePointModeSendsOtherFrames) {
  const Run refined = runProgram("run --duration 1"),
            three = runProgram("run --duration 1 --mode three-point");
  LONGS_EQUAL(0, three.status);
  CHECK_FALSE(refined.out == three.out);
}

TEST(RunCommand, ATouchThatIsWiderThanTheFingerIsLongRoundIsRefused) {
  const Run run = withScenario(
      "",
      "schema = 1\n[[touch]]\nstart_s = 0.5\nend_s = 1\nangle_deg = 0\nnormal_n_per_m = 9\nwidth_m = 0.09\n");
  LONGS_EQUAL(2, run.status);
  STRCMP_CONTAINS("touch.width_m = 0.09 goes more than once round the finger, 0.0798 m", run.err.c_str());
}

TEST(RunCommand, AMissingInterfaceIsSaidWithItsRemedy) {
  const Run run = runProgram("run --can nocan7 --duration 1");
  checkRefused(run, 3, "nocan7");
  STRCMP_CONTAINS("`", run.err.c_str());
}

TEST(RunCommand, NamesAGaugeThatFails) {
  const Run run = runProgram("run --duration 3 --fault open:2@1.5");
  STRCMP_CONTAINS("run: gauges out of use at the end: 2\n", run.err.c_str());
  STRCMP_CONTAINS("loopback 081#04000000", run.out.c_str());
}

// Its zero is taken at the rail, so that it seems to read nothing.
TEST(RunCommand, NamesAGaugeThatFailedBeforeItsZeroWasTaken) {
  for (const std::string kind : {"open", "short"}) {
    const Run run = withScenario("--duration 2 --fault " + kind + ":2", kNoTouch);
    STRCMP_CONTAINS("run: gauges out of use at the end: 2\n", run.err.c_str());
    STRCMP_CONTAINS("loopback 081#04000000", run.out.c_str());
  }
}

TEST(RunCommand, SaysForHowLongATouchWasNotTold) {
  const char* const faint =
      "schema = 1\n[[touch]]\nstart_s = 0.5\nend_s = 1.5\nangle_deg = 0\nnormal_n_per_m = 0.01\n";
  STRCMP_CONTAINS("run: touched for 1.000 s without a reported contact\n",
                  withScenario("", faint).err.c_str());
  STRCMP_CONTAINS("\"untold_s\":1.0", withScenario("--json", faint).err.c_str());
}

TEST(RunCommand, AFingerThatIsNotAsDrawnIsFlaggedUncalibrated) {
  const auto flagsWith = [](const std::string& asBuilt) {
    return runShell("\"$STRAINFINGER\" run --duration 1 -c <(printf 'schema = 1\\n" + asBuilt +
                    "') 2>&- | \"$STRAINFINGER\" decode 2>&-")
        .out;
  };
  STRCMP_CONTAINS("uncalibrated", flagsWith("[as_built]\\ngain = 0.03\\n").c_str());
  CHECK_TRUE(flagsWith("").find("+uncalibrated") == std::string::npos);
}

TEST(RunCommand, UncalibratedModelErrorIsThatOfAnyFingerNobodyCalibrated) {
  const Run run = runShell(R"(
    told() { "$STRAINFINGER" run -c <(printf "schema = 1\n[gauges]\nmodel_error = $1\n") --duration 1 $2 2>/dev/null; }
    cmp <(told 0.001 --uncalibrated) <(told 0.05) && echo same; told 0.05 | grep -c " 181#" | grep -q ... && echo of many touches)");
  STRCMP_EQUAL("same\nof many touches\n", run.out.c_str());
}

TEST(RunCommand, ThreePointModeOfAnUnknownWidthIsWarnedOf) {
  STRCMP_CONTAINS("run: warning: --mode three-point takes every contact for a line",
                  runProgram("run --duration 0.2 --mode three-point").err.c_str());
  const Run known = runShell(
      "\"$STRAINFINGER\" run --duration 0.2 --mode three-point -c <(printf "
      "'schema = 1\\n[contact]\\nwidth_m = 0\\n')");
  LONGS_EQUAL(0, known.status);
  CHECK_TRUE(known.err.find("warning") == std::string::npos);
}

TEST(RunCommand, NamesAGaugeThatIsNoisy) {
  const Run run = runProgram("run --duration 3 --fault noisy:2");
  STRCMP_CONTAINS("run: gauges out of use at the end: 2\n", run.err.c_str());
  STRCMP_CONTAINS("loopback 081#04000000", run.out.c_str());
}

TEST(RunCommand, RefusesAFaultThatIsNone) {
  checkRefused(runProgram("run --fault dull:2"), 2, "--fault dull:2: must be KIND:GAUGE");
  checkRefused(runProgram("run --fault dead:16"), 2, "there is no gauge 16; they are 0 to 15");
  checkRefused(runProgram("run --fault dead:5@9 --duration 0.5"), 2,
               "--fault dead:5@9: the run ends before, at 0.5 s");
}

TEST(RunCommand, RefusesWhatIsOutsideTheDomain) {
  checkRefused(runProgram("run --duration 0"), 2, "--duration");
  checkRefused(runProgram("run --duration nan"), 2, "--duration");
  for (const std::string seed : {"-1", "1.5", "18446744073709551616", "x"})
    checkRefused(runProgram("run --seed " + seed), 2,
                 ("--seed: " + seed + " is not a whole number from 0 to 18446744073709551615\n").c_str());
  checkRefused(runProgram("run --mode best"), 2, "--mode");
  checkRefused(runProgram("run --rows-hz 10"), 2,
               "--rows-hz is of --strains and --touches: give one of them");
  checkRefused(runProgram("run --picture touch.bmp"), 2, "pictures are .svg or .png");
  checkRefused(runProgram("run --scenario /nowhere.toml"), 2, "/nowhere.toml");
}

TEST(RunCommand, InterruptedItSumsUpAndSaysSo) {
  for (const std::string signal : {"INT", "TERM"}) {
    const Run run = runShell(
        "set -m; out=$(mktemp); \"$STRAINFINGER\" run --duration 1000000 >$out & "
        "until [ -s $out ]; do sleep 0.02; done; kill -" +
        signal + " $!; wait $!; status=$?; rm $out; exit $status");
    LONGS_EQUAL(130, run.status);
    STRCMP_CONTAINS(" touches, ", run.err.c_str());
    STRCMP_CONTAINS("strainfinger: run: interrupted after ", run.err.c_str());
  }
}

TEST(RunCommand, AFullDiskIsAFailure) {
  const Run run = runProgram("run --duration 2 > /dev/full");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("cannot write the output", run.err.c_str());
}
