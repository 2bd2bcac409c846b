#include "host/base/notice.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Notice) {};

TEST(Notice, WhatATerminalWouldObeyIsShown) {
  STRCMP_EQUAL("\\x1B[31m \\x7F \\x00", printable(std::string("\x1B[31m \x7F \0", 9)).c_str());
  STRCMP_EQUAL("\\xC2\\x9B[", printable("\xC2\x9B[").c_str());
}

TEST(Notice, WhatIsNoUtf8IsShownByItsBytes) {
  STRCMP_EQUAL("\\x9B[ \\xFF \\xC3( \\xE2\\x82", printable("\x9B[ \xFF \xC3( \xE2\x82").c_str());
}

TEST(Notice, LinesTabsAndOtherLettersStay) { STRCMP_EQUAL("a\tb\n±°é€😀", printable("a\tb\n±°é€😀").c_str()); }

TEST(Notice, WhereNothingIsTakenNothingHappens) {
  const int before = dup(STDERR_FILENO);
  std::FILE* const full = std::fopen("/dev/full", "w");
  dup2(fileno(full), STDERR_FILENO);
  tell("no {}", "exception");
  close(STDERR_FILENO);
  tell("nor here");
  dup2(before, STDERR_FILENO);
  close(before);
  std::fclose(full);
}
