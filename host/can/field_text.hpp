#pragma once
// What the fields of a frame say, as text.

#include <cstdint>
#include <string>
#include <vector>

#include "common/can_frame.hpp"
#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {

/// The column of a field: its name and its unit, "angle_deg".
std::string columnName(const FieldMeaning& meaning);

/// Choices and flags by name, joined by '+' ("contact+simulated"); a value or bit without a name by its
/// number.
std::string valueText(const FieldSpec& field, std::int64_t raw);

/// The field says something: how a request is carried says nothing to a reader.
bool isShown(const FieldSpec& field);

/// Bits of the frame that were sent, 8 to 64: a command counts the bytes behind its first one that matter.
/// Domain, here and below: `entry` is what findAnyFrame() has for the frame.
int sentBits(const CanFrame& frame, const FrameEntry& entry);

/// The frame's bits, without what does not count: padding behind a command's bytes is 0.
std::uint64_t sentWord(const CanFrame& frame, const FrameEntry& entry);

/// The raw value was sent and is none that stands for "not known".
bool isKnown(const FieldSpec& field, std::int64_t raw, int sentBits);

/// The value stands for itself and anything beyond it: see FieldMeaning::openEnded.
bool isOrMore(const FieldSpec& field, std::int64_t raw);

/// A field of a frame, and what it says.
struct FieldValue {
  const FieldSpec* field;
  std::int64_t raw;
  bool isKnown;
  bool isOrMore;  ///< the end of what it can say: the true value may be beyond it
};

/// Those that are shown, in the order of their bits. `entry`: which frame it is.
std::vector<FieldValue> fieldValues(const FrameEntry& entry, const CanFrame& frame);

/// A value in its unit, exactly and without the unit: "102.1", ">=0.127" where it is that or more
/// ("<=-32.767": or less), "contact+simulated", "none"; "?" where it is not known.
std::string textOf(const FieldValue& value);

}  // namespace strainfinger::can
