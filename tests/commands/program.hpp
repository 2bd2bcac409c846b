#pragma once
// The program, run as a user runs it.

#include <string>

namespace strainfinger {

/// What a run left behind.
struct Run {
  int status = -1;  ///< exit status; 128 + signal if one ended it
  std::string out;
  std::string err;
};

/// Runs `strainfinger <arguments>` in a shell, with `input` on stdin.
Run runProgram(const std::string& arguments, const std::string& input = "");

/// Runs a shell command line in which $STRAINFINGER is the program. `listening PID` waits until a program in
/// the background handles signals, which those on a bus do once it is open. `interrupt PID` there is a
/// Ctrl-C, 0.3 s after a program in the background has begun to listen for it: before that, bash has made it
/// deaf to SIGINT.
Run runShell(const std::string& command, const std::string& input = "");

/// Checks that `strainfinger <arguments>` ends with status 2, a message with `named` in it, and prints
/// nothing.
void checkRefused(const std::string& arguments, const char* named);

}  // namespace strainfinger
