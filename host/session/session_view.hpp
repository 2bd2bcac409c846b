#pragma once
// A session as a screen of text, and as lines.

#include <cstdint>
#include <optional>
#include <string>

#include "host/config/finger_config.hpp"
#include "host/live/canvas.hpp"
#include "host/live/screen.hpp"
#include "host/session/assessment.hpp"
#include "host/session/coverage.hpp"
#include "host/session/session.hpp"

namespace strainfinger::session {

struct SessionView {
  std::string bus;
  int node = 0;
  double time_s = 0;       ///< since the session began
  std::uint64_t sets = 0;  ///< that were heard
  std::uint64_t lost = 0;  ///< frames that this machine missed, and sets that lost a page
  std::size_t rows = 0;
  Coverage coverage{};
  Verdict now = Verdict::kWeak;
  int peakGauge = 0;    ///< that reads most now, of either sign
  double silent_s = 0;  ///< since the last set
  double atRest_s = 0;
  std::string next{};  ///< what to do
  std::optional<Assessment> assessment{};
  bool isFitting = false;
  std::string complaint{};  ///< why the last fit has no result
  std::string message{};    ///< what became of the last command
  std::string prompt{};     ///< what is being typed
};

/// What the keys are, for the foot of the screen.
inline constexpr const char* kSessionKeys = "l load  a angle  u undo  s skip  t tare  q end";

/// A gauge a row; those that have no room are counted.
live::Canvas drawSession(const SessionView& view, const config::Gauges& gauges, const live::ScreenForm& form);

/// "12.3 s  412 touches, .. | Roll it ..": without a line end.
std::string sessionLine(const SessionView& view);

/// "place 0.025 mm (drawn 0.640, noise alone 0.010), normal ..": what is to be expected of touches to come.
std::string errorsText(const TouchesToCome& errors);

/// What a session's rows are good for.
enum class RowsUse {
  kToGoOn,    ///< the same command goes on with them
  kOfFaults,  ///< they were read of gauges and wires that are to be mended
  kOfOldZero  ///< the finger took another zero since: they belong together alone
};

/// How much is kept in the session's files, and how to go on; with what of it the newest fit, if there is
/// one, is not of.
std::string keptText(std::size_t rows, std::optional<std::size_t> fittedRows, RowsUse use,
                     const std::string& strainsPath, const std::string& touchesPath);

/// What the finger does now: "nothing touches it", "too quick" ..
std::string nowText(const SessionView& view);

}  // namespace strainfinger::session
