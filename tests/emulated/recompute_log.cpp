// recompute_log NODE TABLES < LOG: a candump log of a finger with these tables, through the firmware's code
// on this machine; ends as `strainfinger replay --recompute` does.
#include <fmt/format.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <variant>

#include "host/base/failure.hpp"
#include "host/can/candump_text.hpp"
#include "host/cli/recompute.hpp"
#include "host/tables/table_file.hpp"

using namespace strainfinger;

namespace {

std::optional<can::TimedFrame> nextFrame() {
  for (std::string text; std::getline(std::cin, text);) {
    const auto parsed = can::parseLogLine(text);
    const auto* line = std::get_if<can::LogLine>(&parsed);
    const auto frame = line != nullptr ? can::classicFrame(*line) : std::nullopt;
    if (frame) return can::TimedFrame{line->time_ns.value_or(0), *frame};
  }
  return std::nullopt;
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 3) return 2;
  const auto tables = tables::readTableFile(arguments[2]);
  cli::recompute(nextFrame, *tables, {.node = static_cast<std::uint8_t>(std::atoi(arguments[1]))},
                 TableFormat::kCsv);
  return 0;
} catch (const Failure& failure) {
  fmt::print(stderr, "{}\n", failure.what());
  return static_cast<int>(failure.code());
}
