#include "host/live/terminal.hpp"

#include <fcntl.h>
#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "host/base/failure.hpp"

namespace strainfinger::live {
namespace {

// Of xterm, and of all that followed it: see console_codes(4).
constexpr const char* kOtherScreen = "\033[?1049h\033[?25l\033[2J";
constexpr const char* kFirstScreen = "\033[0m\033[?25h\033[?1049l";
constexpr const char* kHome = "\033[H";
constexpr const char* kEndLine = "\033[K";
constexpr const char* kClearBelow = "\033[J";

void writeOut(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw Failure(ExitCode::kFailure, "cannot write the output: the terminal is gone");
}

bool isUtf8() {
  std::setlocale(LC_CTYPE, "");
  return std::strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
}

bool wantsColour() {
  const char* refused = std::getenv("NO_COLOR");
  return refused == nullptr || *refused == '\0';
}

void showFirstScreen() {
  std::fputs(kFirstScreen, stdout);
  std::fflush(stdout);
}

/// That of stdin or, where stdin is something else or is another user's, the process's own; -1: there is
/// none. O_NONBLOCK, since a shell's modes, unlike VMIN = 0, would have a read wait for a whole line.
int openTerminal() {
  constexpr int kHow = O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;
  const int file = isKeyboard() ? ::open("/proc/self/fd/0", kHow) : -1;
  return file >= 0 ? file : ::open("/dev/tty", kHow);
}

/// Such as a shell within an editor is not one: it would show the escape sequences.
bool obeysEscapes() {
  const char* kind = std::getenv("TERM");
  return kind != nullptr && *kind != '\0' && std::strcmp(kind, "dumb") != 0;
}

}  // namespace

bool hasTerminal() { return isatty(STDOUT_FILENO) == 1 && obeysEscapes(); }

bool isKeyboard() { return isatty(STDIN_FILENO) == 1; }

ScreenForm terminalForm() {
  ScreenForm form{.unicode = isUtf8()};
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0) {
    form.rows = size.ws_row;
    form.columns = size.ws_col;
  }
  return form;
}

Keyboard::Keyboard() : file_(openTerminal()), hasModes_(file_ >= 0 && tcgetattr(file_, &before_) == 0) {
  takeOver();
}

Keyboard::~Keyboard() {
  if (file_ < 0) return;
  release();
  ::close(file_);
}

void Keyboard::takeOver() const {
  if (!hasModes_) return;
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  tcsetattr(file_, TCSANOW, &raw);
}

void Keyboard::release() const {
  if (hasModes_) tcsetattr(file_, TCSANOW, &before_);
}

std::optional<unsigned char> Keyboard::next() const {
  unsigned char byte = 0;
  return file_ >= 0 && ::read(file_, &byte, 1) == 1 ? std::optional(byte) : std::nullopt;
}

Terminal::Terminal() : isStyled_(wantsColour()) { writeOut(kOtherScreen); }

Terminal::~Terminal() { showFirstScreen(); }

void Terminal::followJobControl() {
  const bool isGivenBack = jobControl_.stopAsked();
  if (isGivenBack) {
    showFirstScreen();
    keyboard_.release();
    jobControl_.stop();
  }
  if (!jobControl_.takeContinued() && !isGivenBack) return;
  keyboard_.takeOver();
  writeOut(kOtherScreen);
}

void Terminal::show(const Canvas& canvas) {
  followJobControl();
  std::string text = kHome;
  const auto lines = canvas.lines(isStyled_);
  for (std::size_t i = 0; i < lines.size(); ++i)
    text.append(i > 0 ? "\r\n" : "").append(lines[i]).append(kEndLine);
  writeOut(text + kClearBelow);
}

std::optional<unsigned char> Terminal::key() {
  followJobControl();
  const auto first = keyboard_.next();
  if (first != 0x1B) return first;
  const auto second = keyboard_.next();  // an arrow is ESC [ A
  if (second != '[') return first;
  const auto third = keyboard_.next();
  return third ? std::optional(static_cast<unsigned char>(0x80 | *third)) : first;
}

}  // namespace strainfinger::live
