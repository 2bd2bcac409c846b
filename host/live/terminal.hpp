#pragma once
// The terminal, taken over for a screen that is drawn again and again.

#include <termios.h>

#include <optional>
#include <string>
#include <vector>

#include "host/live/canvas.hpp"
#include "host/live/screen.hpp"

namespace strainfinger::live {

/// Whether stdout is a terminal.
bool hasTerminal();

/// stdin is a terminal: nothing is piped into it.
bool isKeyboard();

/// Size and abilities of the terminal on stdout as they are now.
ScreenForm terminalForm();

/// While it lives, stdout shows its other screen, without a cursor, and keys come one by one, unechoed;
/// Ctrl-C is a signal still. What stood there before comes back at the end.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Draws the canvas over what is there. In colour unless the environment has NO_COLOR (no-color.org).
  /// Throws Failure(kFailure) when the terminal is gone.
  void show(const Canvas& canvas);

  /// The next key that was pressed, if any; an arrow key is its last letter with 0x80 added. Never blocks.
  std::optional<unsigned char> key();

 private:
  int keys_ = -1;  ///< stdin, or the terminal itself where stdin is something else; -1: no keys
  bool ownsKeys_ = false;
  termios before_{};
  bool isStyled_;
};

inline constexpr unsigned char kKeyUp = 0x80 | 'A', kKeyDown = 0x80 | 'B';

}  // namespace strainfinger::live
