#include "common/commands.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdint>
#include <initializer_list>

using namespace strainfinger;

TEST_GROUP(Commands) {
  static constexpr std::uint8_t kNode = 5;

  /// A frame of these bytes and no others.
  static CanFrame frameOf(std::uint16_t id, std::initializer_list<int> bytes) {
    CanFrame frame{.id = id};
    for (const int byte : bytes) frame.data[frame.length++] = static_cast<std::uint8_t>(byte);
    return frame;
  }
  static std::optional<RequestFrame> requestIn(std::initializer_list<int> bytes) {
    return readSingleFrame<RequestFrame>(frameOf(0x605, bytes), kNode);
  }
  static std::optional<ResponseFrame> responseIn(std::initializer_list<int> bytes) {
    return readSingleFrame<ResponseFrame>(frameOf(0x585, bytes), kNode);
  }
  static CommandStatus check(std::uint8_t command, std::uint8_t length, std::uint16_t argument) {
    return checkRequest({.length = length, .command = static_cast<Command>(command), .argument = argument});
  }
};

TEST(Commands, RequestsHaveTheseBytes) {
  CHECK_TRUE(encode(tareRequest(false), kNode) == frameOf(0x605, {2, 1, 0, 0, 0, 0, 0, 0}));
  CHECK_TRUE(encode(tareRequest(true), kNode) == frameOf(0x605, {2, 1, 1, 0, 0, 0, 0, 0}));
  CHECK_TRUE(encode(keepRequest(), kNode) == frameOf(0x605, {1, 3, 0, 0, 0, 0, 0, 0}));
  CHECK_TRUE(encode(keepRequest(true), kNode) == frameOf(0x605, {2, 3, 1, 0, 0, 0, 0, 0}));
  CHECK_TRUE(encode(nodeRequest(7), kNode) == frameOf(0x605, {2, 4, 7, 0, 0, 0, 0, 0}));
  CHECK_TRUE(encode(nodeRequest(7, true), kNode) == frameOf(0x605, {3, 4, 7, 1, 0, 0, 0, 0}));
  CHECK_TRUE(encode(countRequest(Count::kUnreadable), kNode) == frameOf(0x605, {2, 5, 2, 0, 0, 0, 0, 0}));
  CHECK_TRUE(encode(contactRateRequest(500), 63) == frameOf(0x63F, {3, 2, 0xF4, 0x01, 0, 0, 0, 0}));
}

TEST(Commands, ResponsesHaveTheseBytes) {
  CHECK_TRUE(encode(responseTo(Command::kTare, CommandStatus::kTouched), kNode) ==
             frameOf(0x585, {2, 0x81, 4, 0, 0, 0, 0, 0}));
  CHECK_TRUE(encode(responseTo(static_cast<Command>(0x7F), CommandStatus::kUnknownCommand), kNode) ==
             frameOf(0x585, {2, 0xFF, 2, 0, 0, 0, 0, 0}));
  CHECK_TRUE(encode(responseTo(Command::kCount, CommandStatus::kDone, 0x12345678), kNode) ==
             frameOf(0x585, {6, 0x85, 0, 0x78, 0x56, 0x34, 0x12, 0}));
}

TEST(Commands, WhatIsSentIsRead) {
  for (const RequestFrame& request : {tareRequest(false), tareRequest(true), contactRateRequest(20)})
    CHECK_TRUE(readSingleFrame<RequestFrame>(encode(request, kNode), kNode) == request);
  for (int status = 0; status <= 255; ++status) {
    const ResponseFrame response = responseTo(Command::kContactRate, static_cast<CommandStatus>(status));
    CHECK_TRUE(readSingleFrame<ResponseFrame>(encode(response, kNode), kNode) == response);
  }
  const ResponseFrame counted = responseTo(Command::kCount, CommandStatus::kDone, 0xFFFF'FFFF);
  CHECK_TRUE(readSingleFrame<ResponseFrame>(encode(counted, kNode), kNode) == counted);
}

TEST(Commands, UnusedBytesNeedNotBeSent) {
  CHECK_TRUE(requestIn({1, 1}) == (RequestFrame{.length = 1, .command = Command::kTare}));
  CHECK_TRUE(requestIn({2, 1, 1}) == tareRequest(true));
  CHECK_TRUE(requestIn({3, 2, 0xF4, 0x01}) == contactRateRequest(500));
  CHECK_TRUE(responseIn({2, 0x81, 0}) == responseTo(Command::kTare, CommandStatus::kDone));
}

TEST(Commands, PaddingIsNotRead) {
  CHECK_TRUE(requestIn({1, 1, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC}) ==
             (RequestFrame{.length = 1, .command = Command::kTare}));
  CHECK_TRUE(requestIn({2, 1, 1, 0xCC, 0xCC, 0xCC, 0xCC, 0xCC}) == tareRequest(true));
  CHECK_TRUE(responseIn({2, 0x82, 3, 0x55}) ==
             responseTo(Command::kContactRate, CommandStatus::kBadArgument));
}

TEST(Commands, OnlyWholeSingleFramesAreRead) {
  for (int first = 0; first <= 255; ++first)
    for (int length = 0; length <= 15; ++length) {
      CanFrame frame = frameOf(0x605, {first, 1, 0, 0, 0, 0, 0, 0});
      frame.length = static_cast<std::uint8_t>(length);
      const bool whole = first >= 1 && first <= 7 && length <= 8 && length > first;
      CHECK_EQUAL(whole, readSingleFrame<RequestFrame>(frame, kNode).has_value());
    }
}

TEST(Commands, AResponseWithoutAStatusIsNone) {
  CHECK_FALSE(responseIn({1, 0x81}).has_value());
  CHECK_FALSE(responseIn({}).has_value());
}

TEST(Commands, NeitherIsTakenForTheOther) {
  CHECK_FALSE(requestIn({2, 0x81, 0}).has_value());
  CHECK_FALSE(responseIn({2, 0x01, 0}).has_value());
  for (std::uint16_t id = 0; id <= kMaxCanId; ++id) {
    CHECK_EQUAL(id == 0x605, readSingleFrame<RequestFrame>(frameOf(id, {1, 1}), kNode).has_value());
    CHECK_EQUAL(id == 0x585, readSingleFrame<ResponseFrame>(frameOf(id, {2, 0x81, 0}), kNode).has_value());
  }
}

TEST(Commands, EveryCommandAndArgumentIsCheckedAgainstItsOwn) {
  for (int command = 0; command <= 127; ++command)
    for (int length = 1; length <= 7; ++length)
      for (int argument = 0; argument <= 0xFFFF; ++argument) {
        CommandStatus expected = CommandStatus::kUnknownCommand;
        if (command == 1)
          expected = length <= 2 && argument <= 1 ? CommandStatus::kDone : CommandStatus::kBadArgument;
        if (command == 2)
          expected = length == 3 && argument >= 20 && argument <= 1000 ? CommandStatus::kDone
                                                                       : CommandStatus::kBadArgument;
        if (command == 3)
          expected = length <= 2 && argument <= 1 ? CommandStatus::kDone : CommandStatus::kBadArgument;
        if (command == 4) {
          const bool isNode = (argument >= 1 && argument <= 63) || (argument >= 0x101 && argument <= 0x13F);
          expected =
              length >= 2 && length <= 3 && isNode ? CommandStatus::kDone : CommandStatus::kBadArgument;
        }
        if (command == 5)
          expected = length == 2 && argument <= 4 ? CommandStatus::kDone : CommandStatus::kBadArgument;
        if (command == 6)
          expected = length == 3 && argument <= 1000 ? CommandStatus::kDone : CommandStatus::kBadArgument;
        if (command == 7)
          expected = length <= 2 && argument <= 1 ? CommandStatus::kDone : CommandStatus::kBadArgument;
        if (command == 8)  // of 24,568 bytes
          expected = length == 7 && argument < 6142 ? CommandStatus::kDone : CommandStatus::kBadArgument;
        if (command == 9)
          expected = length <= 2 && argument <= 1 ? CommandStatus::kDone : CommandStatus::kBadArgument;
        if (check(static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(length),
                  static_cast<std::uint16_t>(argument)) != expected)
          FAIL("checked against another's");
      }
}
