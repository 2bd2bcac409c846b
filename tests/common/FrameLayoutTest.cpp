#include "common/frame_layout.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdint>

using namespace strainfinger;

// A frame with what the fingers' own don't have: narrow signed fields side by side, a field across a byte
// border, bits that belong to nobody, fewer than eight bytes.
namespace {
struct Toy {
  std::uint8_t low = 0;
  std::int8_t left = 0;
  std::int16_t middle = 0;
  std::int8_t right = 0;
  bool operator==(const Toy&) const = default;
};

constexpr FrameSpec toySpec(std::uint8_t length) {
  return {.name = "TOY",
          .function = FunctionCode::kRaw,
          .length = length,
          .period_ms = 1,
          .onChange = false,
          .comment = ""};
}
constexpr FieldMeaning kPlain{.name = "plain", .comment = ""};

struct TooWide : Toy {};
struct Outside : Toy {};
struct Overlapping : Toy {};
struct LimitTooLarge : Toy {};
struct LimitIsReserved : Toy {};
struct NameBeyondWidth : Toy {};
struct FlagBeyondWidth : Toy {};
struct NoBits : Toy {};
struct NineBytes : Toy {};
struct SecondToy : Toy {};
struct NoLayout {};

constexpr ValueName kEight[] = {{8, "eight", ""}};
constexpr FieldMeaning kChoiceOfEight{
    .name = "c", .comment = "", .kind = FieldKind::kChoice, .names = kEight};
constexpr FieldMeaning kFlagEight{.name = "f", .comment = "", .kind = FieldKind::kFlags, .names = kEight};
}  // namespace

namespace strainfinger {
template <>
inline constexpr FrameLayout kLayout<Toy>{
    toySpec(5),
    Field{&Toy::low, {.lsb = 1, .width = 4, .limit = 9, .unknowable = true}, kPlain},
    Field{&Toy::left, {.lsb = 5, .width = 3, .unknowable = true}, kPlain},
    Field{&Toy::middle, {.lsb = 8, .width = 11}, kPlain},
    Field{&Toy::right, {.lsb = 19, .width = 5}, kPlain},
};
static_assert(WireFrame<Toy>);

template <>
inline constexpr auto kLayout<SecondToy> = kLayout<Toy>.sentAs({.name = "TOY2",
                                                                .function = FunctionCode::kInfo,
                                                                .length = 5,
                                                                .period_ms = 2,
                                                                .onChange = true,
                                                                .comment = ""});
static_assert(WireFrame<SecondToy>);

// Each of these has one thing wrong; that none is a WireFrame is why a wrong layout doesn't compile.
template <>
inline constexpr FrameLayout kLayout<TooWide>{toySpec(8),
                                              Field{&TooWide::low, {.lsb = 0, .width = 9}, kPlain}};
template <>
inline constexpr FrameLayout kLayout<NoBits>{toySpec(8), Field{&NoBits::low, {.lsb = 0, .width = 0}, kPlain}};
template <>
inline constexpr FrameLayout kLayout<Outside>{toySpec(2),
                                              Field{&Outside::low, {.lsb = 9, .width = 8}, kPlain}};
template <>
inline constexpr FrameLayout kLayout<NineBytes>{toySpec(9),
                                                Field{&NineBytes::low, {.lsb = 0, .width = 8}, kPlain}};
template <>
inline constexpr FrameLayout kLayout<Overlapping>{toySpec(8),
                                                  Field{&Overlapping::low, {.lsb = 0, .width = 8}, kPlain},
                                                  Field{&Overlapping::left, {.lsb = 7, .width = 8}, kPlain}};
template <>
inline constexpr FrameLayout kLayout<LimitTooLarge>{
    toySpec(8), Field{&LimitTooLarge::low, {.lsb = 0, .width = 4, .limit = 16}, kPlain}};
template <>
inline constexpr FrameLayout kLayout<LimitIsReserved>{
    toySpec(8),
    Field{&LimitIsReserved::low, {.lsb = 0, .width = 4, .limit = 15, .unknowable = true}, kPlain}};
template <>
inline constexpr FrameLayout kLayout<NameBeyondWidth>{
    toySpec(8), Field{&NameBeyondWidth::low, {.lsb = 0, .width = 3}, kChoiceOfEight}};
template <>
inline constexpr FrameLayout kLayout<FlagBeyondWidth>{
    toySpec(8), Field{&FlagBeyondWidth::low, {.lsb = 0, .width = 8}, kFlagEight}};
}  // namespace strainfinger

namespace {
template <typename Frame>
constexpr bool kCanBeSent = requires(Frame frame) {
  encode(frame, 1);
};
}  // namespace

TEST_GROUP(FrameLayout) {
  Toy sentAndReceived(const Toy& toy) { return decode<Toy>(encode(toy, 1)).value(); }
};

TEST(FrameLayout, WrongLayoutsDoNotCompile) {
  CHECK_TRUE(kCanBeSent<Toy>);
  CHECK_FALSE(kCanBeSent<NoLayout>);
  CHECK_FALSE(kCanBeSent<TooWide>);
  CHECK_FALSE(kCanBeSent<NoBits>);
  CHECK_FALSE(kCanBeSent<Outside>);
  CHECK_FALSE(kCanBeSent<NineBytes>);
  CHECK_FALSE(kCanBeSent<Overlapping>);
  CHECK_FALSE(kCanBeSent<LimitTooLarge>);
  CHECK_FALSE(kCanBeSent<LimitIsReserved>);
  CHECK_FALSE(kCanBeSent<NameBeyondWidth>);
  CHECK_FALSE(kCanBeSent<FlagBeyondWidth>);
}

TEST(FrameLayout, FieldsLieLittleEndian) {
  // bits: low 1..4 = 0101, left 5..7 = 110 (-2), middle 8..18 = 101 1001 0110 (-618), right 19..23 = 01111
  const CanFrame frame = encode(Toy{5, -2, -618, 15}, 1);
  LONGS_EQUAL(0b110'0101'0, frame.data[0]);
  LONGS_EQUAL(0b1001'0110, frame.data[1]);
  LONGS_EQUAL(0b01111'101, frame.data[2]);
}

TEST(FrameLayout, BitsOfNobodyAreZeroAndIgnored) {
  CanFrame frame = encode(Toy{9, 3, -1, -1}, 1);
  LONGS_EQUAL(0, frame.data[0] & 1);
  LONGS_EQUAL(0, frame.data[3] | frame.data[4]);
  frame.data[0] |= 1;
  frame.data[4] = 0xFF;
  CHECK(decode<Toy>(frame) == (Toy{9, 3, -1, -1}));
}

TEST(FrameLayout, NarrowSignedFieldsLeaveTheirNeighboursAlone) {
  for (int left = -4; left <= 3; ++left)
    for (int right = -16; right <= 15; ++right) {
      const Toy toy{15, static_cast<std::int8_t>(left), -1, static_cast<std::int8_t>(right)};
      CHECK(sentAndReceived(toy) == toy);
    }
}

TEST(FrameLayout, EveryMiddleValueSurvives) {
  for (int raw = -1024; raw <= 1023; ++raw) {
    const Toy toy{0, 0, static_cast<std::int16_t>(raw), 0};
    CHECK(sentAndReceived(toy) == toy);
  }
}

TEST(FrameLayout, WhatDoesNotFitBecomesTheNearestValidValue) {
  CHECK(sentAndReceived(Toy{200, 100, 32767, 16}) == (Toy{9, 3, 1023, 15}));
  CHECK(sentAndReceived(Toy{10, -100, -32768, -17}) == (Toy{9, -3, -1024, -16}));
}

TEST(FrameLayout, OnlyTheReservedValueMeansNotKnown) {
  CHECK(sentAndReceived(Toy{15, -4, 0, 0}) == (Toy{15, -4, 0, 0}));
  CHECK_FALSE(isValidRaw(kFieldBits<Toy, 0>, 15));
  CHECK_FALSE(isValidRaw(kFieldBits<Toy, 1>, -4));
  CHECK_TRUE(isValidRaw(kFieldBits<Toy, 1>, -3));
}

TEST(FrameLayout, ReservedValuesFollowFromWidthAndSign) {
  LONGS_EQUAL(65535, invalidRaw({.lsb = 0, .width = 16}));
  LONGS_EQUAL(-32768, invalidRaw({.lsb = 0, .width = 16, .isSigned = true}));
  LONGS_EQUAL(65535, kNotKnown<std::uint16_t>);
  LONGS_EQUAL(-128, kNotKnown<std::int8_t>);
}

TEST(FrameLayout, FieldsOfThirtyTwoBitsKeepTheirSign) {
  constexpr FieldBits kUnsigned{.lsb = 32, .width = 32};
  constexpr FieldBits kSigned{.lsb = 32, .width = 32, .isSigned = true};
  CHECK(extractRaw(kUnsigned, insertRaw(kUnsigned, 0xFFFFFFFF)) == 0xFFFFFFFF);
  CHECK(extractRaw(kSigned, insertRaw(kSigned, -2147483648LL)) == -2147483648LL);
  CHECK(extractRaw(kSigned, insertRaw(kSigned, 2147483647LL)) == 2147483647LL);
}

TEST(FrameLayout, ALayoutSentAsAnotherFrameDiffersInItsIdentifierOnly) {
  const Toy toy{5, -2, -618, 15};
  const CanFrame first = encode(toy, 7), second = encode(SecondToy{toy}, 7);
  LONGS_EQUAL(0x487, second.id);
  LONGS_EQUAL(first.length, second.length);
  CHECK(first.data == second.data);
  CHECK(decode<SecondToy>(second).value() == toy);
  CHECK_FALSE(decode<SecondToy>(first).has_value());
  CHECK_FALSE(decode<Toy>(second).has_value());
}

TEST(FrameLayout, OtherLengthsAreOtherFrames) {
  for (const int length : {0, 4, 6, 8}) {
    CanFrame frame = encode(Toy{}, 1);
    frame.length = static_cast<std::uint8_t>(length);
    CHECK_FALSE(decode<Toy>(frame).has_value());
  }
}

TEST(FrameLayout, OnlyNodesOneToSixtyThreeHaveFrames) {
  for (int id = 0; id <= kMaxCanId; ++id) {
    CanFrame frame = encode(Toy{}, 1);
    frame.id = static_cast<std::uint16_t>(id);
    CHECK_EQUAL(id >= 0x401 && id <= 0x43F, decode<Toy>(frame).has_value());
  }
}

TEST(FrameLayout, IdentifiersAreFunctionPlusNode) {
  LONGS_EQUAL(0x43F, canId(FunctionCode::kRaw, 63));
  LONGS_EQUAL(63, nodeOf(0x43F, FunctionCode::kRaw).value());
  CHECK_FALSE(nodeOf(0x400, FunctionCode::kRaw).has_value());
  CHECK_FALSE(nodeOf(0x440, FunctionCode::kRaw).has_value());
  CHECK_FALSE(nodeOf(0x181, FunctionCode::kRaw).has_value());
}
