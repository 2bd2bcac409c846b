#include "host/cli/recording_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>
#include <utility>

#include "common/crc32.hpp"
#include "host/base/utc_text.hpp"
#include "host/can/other_tables.hpp"
#include "host/config/write_config.hpp"

namespace strainfinger::cli {
namespace {

/// A TOML string that holds any bytes but control characters, which a bus' name hasn't.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result.append(c == '"' || c == '\\' ? "\\" : "").push_back(c);
  return result + "\"";
}

/// Of a finger whose tables come and go, the first ones are enough.
constexpr std::size_t kMostTables = 100;

bool sameBoard(const InfoFrame& a, const InfoFrame& b) {
  return a.board == b.board && a.version_major == b.version_major && a.version_minor == b.version_minor;
}

bool sameFirmware(const HeartbeatFrame& a, const HeartbeatFrame& b) {
  return a.protocol == b.protocol && a.table_crc == b.table_crc;
}

}  // namespace

RecordingNotes::RecordingNotes(std::string bus, const config::FingerConfig& config)
    : bus_(std::move(bus)), config_(config::writeConfig(config)) {}

void RecordingNotes::Finger::noteTables(const HeartbeatFrame& of) {
  if (of.protocol != kProtocolVersion || of.state == FingerState::kFault) return;
  const auto last = std::exchange(tables, of.table_crc);
  if (last && *last != of.table_crc && tablesBefore.size() < kMostTables) tablesBefore.push_back(*last);
}

bool RecordingNotes::note(const CanFrame& frame) {
  if (const auto info = decode<InfoFrame>(frame)) {
    std::optional<InfoFrame>& known = fingers_[*nodeOf(frame.id, FunctionCode::kInfo)].info;
    const auto before = std::exchange(known, info);
    return !before || !sameBoard(*before, *info);
  }
  if (const auto heartbeat = decode<HeartbeatFrame>(frame)) {
    Finger& finger = fingers_[*nodeOf(frame.id, FunctionCode::kHeartbeat)];
    const auto before = std::exchange(finger.heartbeat, heartbeat);
    finger.noteTables(*heartbeat);
    return !before || !sameFirmware(*before, *heartbeat);
  }
  return false;
}

std::vector<std::uint8_t> RecordingNotes::nodesOfOtherTables(std::uint32_t tables_crc32) const {
  std::vector<std::uint8_t> nodes;
  for (const auto& [node, finger] : fingers_)
    if (finger.heartbeat && can::hasOtherTables(*finger.heartbeat, tables_crc32)) nodes.push_back(node);
  return nodes;
}

std::string RecordingNotes::toml(const RecordingProgress& progress) const {
  std::string text = config_ + "\n[recording]\n";
  text += fmt::format("program = \"{}\"\nprotocol = {}\nbus = {}\nstart = {}\n", STRAINFINGER_VERSION,
                      kProtocolVersion, quoted(bus_), utcText(progress.start_ns));
  if (progress.end_ns != 0)
    text += fmt::format("end = {}\nframes = {}\nmissed = {}\n", utcText(progress.end_ns), progress.frames,
                        progress.missed);
  text += fmt::format("gaps = {}\n", progress.gaps);
  text += fmt::format("# of the text above [recording]\nconfig_crc32 = \"{:08X}\"\n",
                      crc32(std::as_bytes(std::span(config_))));
  for (const RecordingGap& gap : progress.firstGaps) {
    text += fmt::format("\n[[recording.gap]]\nstart = {}\n", utcText(gap.start_ns));
    if (gap.end_ns != 0) text += fmt::format("end = {}\n", utcText(gap.end_ns));
  }
  for (const auto& [node, finger] : fingers_) {
    text += fmt::format("\n[[recording.finger]]\nnode = {}\n", node);
    if (finger.info)
      text += fmt::format("version = \"{}.{}\"\nboard = {}\n", finger.info->version_major,
                          finger.info->version_minor, finger.info->board);
    if (finger.heartbeat)
      text +=
          fmt::format("protocol = {}\n# lowest byte of the CRC-32 of its tables\ntable_crc = \"{:02X}\"\n",
                      finger.heartbeat->protocol, finger.heartbeat->table_crc);
    if (!finger.tablesBefore.empty())
      text += fmt::format("table_crc_before = [\"{:02X}\"]\n", fmt::join(finger.tablesBefore, "\", \""));
  }
  return text;
}

}  // namespace strainfinger::cli
