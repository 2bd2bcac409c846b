#include "host/can/frame_catalogue.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>

#include "common/commands.hpp"
#include "common/frames.hpp"

namespace strainfinger::can {
namespace {

template <typename Frame>
constexpr auto kFieldSpecs = kLayout<Frame>.fieldSpecs();

template <typename... Frames>
constexpr auto catalogueOf(std::type_identity<std::tuple<Frames...>>) {
  return std::array{FrameEntry{kLayout<Frames>.spec, kFieldSpecs<Frames>}...};
}

constexpr auto kCatalogue = catalogueOf(std::type_identity<FingerFrames>{});
constexpr auto kCommandCatalogue = catalogueOf(std::type_identity<CommandFrames>{});

/// The entry of each function code; null where fingers send nothing by themselves.
constexpr auto kByFunction = [] {
  std::array<const FrameEntry*, (kMaxCanId + 1) / kIdsPerFunction> entries{};
  for (const FrameEntry& entry : kCatalogue)
    entries[static_cast<std::uint16_t>(entry.spec.function) / kIdsPerFunction] = &entry;
  return entries;
}();

}  // namespace

std::span<const FrameEntry> frameCatalogue() { return kCatalogue; }
std::span<const FrameEntry> commandCatalogue() { return kCommandCatalogue; }

const FrameEntry* findFunction(std::uint16_t id) {
  const FrameEntry* const entry = kByFunction[(id & kMaxCanId) / kIdsPerFunction];
  return entry != nullptr && nodeOf(id, entry->spec.function) ? entry : nullptr;
}

const FrameEntry* findFrame(const CanFrame& frame) {
  const FrameEntry* const entry = findFunction(frame.id);
  return entry != nullptr && frame.length == entry->spec.length ? entry : nullptr;
}

const FrameEntry* findCommand(const CanFrame& frame) {
  for (const FrameEntry& entry : commandCatalogue()) {
    const auto node = nodeOf(frame.id, entry.spec.function);
    if (!node) continue;
    const auto request = readSingleFrame<RequestFrame>(frame, *node);
    const auto response = readSingleFrame<ResponseFrame>(frame, *node);
    if (!request && !response) return nullptr;
    const Command command = request ? request->command : response->command;
    return findName(kCommandNames, static_cast<std::int64_t>(command)) != nullptr ? &entry : nullptr;
  }
  return nullptr;
}

const FrameEntry* findAnyFrame(const CanFrame& frame) {
  if (const FrameEntry* const entry = findFrame(frame)) return entry;
  if (!nodeOf(frame.id, FunctionCode::kRaw)) return findCommand(frame);
  constexpr auto kFunctionOf = [](const FrameEntry& entry) { return entry.spec.function; };
  const auto raw = std::ranges::find(commandCatalogue(), FunctionCode::kRaw, kFunctionOf);
  return frame.length == raw->spec.length ? &*raw : nullptr;
}

const ValueName* findName(std::span<const ValueName> names, std::int64_t value) {
  const auto found = std::ranges::find(names, value, &ValueName::value);
  return found != names.end() ? &*found : nullptr;
}

std::string nameText(std::span<const ValueName> names, std::int64_t value) {
  const ValueName* const name = findName(names, value);
  return name != nullptr ? name->name : std::to_string(value);
}

std::string flagsText(std::span<const ValueName> names, std::uint32_t bits) {
  std::string text;
  for (int bit = 0; bit < 32; ++bit) {
    if ((bits >> bit & 1U) == 0) continue;
    if (!text.empty()) text.push_back('+');
    text.append(nameText(names, bit));
  }
  return text;
}

double stepOf(const FieldMeaning& meaning) {
  return static_cast<double>(meaning.unitsPerStep) / meaning.stepsPerUnit;
}

std::optional<double> toPhysical(const FieldSpec& field, std::int64_t raw) {
  if (!isValidRaw(field.bits, raw)) return std::nullopt;
  return static_cast<double>(raw * field.meaning.unitsPerStep) / field.meaning.stepsPerUnit;
}

}  // namespace strainfinger::can
