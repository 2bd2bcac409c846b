#include "host/base/text_output.hpp"

#include <CppUTest/TestHarness.h>

#include <memory>
#include <string>

#include "host/base/failure.hpp"

using namespace strainfinger;

TEST_GROUP(TextOutput) {
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
  const File file_{std::tmpfile(), &std::fclose};
  TextOutput output_{file_.get()};

  long written() const { return std::ftell(file_.get()); }
};

TEST(TextOutput, WritesWhenItIsTold) {
  output_.text() += "text";
  LONGS_EQUAL(0, written());
  output_.flush();
  LONGS_EQUAL(4, written());
  STRCMP_EQUAL("", output_.text().c_str());
}

TEST(TextOutput, WritesMuchTextAtOnce) {
  output_.text() += "text";
  output_.flushIfLarge();
  LONGS_EQUAL(0, written());
  output_.text().append(100'000, 'x');
  output_.flushIfLarge();
  LONGS_EQUAL(100'004, written());
}

TEST(TextOutput, AFullDiskIsAFailure) {
  const File full{std::fopen("/dev/full", "w"), &std::fclose};
  TextOutput output(full.get());
  output.text() += "text";
  CHECK_THROWS(Failure, output.flush());
}

TEST(TextOutput, WhatIsWrittenToAStreamIsHadAsText) {
  const std::string text =
      textWritten([](std::FILE* stream) { writeText(stream, std::string(10'000, 'x')); });
  CHECK(text == std::string(10'000, 'x'));
  CHECK_THROWS(int, textWritten([](std::FILE*) { throw 1; }));
}
