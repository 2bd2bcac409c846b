#include "tests/commands/with_finger.hpp"

#include <unistd.h>

#include "CppUTest/TestHarness.h"

namespace strainfinger {
namespace {

constexpr int kNotHeard = 97;

/// The shell's: of this test run's own.
std::string ownBus() { return "BUS=udp:" + std::to_string(20'000 + getpid() % 40'000) + "\n"; }

}  // namespace

Run withFinger(const std::string& options, const std::string& script) {
  const Run run =
      runShell(ownBus() + "set -o pipefail\n\"$STRAINFINGER\" run --can $BUS --duration 30 " + options +
               R"( 2>/dev/null & finger=$!
trap 'kill -INT $finger 2>/dev/null; wait $finger' EXIT  # however the script ends
heard=
for _ in $(seq 100); do
  "$STRAINFINGER" config --can $BUS --contact-rate-hz 100 >/dev/null 2>&1 && heard=yes && break
  kill -0 $finger 2>/dev/null && sleep 0.1 || break
done
if [ -z "$heard" ]; then
  echo "the finger on $BUS is not heard" >&2
  exit )" + std::to_string(kNotHeard) +
               "\nfi\n" + script + "\n");
  if (run.status == kNotHeard) FAIL(run.err.c_str());
  return run;
}

Run withFingerAndTwin(const std::string& options, const std::string& script) {
  return withFinger(options, "\"$STRAINFINGER\" run --can $BUS --duration 30 --seed 3 " + options +
                                 " 2>/dev/null & twin=$!\n"
                                 "endTwin() { kill -INT $twin 2>/dev/null; wait $twin 2>/dev/null; }\n"
                                 "trap 'endTwin; kill -INT $finger 2>/dev/null; wait $finger' EXIT\n"
                                 "listening $twin; sleep 0.3\n" +
                                 script);
}

Run whileHearing(const std::string& lines, const std::string& arguments) {
  return runShell(ownBus() + "log=$(mktemp); trap 'rm $log' EXIT; cat >$log\n\"$STRAINFINGER\" " + arguments +
                      R"( --can $BUS & listener=$!; listening $listener
"$STRAINFINGER" replay --can $BUS $log 2>/dev/null; wait $listener)",
                  lines);
}

std::string interfacesAre(const std::string& json) {
  return "tools=$(mktemp -d); trap 'rm -r $tools' EXIT\n"
         "cat >$tools/ip <<'END'\n#!/bin/sh\ncat <<'JSON'\n" +
         json + "\nJSON\nEND\nchmod +x $tools/ip; PATH=$tools:$PATH\n";
}

}  // namespace strainfinger
