#include <string>

#include "tests/commands/program.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Main) {};

TEST(Main, WhatIsNoCommandIsNamed) {
  checkRefused("locat", "strainfinger: locat is no command; strainfinger --help lists them\n");
  checkRefused("locat --json -c x", "strainfinger: locat is no command");
  checkRefused("--jsn", "strainfinger: --jsn is no command");
  checkRefused("locat --help", "strainfinger: locat is no command");
}

TEST(Main, AMissingCommandIsAUsageError) { checkRefused("", "A subcommand is required"); }

TEST(Main, AWholeNumberIsAskedForAsOne) {
  checkRefused("strain --radius-m 0.008 --points 1e3", "1e3 is not a whole number from 1 to ");
  checkRefused("dbc -n 010", "010 is not a whole number from 1 to 63");
  checkRefused("run --seed 010", "010 is not a whole number");
  checkRefused("strains --can udp --rows 010", "010 is not a whole number");
  checkRefused("strains --can udp --rows 0", "0 is not a whole number from 1 to ");
  checkRefused("strain --radius-m ''", " is not a number from 0 to 1");
  checkRefused("dbc -n 0x10", "0x10 is not a whole number from 1 to 63");
  checkRefused("dbc -n 64", "64 is not a whole number from 1 to 63");
}

TEST(Main, WhatIsLeftOverBehindACommandIsNamed) { checkRefused("dbc over", "over"); }

// Rather than that the one that was meant is missing.
TEST(Main, AnOptionThatIsNoneIsNamedWithTheOneThatIsNear) {
  checkRefused(
      "response --radius 9e-3 --harmonics 3",
      "strainfinger: response: --radius is no option, --radius-m is; strainfinger response --help lists "
      "them\n");
  checkRefused("decode --jsno x", "decode: --jsno is no option, --json is;");
  checkRefused("decode --quietly x", "decode: --quietly is no option; strainfinger decode --help");
  checkRefused("dbc -q", "dbc: -q is no option; ");
  checkRefused("plot -- touch.log", "--output is required");
}

TEST(Main, HelpIsNoError) {
  const Run run = runProgram("--help");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("\n  locate ", run.out.c_str());
}

TEST(Main, HelpHasTheFirstLineOfACommand) {
  const Run run = runProgram("--help");
  STRCMP_CONTAINS("\n  tare                        Lets a finger take the zero of its gauges now. ",
                  run.out.c_str());
  CHECK_TRUE(run.out.find("Exit status") == std::string::npos);
  STRCMP_CONTAINS("--force takes the zero anyway", runProgram("tare --help").out.c_str());
}

TEST(Main, HelpNamesTheColumns) {
  const Run run = runShell(R"(
unnamed() { help=$("$STRAINFINGER" $1 --help); tr -s ',' '\n' | while read column; do
  grep -qw "$column" <<<"$help" && echo $1 >>named.$$ || echo "$1: $column"; done; }
indenter="--indenter cylinder:5e-3 --load-n-per-m 20"
for command in "contact $indenter" "contact --summary $indenter" "field $indenter" "shape" "shape --pressure"; do
  "$STRAINFINGER" $command </dev/null 2>/dev/null | head -n 1 | unnamed ${command%% *}
done
"$STRAINFINGER" run --json --duration 0.1 --touches touches.$$ 2>&1 >/dev/null | grep -o '"[a-z_]*":' | tr -d '":' | unnamed run
head -n 1 touches.$$ | unnamed run
sort named.$$ | uniq -c | tr -s ' \n' ' '; rm named.$$ touches.$$)");
  STRCMP_EQUAL(" 10 contact 10 field 25 run 26 shape ", run.out.c_str());
}

TEST(Main, OutputThatCannotBeWrittenIsAFailure) {
  for (const char* command : {"--help", "--version", "tare --help", "dbc"}) {
    const Run run = runShell(std::string("\"$STRAINFINGER\" ") + command + " >/dev/full");
    LONGS_EQUAL_TEXT(1, run.status, command);
    STRCMP_CONTAINS("cannot write the output", run.err.c_str());
  }
}

TEST(Main, MessagesThatCannotBeWrittenLeaveTheExitStatus) {
  for (const char* nowhere : {"2>/dev/full", "2>&-"})
    LONGS_EQUAL(0, runShell(std::string("\"$STRAINFINGER\" tables --header /dev/null ") + nowhere).status);
  LONGS_EQUAL(2, runShell("\"$STRAINFINGER\" nosuch 2>/dev/full").status);
  LONGS_EQUAL(2, runShell("\"$STRAINFINGER\" dbc -c '' 2>/dev/full").status);
}

// A run is long, and its rows are what it was for.
TEST(Main, MessagesThatCannotBeWrittenKeepNoFileFromBeingWritten) {
  for (const char* more : {"", " --json", " --truth"}) {
    const Run run =
        runShell(std::string("rows=$(mktemp) && trap 'rm $rows' EXIT\n"
                             "\"$STRAINFINGER\" run --duration 0.5 --strains $rows 2>/dev/full >/dev/null") +
                 more + "; echo $?; grep -c . $rows");
    STRCMP_EQUAL("0\n46\n", run.out.c_str());
  }
}

// Its number would be the next file's that is opened, and messages would end there.
TEST(Main, MessagesDontGoIntoAFileWhereThereIsNoStderr) {
  const Run run = runShell(R"sh(folder=$(mktemp -d) && trap 'rm -rf "$folder"' EXIT
"$STRAINFINGER" record --can udp:29999 --duration 0.1 -o $folder/x.log 2>&- && cat $folder/x.log)sh");
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL("", run.out.c_str());
}

TEST(Main, AnEmptyFileNameIsRefused) {
  checkRefused("dbc -c ''", "dbc: --config: the name of a file is missing");
  checkRefused("dbc -o ''", "dbc: --output: the name of a file is missing");
  checkRefused("locate --tables ''", "locate: --tables: the name of a file is missing");
  checkRefused("run --scenario ''", "run: --scenario: the name of a file is missing");
  checkRefused("push --can udp ''", "push: FILE: the name of a file is missing");
  checkRefused("tables info ''", "tables: FILE: the name of a file is missing");
}

TEST(Main, AFileIsNotOverwrittenByWhatIsMadeFromIt) {
  const Run run = runShell(R"sh(folder=$(mktemp -d) && trap 'rm -rf "$folder"' EXIT && cd "$folder"
printf 'schema = 1\n' >f.toml
for command in "tables -c f.toml -o ./f.toml" "dbc -c f.toml -o $folder/f.toml" "calibrate --strains f.toml -o f.toml" \
    "calibrate -c f.toml --strains new.csv -o ./f.toml" "calibrate -c f.toml --can udp -o f.toml" \
    "run --duration 0.1 --strains new.csv --touches new.csv"; do
  "$STRAINFINGER" $command; echo $?
done
ls; cat f.toml; "$STRAINFINGER" run --duration 0.1 --strains /dev/null --touches /dev/null >/dev/null 2>&1; echo $?)sh");
  STRCMP_EQUAL("2\n2\n2\n2\n2\n2\nf.toml\nschema = 1\n0\n", run.out.c_str());
  STRCMP_CONTAINS("tables: --config and --output name the same file, ./f.toml: name another for one",
                  run.err.c_str());
}

TEST(Main, WhatAPictureWritesBesideItIsNotOverwritten) {
  checkRefused("run --strains a-track.csv --picture a.svg",
               "run: --picture writes a-track.csv as well, which --strains names: name another for one");
  checkRefused("run --touches ./a.gp --picture a.png",
               "run: --picture writes a.gp as well, which --touches names");
  checkRefused("plot a-angle.csv -o a.png", "plot: --output writes a-angle.csv as well, which log names");
  checkRefused("design -c a-fingers.csv --picture a.svg", "design: --picture writes a-fingers.csv as well");
}

TEST(Main, AControlCharacterOfAnArgumentDoesntReachTheTerminal) {
  for (const char* argument : {"\\033[31mX", "\\302\\23331mX"}) {
    const Run run = runShell(std::string("\"$STRAINFINGER\" tables \"$(printf '") + argument +
                             "')\"; "
                             "\"$STRAINFINGER\" dbc -c \"$(printf '" +
                             argument + "')\"");
    LONGS_EQUAL(2, run.status);
    CHECK_TRUE(run.err.find('\033') == std::string::npos && run.err.find('\233') == std::string::npos);
    STRCMP_CONTAINS("31mX", run.err.c_str());
  }
}

TEST(Main, NamesThatNoFileCanHaveAreNotTakenForOne) {
  const std::string name(300, 'a');
  checkRefused("dbc -c " + name + " -o b" + name, "cannot read");
}

// What a terminal would obey.
TEST(Main, ControlCharactersOfAFileDontReachTheTerminal) {
  const Run run =
      runShell(R"sh(printf 'schema = 1\n"a\\u001b[31m" = 1\n' | "$STRAINFINGER" dbc -c /dev/stdin)sh");
  LONGS_EQUAL(2, run.status);
  STRCMP_CONTAINS("\\x1B[31m", run.err.c_str());
  CHECK_TRUE(run.err.find('\033') == std::string::npos);
}

TEST(Main, OfALongWordThatIsWrongTheBeginningIsSaid) {
  const std::string word(5000, 'a');
  for (const std::string& arguments :
       {word, "explain " + word, "explain 185#" + word, "run --fault " + word, "run --can " + word,
        "run --seed " + word, "decode --" + word, "decode --node " + word, "design --gauges " + word,
        "design --radius-m " + word, "contact --width-m 1e-3 --indenter " + word}) {
    const Run run = runProgram(arguments);
    CHECK_COMPARE(run.err.size(), <, 400);
    STRCMP_CONTAINS("aaaa..", run.err.c_str());
  }
}

TEST(Main, AConfigMayBeAPipeHoweverOftenACommandAsksForIt) {
  const Run run = runShell("\"$STRAINFINGER\" monitor --plain -c <(echo 'schema = 1') </dev/null");
  LONGS_EQUAL_TEXT(0, run.status, run.err.c_str());
}
