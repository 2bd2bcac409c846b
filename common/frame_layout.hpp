#pragma once
// The one way a struct of raw integers becomes a CAN frame and back: a constexpr table of fields per frame.
// Encoder, decoder, printer, DBC file and the tables of BUS*.md all come from it. No floating point, no heap
// and no text on the way to the bus: units, names and comments are read by host code only.
//
// Byte order, for every field of every frame: little-endian; bit b of the frame is bit b % 8 of byte b / 8,
// and a field covers the bits lsb .. lsb + width - 1, its lowest bit at lsb (DBC: "@1", Intel).

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "common/can_frame.hpp"
#include "common/field_bits.hpp"

namespace strainfinger {

/// First node number and last; 0 is everybody's, and six bits leave room for other devices on the bus.
inline constexpr std::uint8_t kFirstNode = 1;
inline constexpr std::uint8_t kLastNode = 63;

/// What a frame is; its identifier is this plus the node number. The numbers are those of CANopen's
/// predefined connection set, so that drives on the same bus go on undisturbed. Never reuse one.
enum class FunctionCode : std::uint16_t {
  kGauges = 0x080,
  kContact = 0x180,
  kContact2 = 0x200,
  kForce = 0x280,
  kForce2 = 0x300,
  kPatch = 0x380,
  kRaw = 0x400,
  kInfo = 0x480,
  kResponse = 0x580,
  kRequest = 0x600,
  kHeartbeat = 0x700,
};

/// A named value of a field, or (for flags) a named bit.
struct ValueName {
  std::uint8_t value;
  const char* name;
  const char* comment;
};

template <typename Enum>
constexpr ValueName named(Enum value, const char* name, const char* comment) {
  return {static_cast<std::uint8_t>(value), name, comment};
}

enum class FieldKind : std::uint8_t {
  kNumber,  ///< a quantity
  kChoice,  ///< one of `names`
  kFlags,   ///< a bit each of `names`, whose values are bit numbers within the field; bits without a name go
            ///< by their number
};

/// What a field's raw values mean: for people, and for host code that talks to them.
struct FieldMeaning {
  const char* name;               ///< snake_case, unique in its frame, at most 32 characters
  std::int32_t stepsPerUnit = 1;  ///< physical = raw / stepsPerUnit: exact where a factor of 0.01 is not
  std::int32_t unitsPerStep = 1;  ///< above 1 where a step is more than a unit: physical = raw * unitsPerStep
  const char* unit = "";          ///< ASCII, SI; "" for a plain number
  /// The largest valid value means "that or more", and of a signed field the lowest one "that or less".
  bool openEnded = false;
  const char* comment;  ///< one sentence, ASCII, without quotation marks
  FieldKind kind = FieldKind::kNumber;
  std::span<const ValueName> names = {};
};

struct FieldSpec {
  FieldBits bits;
  FieldMeaning meaning;
};

/// The eight bytes of a frame as one number, byte 0 lowest.
constexpr std::uint64_t toWord(const CanFrame& frame) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < frame.data.size(); ++i) word |= std::uint64_t{frame.data[i]} << (8 * i);
  return word;
}

/// A frame of a word's lowest `length` bytes; the others are 0. They are copied in one piece: byte by byte an
/// update with its three frames takes 176 instructions more.
constexpr CanFrame fromWord(std::uint16_t id, std::uint8_t length, std::uint64_t word) {
  static_assert(std::endian::native == std::endian::little);
  return {id, length, std::bit_cast<std::array<std::uint8_t, 8>>(word)};
}

/// A member's value as the number that is sent, and back. Members are integers, enums, or BitSets.
template <typename Member>
constexpr std::int64_t rawOf(const Member& member) {
  if constexpr (std::is_enum_v<Member> || std::is_integral_v<Member>)
    return static_cast<std::int64_t>(member);
  else
    return member.raw();
}

template <typename Member>
constexpr Member memberOf(std::int64_t raw) {
  if constexpr (std::is_enum_v<Member> || std::is_integral_v<Member>)
    return static_cast<Member>(raw);
  else
    return Member::fromRaw(static_cast<typename Member::Raw>(raw));
}

template <typename Member>
struct RawTypeOf {
  using Type = typename Member::Raw;
};
template <std::integral Member>
struct RawTypeOf<Member> {
  using Type = Member;
};
template <typename Member>
requires std::is_enum_v<Member>
struct RawTypeOf<Member> {
  using Type = std::underlying_type_t<Member>;
};

/// The value of a field that is not known, for the defaults of a frame's members: see invalidRaw().
template <std::integral Raw>
inline constexpr Raw kNotKnown = std::is_signed_v<Raw> ? std::numeric_limits<Raw>::min()
                                                       : std::numeric_limits<Raw>::max();

/// A field of the struct Frame.
template <typename Frame, typename Member>
struct Field {
  using Raw = typename RawTypeOf<Member>::Type;
  constexpr Field(Member Frame::*pointer, FieldBits place, FieldMeaning what)
      : member(pointer), bits(place), meaning(what) {
    bits.isSigned = std::is_signed_v<Raw>;
  }
  constexpr bool fitsMember() const {
    return bits.width >= 1 && bits.width <= 8 * sizeof(Raw) && bits.width <= 32;
  }

  Member Frame::*member;
  FieldBits bits;
  FieldMeaning meaning;
};

/// A frame without its fields.
struct FrameSpec {
  const char* name;
  FunctionCode function;
  std::uint8_t length;      ///< bytes; a frame of another length is not this frame
  std::uint16_t period_ms;  ///< longest time between two of them while there is something to say
  bool onChange;            ///< sent when there is news, at most at the contact rate; else at its period
  const char* comment;
};

template <typename... Fields>
struct FrameLayout {
  constexpr FrameLayout(FrameSpec spec_, Fields... fields_) : spec(spec_), fields(fields_...) {}
  constexpr std::array<FieldSpec, sizeof...(Fields)> fieldSpecs() const {
    return std::apply(
        [](const auto&... field) {
          return std::array{FieldSpec{field.bits, field.meaning}...};
        },
        fields);
  }
  /// The same fields sent as another frame.
  constexpr FrameLayout sentAs(FrameSpec other) const {
    return std::apply([&other](const auto&... field) { return FrameLayout(other, field...); }, fields);
  }
  FrameSpec spec;
  std::tuple<Fields...> fields;
};

/// The layout of each frame; specialised beside the frame's struct.
template <typename Frame>
inline constexpr int kLayout = 0;

template <typename Layout>
constexpr bool fieldsFitTheirMembers(const Layout& layout) {
  return std::apply([](const auto&... field) { return (field.fitsMember() && ...); }, layout.fields);
}

template <typename Layout>
constexpr bool fieldsLieInTheFrame(const Layout& layout) {
  const int end = 8 * layout.spec.length;
  return end <= 64 &&
         std::apply(
             [end](const auto&... field) { return ((field.bits.lsb + field.bits.width <= end) && ...); },
             layout.fields);
}

template <typename Layout>
constexpr bool fieldsDoNotOverlap(const Layout& layout) {
  std::uint64_t taken = 0;
  for (const FieldSpec& field : layout.fieldSpecs()) {
    if ((taken & fieldMask(field.bits)) != 0) return false;
    taken |= fieldMask(field.bits);
  }
  return true;
}

/// Limits and named values are ones the field can hold, beside the reserved value if it has one.
template <typename Layout>
constexpr bool valuesFitTheirFields(const Layout& layout) {
  for (const auto& [bits, meaning] : layout.fieldSpecs()) {
    const std::int64_t largest = maxRaw(bits);
    if (largest > widestRaw(bits) || (bits.unknowable && largest == invalidRaw(bits))) return false;
    const std::int64_t largestName = meaning.kind == FieldKind::kFlags ? bits.width - 1 : largest;
    for (const ValueName& name : meaning.names)
      if (name.value > largestName) return false;
  }
  return true;
}

/// A struct with a layout that can be right. A wrong one is a compile error that names what is wrong.
template <typename Frame>
concept WireFrame = requires {
  kLayout<Frame>.fields;
}
&&fieldsFitTheirMembers(kLayout<Frame>) && fieldsLieInTheFrame(kLayout<Frame>) &&
    fieldsDoNotOverlap(kLayout<Frame>) && valuesFitTheirFields(kLayout<Frame>);

/// The identifier of a node's frame; node 1 .. 63.
constexpr std::uint16_t canId(FunctionCode function, std::uint8_t node) {
  return static_cast<std::uint16_t>(static_cast<std::uint16_t>(function) + node);
}

/// The node whose `function` the identifier is; nothing if it is none's.
constexpr std::optional<std::uint8_t> nodeOf(std::uint16_t id, FunctionCode function) {
  const int node = id - static_cast<int>(function);
  if (node < kFirstNode || node > kLastNode) return std::nullopt;
  return static_cast<std::uint8_t>(node);
}

/// Field number I of a frame, as a constant: all that the bus path needs of it ends up in the instructions,
/// and the table itself stays out of a firmware's flash.
template <typename Frame, std::size_t I>
inline constexpr FieldBits kFieldBits = std::get<I>(kLayout<Frame>.fields).bits;
template <typename Frame, std::size_t I>
inline constexpr auto kMember = std::get<I>(kLayout<Frame>.fields).member;

/// 0 .. number of fields - 1, to expand over.
template <typename Frame>
using FieldIndices = std::make_index_sequence<std::tuple_size_v<decltype(kLayout<Frame>.fields)>>;

template <typename Frame, std::size_t... I>
constexpr std::uint64_t wordOf(const Frame& values, std::index_sequence<I...>) {
  return (insertRaw(kFieldBits<Frame, I>, rawOf(values.*kMember<Frame, I>)) | ...);
}

template <typename Frame, std::size_t... I>
constexpr void readWord(std::uint64_t word, Frame& values, std::index_sequence<I...>) {
  ((values.*kMember<Frame, I> = memberOf<std::remove_reference_t<decltype(values.*kMember<Frame, I>)>>(
        extractRaw(kFieldBits<Frame, I>, word))),
   ...);
}

/// The frame as it goes on the bus; node 1 .. 63. Values outside a field's valid ones are sent as the nearest
/// valid one (sendableRaw); bits that belong to no field are 0.
template <WireFrame Frame>
constexpr CanFrame encode(const Frame& values, std::uint8_t node) {
  constexpr FunctionCode function = kLayout<Frame>.spec.function;
  constexpr std::uint8_t length = kLayout<Frame>.spec.length;
  return fromWord(canId(function, node), length, wordOf(values, FieldIndices<Frame>{}));
}

/// The values of a frame; nothing if the identifier or the length is another's. Whose it is: nodeOf().
template <WireFrame Frame>
constexpr std::optional<Frame> decode(const CanFrame& frame) {
  constexpr FunctionCode function = kLayout<Frame>.spec.function;
  constexpr std::uint8_t length = kLayout<Frame>.spec.length;
  if (!nodeOf(frame.id, function) || frame.length != length) return std::nullopt;
  Frame values;
  readWord(toWord(frame), values, FieldIndices<Frame>{});
  return values;
}

}  // namespace strainfinger
