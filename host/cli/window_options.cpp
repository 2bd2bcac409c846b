#include "host/cli/window_options.hpp"

#include <optional>
#include <string>

namespace strainfinger::cli {
namespace {

void addMoment(CLI::App& command, const char* name, const char* help, std::optional<can::LogMoment>& moment) {
  command
      .add_option_function<std::string>(
          name, [&moment](const std::string& text) { moment = can::readMoment(text); }, help)
      ->type_name("TIME")
      ->check([](const std::string& text) {
        return can::readMoment(text) ? ""
                                     : "no time: give seconds as the log has them (1764385920.5), +S after "
                                       "its first frame (+12.5), or a date (2026-11-29T03:12, with a Z "
                                       "behind it in UTC, with +02:00 in that zone)";
      });
}

}  // namespace

void addWindowOptions(CLI::App& command, can::TimeWindow& window) {
  addMoment(command, "--from",
            "Only what the log has from then on: seconds as it has them, +S after its first frame, or a date "
            "as 2026-11-29T03:12:00 (of this machine's time zone; UTC with a Z behind it)",
            window.from);
  addMoment(command, "--to", "Only what the log has until then, as --from", window.to);
  command.parse_complete_callback([&window] {
    if (window.isEmpty()) throw CLI::ValidationError("--from", "is later than --to");
  });
}

}  // namespace strainfinger::cli
