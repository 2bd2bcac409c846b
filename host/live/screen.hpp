#pragma once
// The fingers of a bus, or of several, as a screen of text.

#include <string>
#include <vector>

#include "host/live/canvas.hpp"
#include "host/live/finger_view.hpp"

namespace strainfinger::live {

/// What there is to draw with.
struct ScreenForm {
  int rows = 24;
  int columns = 80;
  bool unicode = true;  ///< else ASCII alone
};

struct ScreenContent {
  std::vector<BusView> buses{};  ///< one below the other
  std::size_t selected = 0;      ///< which of all the fingers keys are for, counted from above
  std::string message{};         ///< what became of the last key
  std::string keys{};            ///< which there are
};

/// Every finger with its dial and bars where these have room, and warnings in as many rows as are left; else
/// with all its numbers in three rows, else in one row as far as that goes; what has no room is counted at
/// the end.
Canvas drawScreen(const ScreenContent& content, const ScreenForm& form);

}  // namespace strainfinger::live
