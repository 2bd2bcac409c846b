#pragma once
// The frames' tables as values, for code that treats all frames alike: printer, DBC file, documents.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/can_frame.hpp"
#include "common/frame_layout.hpp"

namespace strainfinger::can {

/// Function codes are multiples of this.
inline constexpr std::uint16_t kIdsPerFunction = 0x80;

/// The node of an identifier that a finger may have, whatever the function; nothing where it is no finger's:
/// other devices have nodes of their own, up to 127.
constexpr std::optional<std::uint8_t> fingerNode(std::uint16_t id) {
  const int node = id % kIdsPerFunction;
  if (node < kFirstNode || node > kLastNode) return std::nullopt;
  return static_cast<std::uint8_t>(node);
}

struct FrameEntry {
  FrameSpec spec;
  std::span<const FieldSpec> fields;  ///< in the order of their bits
};

/// Every frame a finger sends by itself.
std::span<const FrameEntry> frameCatalogue();

/// Requests to a finger, its responses, and RAW.
std::span<const FrameEntry> commandCatalogue();

/// Which of frameCatalogue() has this identifier, whatever the length; null if none.
const FrameEntry* findFunction(std::uint16_t id);

/// Which of frameCatalogue() the frame is, by identifier and length; null if none.
const FrameEntry* findFrame(const CanFrame& frame);

/// Which of commandCatalogue() the frame is: a whole request or response with a command that there is. Other
/// devices' frames of the same identifiers (CANopen's SDO) hardly ever look like one. Null if none.
const FrameEntry* findCommand(const CanFrame& frame);

/// Any of the above, or RAW; null if none.
const FrameEntry* findAnyFrame(const CanFrame& frame);

/// The name of a value, or of a bit; null if it has none.
const ValueName* findName(std::span<const ValueName> names, std::int64_t value);

/// That name; the number where it has none.
std::string nameText(std::span<const ValueName> names, std::int64_t value);

/// Names of the bits that are set, lowest first, joined by '+'.
std::string flagsText(std::span<const ValueName> names, std::uint32_t bits);

/// What one step of the raw value is, in the field's unit.
double stepOf(const FieldMeaning& meaning);

/// The raw value in the field's unit; nothing where it is not a valid one (not known, or reserved).
std::optional<double> toPhysical(const FieldSpec& field, std::int64_t raw);

}  // namespace strainfinger::can
