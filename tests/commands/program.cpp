#include "tests/commands/program.hpp"

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "CppUTest/TestHarness.h"

namespace strainfinger {
namespace {

/// SigCgt is a mask of 16 hexadecimal digits, and SIGINT its second bit (proc(5)).
constexpr const char* kInterrupt =
    "isListening() { [ /proc/$1/exe -ef \"$STRAINFINGER\" ] && grep -q '^SigCgt:.*[2367abef]$' "
    "/proc/$1/status; }\n"
    "listening() { until isListening $1 || ! kill -0 $1; do sleep 0.02; done; }\n"
    "interrupt() { listening $1; sleep 0.3; kill -INT $1; }\n";

std::string read(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::filesystem::path temporaryFolder() {
  std::string name = std::filesystem::temp_directory_path() / "strainfinger.XXXXXX";
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  return name;
}

}  // namespace

Run runShell(const std::string& command, const std::string& input) {
  const std::filesystem::path folder = temporaryFolder();
  std::ofstream(folder / "in", std::ios::binary) << input;
  std::ofstream(folder / "script") << "STRAINFINGER='" << STRAINFINGER_PROGRAM << "'\n"
                                   << kInterrupt << command << "\n";
  const std::string at = folder.string();
  std::string line = "bash ";
  line.append(at)
      .append("/script <")
      .append(at)
      .append("/in >")
      .append(at)
      .append("/out 2>")
      .append(at)
      .append("/err");
  const int status = std::system(line.c_str());
  Run run{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read(folder / "out"),
          read(folder / "err")};
  std::filesystem::remove_all(folder);
  return run;
}

Run runProgram(const std::string& arguments, const std::string& input) {
  return runShell(std::string("\"$STRAINFINGER\" ").append(arguments), input);
}

void checkRefused(const std::string& arguments, const char* named) {
  const Run run = runProgram(arguments);
  LONGS_EQUAL_TEXT(2, run.status, arguments.c_str());
  STRCMP_CONTAINS(named, run.err.c_str());
  STRCMP_EQUAL("", run.out.c_str());
}

}  // namespace strainfinger
