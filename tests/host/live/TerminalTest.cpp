#include "host/live/terminal.hpp"

#include <fcntl.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Terminal) {
  int ours_ = -1, its_ = -1;

  void setup() override { LONGS_EQUAL(0, openpty(&ours_, &its_, nullptr, nullptr, nullptr)); }
  void teardown() override {
    close(ours_);
    close(its_);
  }
  bool isEchoing() const {
    termios now{};
    tcgetattr(its_, &now);
    return (now.c_lflag & ECHO) != 0 && (now.c_lflag & ICANON) != 0;
  }
};

// What a shell would be left with.
TEST(Terminal, OneThatTakesNothingKeepsItsKeyboardAsItWas) {
  CHECK_TRUE(isEchoing());
  const pid_t child = fork();
  if (child == 0) {
    dup2(its_, STDIN_FILENO);
    dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO);
    try {
      const live::Terminal terminal;
    } catch (const Failure&) {
      _exit(0);
    }
    _exit(1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  LONGS_EQUAL(0, status);
  CHECK_TRUE(isEchoing());
}

TEST(Terminal, ADumbOneIsNoneToDrawOn) {
  const auto hasOneWith = [this](const char* kind) {
    const pid_t child = fork();
    if (child == 0) {
      dup2(its_, STDOUT_FILENO);
      if (kind != nullptr)
        setenv("TERM", kind, 1);
      else
        unsetenv("TERM");
      _exit(live::hasTerminal() ? 1 : 0);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return WEXITSTATUS(status) == 1;
  };
  CHECK_TRUE(hasOneWith("xterm"));
  CHECK_FALSE(hasOneWith("dumb"));
  CHECK_FALSE(hasOneWith(""));
  CHECK_FALSE(hasOneWith(nullptr));
}

TEST(Terminal, AKeyboardIsUnechoedWhileItLives) {
  const int before = dup(STDIN_FILENO);
  dup2(its_, STDIN_FILENO);
  {
    const live::Keyboard keyboard;
    CHECK_FALSE(isEchoing());
    LONGS_EQUAL(1, write(ours_, "x", 1));
    CHECK_TRUE(keyboard.next() == 'x');
    CHECK_FALSE(keyboard.next());
  }
  CHECK_TRUE(isEchoing());
  dup2(before, STDIN_FILENO);
  close(before);
}

// A shell that has stopped the process leaves the terminal so, and Ctrl-C would not end a read that waits.
TEST(Terminal, AKeyboardNeverWaitsWhateverTheModes) {
  const int before = dup(STDIN_FILENO);
  dup2(its_, STDIN_FILENO);
  {
    const live::Keyboard keyboard;
    keyboard.release();
    CHECK_TRUE(isEchoing());
    alarm(5);
    CHECK_FALSE(keyboard.next());
    alarm(0);
    keyboard.takeOver();
    CHECK_FALSE(isEchoing());
    LONGS_EQUAL(0, fcntl(its_, F_GETFL) & O_NONBLOCK);
  }
  CHECK_TRUE(isEchoing());
  dup2(before, STDIN_FILENO);
  close(before);
}
