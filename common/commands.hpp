#pragma once
// What a finger can be told over CAN, and what it answers. BUS_REQUESTS.md shows the bytes.
//
// Both are ISO-TP single frames (ISO 15765-2): byte 0 counts the bytes that follow and matter, 1 .. 7. Its
// upper four bits are 0, so that longer ISO-TP messages can come beside them. We send all eight bytes, the
// unused ones 0; what is read may be as short as it counts, or padded with anything.

#include <array>
#include <cstdint>
#include <optional>
#include <tuple>

#include "common/frame_layout.hpp"
#include "common/frames.hpp"
#include "common/table_image.hpp"

namespace strainfinger {

/// An answer is given to the bus within this time or never: an older one could be taken for another's.
inline constexpr std::uint16_t kAnswerWithin_ms = 500;

/// At the slowest a finger in contact sends what it would anyway.
inline constexpr std::uint16_t kSlowestContactRate_hz = 1000 / kContactPeriod_ms;
inline constexpr std::uint16_t kFastestContactRate_hz = 1000;

inline constexpr std::uint16_t kFastestRaw_hz = 1000;

/// Never reuse a number; 1 .. 127.
enum class Command : std::uint8_t {
  kTare = 1,
  kContactRate = 2,
  kKeep = 3,
  kNode = 4,
  kCount = 5,
  kRaw = 6,
  kLoad = 7,
  kWord = 8,
  kRestart = 9
};

inline constexpr std::array kCommandNames{
    named(Command::kTare, "tare", "Take the zero of the gauges now; argument 1: even while touched"),
    named(Command::kContactRate, "contact_rate",
          "Send at most so many CONTACT a second, until the next start"),
    named(Command::kKeep, "keep",
          "Keep the contact rate for the next starts; argument 1: even while touched"),
    named(Command::kNode, "node", "Be this node from the next start on; with 256 added: even while touched"),
    named(Command::kCount, "count", "Tell one of the finger's counts"),
    named(Command::kRaw, "raw", "Send so many sets of RAW a second, until the next start; 0: no more"),
    named(Command::kLoad, "load",
          "Stop, and take other tables from their first word on, until `restart`; argument 1: even while "
          "touched"),
    named(Command::kWord, "word", "Four bytes of the tables; argument: which of their words it is"),
    named(Command::kRestart, "restart", "Start anew; argument 1: even while touched"),
};

/// What a finger counts and tells when it is asked. Never reuse a number.
enum class Count : std::uint8_t {
  kErases = 0,
  kCorrected = 1,
  kUnreadable = 2,
  kLostSets = 3,
  kResynchronised = 4
};

inline constexpr std::array kCountNames{
    named(Count::kErases, "erases",
          "Pages of the settings' memory erased in its life; each lasts 10,000 times"),
    named(Count::kCorrected, "corrected",
          "Times that a word of the memory was read with a wrong bit and put right, since the start"),
    named(Count::kUnreadable, "unreadable",
          "Times that a word of the memory was read with more wrong bits, since the start"),
    named(Count::kLostSets, "lost_sets", "Sample sets that were lost, since the start"),
    named(Count::kResynchronised, "resynchronised",
          "Times that the converters lost track of the gauges and began anew, since the start"),
};
inline constexpr std::uint16_t kLastCount = kCountNames.back().value;

/// Words of a table image, as `word` counts them.
inline constexpr std::uint16_t kTableWords = sizeof(TableImage) / 4;

/// What a command's argument may be. One that is absent is 0; of 6 bytes 4 are a word.
struct ArgumentSpec {
  Command command;
  std::uint8_t leastBytes, mostBytes;
  std::uint16_t least, most;
  std::uint16_t even = 0;  ///< may be added to it: even while touched
};
inline constexpr std::uint16_t kNodeEvenWhileTouched = 0x100;
// With a deduced type GCC 12 puts this table into RAM instead of flash.
inline constexpr std::array<ArgumentSpec, 9> kArguments{
    ArgumentSpec{Command::kTare, 0, 1, 0, 1},
    ArgumentSpec{Command::kContactRate, 2, 2, kSlowestContactRate_hz, kFastestContactRate_hz},
    ArgumentSpec{Command::kKeep, 0, 1, 0, 1},
    ArgumentSpec{Command::kNode, 1, 2, kFirstNode, kLastNode, kNodeEvenWhileTouched},
    ArgumentSpec{Command::kCount, 1, 1, 0, kLastCount},
    ArgumentSpec{Command::kRaw, 2, 2, 0, kFastestRaw_hz},
    ArgumentSpec{Command::kLoad, 0, 1, 0, 1},
    ArgumentSpec{Command::kWord, 6, 6, 0, kTableWords - 1},
    ArgumentSpec{Command::kRestart, 0, 1, 0, 1},
};

/// What became of a request. Never reuse a number.
enum class CommandStatus : std::uint8_t {
  kDone = 0,
  kBusy = 1,
  kUnknownCommand = 2,
  kBadArgument = 3,
  kTouched = 4,
  kDoneTouched = 5,
  kNotKept = 6,
  kWait = 7,
  kTooFast = 8,
  kOutOfTurn = 9,
};

inline constexpr std::array kCommandStatusNames{
    named(CommandStatus::kDone, "done", "Done"),
    named(CommandStatus::kBusy, "busy",
          "Not now: the zero is being taken, the end of a touch has not been sent yet, or the finger has "
          "no samples or no tables"),
    named(CommandStatus::kUnknownCommand, "unknown_command", "This firmware has no such command"),
    named(CommandStatus::kBadArgument, "bad_argument",
          "The argument is absent, too long or outside its range"),
    named(CommandStatus::kTouched, "touched", "Refused: something touches the finger"),
    named(CommandStatus::kDoneTouched, "done_touched",
          "Done as forced: what touched the finger is now part of its zero"),
    named(CommandStatus::kNotKept, "not_kept", "The board has no memory for it, or its memory failed"),
    named(CommandStatus::kWait, "wait",
          "Not yet: the memory would wear out, or a zero was taken or refused just now; in value seconds"),
    named(CommandStatus::kTooFast, "too_fast",
          "Refused: more than RAW's share of the bus; in value the fastest rate"),
    named(CommandStatus::kOutOfTurn, "out_of_turn",
          "Refused: words are taken after `load`, one after the other; in value the one that is due, if one "
          "is"),
};

/// To a finger.
struct RequestFrame {
  static constexpr std::uint8_t kFewestBytes = 1;
  std::uint8_t length = kFewestBytes;
  Command command{};
  bool answer = false;
  std::uint16_t argument = 0;
  std::uint32_t word = 0;
  bool operator==(const RequestFrame&) const = default;
};

/// From a finger.
struct ResponseFrame {
  static constexpr std::uint8_t kFewestBytes = 2;
  std::uint8_t length = kFewestBytes;
  Command command{};
  bool answer = true;
  CommandStatus status = CommandStatus::kDone;
  std::uint32_t value = 0;
  bool operator==(const ResponseFrame&) const = default;
};

/// The first two bytes of both.
inline constexpr FieldBits kLengthBits{.lsb = 0, .width = 8, .limit = 7};
inline constexpr FieldMeaning kLengthMeaning{.name = "length",
                                             .comment = "ISO-TP single frame: bytes that follow and matter"};
inline constexpr FieldBits kCommandBits{.lsb = 8, .width = 7};
inline constexpr FieldBits kAnswerBits{.lsb = 15, .width = 1};
inline constexpr FieldMeaning kAnswerMeaning{.name = "answer",
                                             .comment = "0 in a request, 1 in its response"};

template <>
inline constexpr FrameLayout kLayout<RequestFrame>{
    FrameSpec{.name = "REQUEST",
              .function = FunctionCode::kRequest,
              .length = 8,
              .period_ms = 0,
              .onChange = false,
              .comment = "Something the finger is to do; it answers each with a RESPONSE"},
    Field{&RequestFrame::length, kLengthBits, kLengthMeaning},
    Field{&RequestFrame::command,
          kCommandBits,
          {.name = "command", .comment = "What to do", .kind = FieldKind::kChoice, .names = kCommandNames}},
    Field{&RequestFrame::answer, kAnswerBits, kAnswerMeaning},
    Field{&RequestFrame::argument,
          {.lsb = 16, .width = 16},
          {.name = "argument", .comment = "Of the command; what length leaves out is 0"}},
    Field{&RequestFrame::word,
          {.lsb = 32, .width = 32},
          {.name = "word", .comment = "Four bytes of the tables; what length leaves out is 0"}},
};
static_assert(WireFrame<RequestFrame>);

template <>
inline constexpr FrameLayout kLayout<ResponseFrame>{
    FrameSpec{.name = "RESPONSE",
              .function = FunctionCode::kResponse,
              .length = 8,
              .period_ms = 0,
              .onChange = false,
              .comment = "What became of a request: when it is done"},
    Field{&ResponseFrame::length, kLengthBits, kLengthMeaning},
    Field{&ResponseFrame::command,
          kCommandBits,
          {.name = "command",
           .comment = "That of the request",
           .kind = FieldKind::kChoice,
           .names = kCommandNames}},
    Field{&ResponseFrame::answer, kAnswerBits, kAnswerMeaning},
    Field{&ResponseFrame::status,
          {.lsb = 16, .width = 8},
          {.name = "status",
           .comment = "What became of it",
           .kind = FieldKind::kChoice,
           .names = kCommandStatusNames}},
    Field{&ResponseFrame::value,
          {.lsb = 24, .width = 32},
          {.name = "value",
           .comment = "What was counted; seconds to wait; fastest rate; word that is due; what length leaves "
                      "out is 0"}},
};
static_assert(WireFrame<ResponseFrame>);

/// What is said when a command is given, and because of it; FingerFrames is what a finger says by itself.
using CommandFrames = std::tuple<RequestFrame, ResponseFrame, RawFrame>;

/// Of a command whose only argument is whether it is meant even while something touches the finger.
constexpr RequestFrame flagRequest(Command command, bool evenWhileTouched) {
  if (!evenWhileTouched) return {.length = 1, .command = command};
  return {.length = 2, .command = command, .argument = 1};
}
constexpr RequestFrame tareRequest(bool evenWhileTouched) {
  return {.length = 2, .command = Command::kTare, .argument = evenWhileTouched};
}
constexpr RequestFrame contactRateRequest(std::uint16_t rate_hz) {
  return {.length = 3, .command = Command::kContactRate, .argument = rate_hz};
}
constexpr RequestFrame keepRequest(bool evenWhileTouched = false) {
  return flagRequest(Command::kKeep, evenWhileTouched);
}
constexpr RequestFrame nodeRequest(std::uint8_t node, bool evenWhileTouched = false) {
  if (!evenWhileTouched) return {.length = 2, .command = Command::kNode, .argument = node};
  return {.length = 3,
          .command = Command::kNode,
          .argument = static_cast<std::uint16_t>(node + kNodeEvenWhileTouched)};
}
constexpr RequestFrame countRequest(Count count) {
  return {.length = 2, .command = Command::kCount, .argument = static_cast<std::uint16_t>(count)};
}
constexpr RequestFrame rawRequest(std::uint16_t rate_hz) {
  return {.length = 3, .command = Command::kRaw, .argument = rate_hz};
}
constexpr RequestFrame loadRequest(bool evenWhileTouched = false) {
  return flagRequest(Command::kLoad, evenWhileTouched);
}
/// `index` below kTableWords.
constexpr RequestFrame wordRequest(std::uint16_t index, std::uint32_t word) {
  return {.length = 7, .command = Command::kWord, .argument = index, .word = word};
}
constexpr RequestFrame restartRequest(bool evenWhileTouched = false) {
  return flagRequest(Command::kRestart, evenWhileTouched);
}
constexpr ResponseFrame responseTo(Command command, CommandStatus status) {
  return {.command = command, .status = status};
}
constexpr ResponseFrame responseTo(Command command, CommandStatus status, std::uint32_t value) {
  return {.length = 6, .command = command, .status = status, .value = value};
}

/// A request to (response of) this node; nothing if the frame is none: another identifier, not a whole
/// ISO-TP single frame, or the other direction.
template <typename Frame>
constexpr std::optional<Frame> readSingleFrame(CanFrame frame, std::uint8_t node) {
  // Constants: a layout that is read at run time is in the image, with all its texts.
  constexpr FunctionCode kFunction = kLayout<Frame>.spec.function;
  constexpr std::uint8_t kWholeLength = kLayout<Frame>.spec.length;
  const std::uint8_t length = frame.data[0];
  if (frame.id != canId(kFunction, node) || length < Frame::kFewestBytes || frame.length <= length ||
      frame.length > frame.data.size())
    return std::nullopt;
  frame.length = length + 1;
  CanFrame whole = asReceived(frame);
  whole.length = kWholeLength;
  const auto values = decode<Frame>(whole);
  if (!values || values->answer != Frame{}.answer) return std::nullopt;
  return values;
}

/// What is wrong with a request before anything is done about it; kDone: nothing.
constexpr CommandStatus checkRequest(const RequestFrame& request) {
  const int bytes = request.length - RequestFrame::kFewestBytes;
  for (const ArgumentSpec& spec : kArguments) {
    if (spec.command != request.command) continue;
    const bool fits = bytes >= spec.leastBytes && bytes <= spec.mostBytes;
    const int argument = request.argument & ~spec.even;
    const bool inRange = argument >= spec.least && argument <= spec.most;
    return fits && inRange ? CommandStatus::kDone : CommandStatus::kBadArgument;
  }
  return CommandStatus::kUnknownCommand;
}

}  // namespace strainfinger
