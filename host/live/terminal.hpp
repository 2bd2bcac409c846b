#pragma once
// The terminal, taken over for a screen that is drawn again and again.

#include <termios.h>

#include <optional>
#include <string>
#include <vector>

#include "host/live/canvas.hpp"
#include "host/live/job_control.hpp"
#include "host/live/screen.hpp"

namespace strainfinger::live {

/// Whether stdout is a terminal that a screen can be drawn on: by TERM not a dumb one.
bool hasTerminal();

/// stdin is a terminal: nothing is piped into it.
bool isKeyboard();

/// Size and abilities of the terminal on stdout as they are now.
ScreenForm terminalForm();

/// While it lives, keys come one by one, unechoed; Ctrl-C is a signal still.
class Keyboard {
 public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// The next byte that was typed, if any. Never blocks, whatever others do to the terminal's modes.
  std::optional<unsigned char> next() const;

  /// Gives the terminal its modes of before, for the shell.
  void release() const;
  /// Takes the keys one by one again.
  void takeOver() const;

 private:
  /// The terminal, opened anew, because O_NONBLOCK of stdin's own description would hold for other processes
  /// that share it. -1: no keys.
  int file_;
  termios before_{};
  bool hasModes_;  ///< before_ is known
};

/// While it lives, stdout shows its other screen, without a cursor, and its keyboard is a Keyboard. What
/// stood there before comes back at the end, and while the shell has stopped the process (Ctrl-Z): key() and
/// show() look whether it is to be stopped, and set the screen up again when it was continued.
class Terminal {
 public:
  /// Throws Failure(kFailure) when the terminal is gone.
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
  void followJobControl();

  JobControl jobControl_;  // before the keyboard: a late stop finds that given back
  Keyboard keyboard_;
  bool isStyled_;
};

inline constexpr unsigned char kKeyUp = 0x80 | 'A', kKeyDown = 0x80 | 'B';

}  // namespace strainfinger::live
