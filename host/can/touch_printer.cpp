#include "host/can/touch_printer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "host/can/frame_printer.hpp"

namespace strainfinger::can {
namespace {

constexpr std::string_view kTouchColumns =
    ",angle_deg,normal_n,tangential_n,width_m,sigma_angle_deg,sigma_normal_n,sigma_tangential_n,sigma_width_"
    "m,quality_percent,chi,flags,sequence,angle2_deg,normal2_n,tangential2_n\n";

constexpr FieldSpec kTouchFlags{
    {.lsb = 0, .width = 8},
    {.name = "flags", .comment = "Of the touch", .kind = FieldKind::kFlags, .names = kFingerFlagNames}};

}  // namespace

TouchPrinter::TouchPrinter(std::string& out, TableFormat format)
    : out_(out), format_(format), start_(format) {
  if (format == TableFormat::kCsv) out.append(RowStart::kColumns).append(kTouchColumns);
}

void TouchPrinter::print(std::optional<std::int64_t> time_ns, std::string_view interface,
                         const CanFrame& frame) {
  const FrameEntry* const entry = findFrame(frame);
  if (entry == nullptr) return;
  const std::uint8_t node = *nodeOf(frame.id, entry->spec.function);
  Listener& listener = listeners_.at(interface, node);
  const FunctionCode function = entry->spec.function;
  if (!listener.receiver) listener.receiver.emplace(node);
  if (isRepeated(listener, function, frame)) return;
  if (showsEnd(listener, function)) giveUp(interface, node, listener);
  if (function == FunctionCode::kContact) {
    listener.contact = frame;
    listener.contactTime_ns = time_ns;
    listener.heartbeats = 0;
  }
  appendRow(listener.receiver->take(frame), interface, node, listener);
}

void TouchPrinter::finish() {
  listeners_.forEach([this](const std::string& interface, std::uint8_t node, Listener& listener) {
    giveUp(interface, node, listener);
  });
}

/// The CONTACT before came twice. One that says the same later is another: of a finger that started anew.
bool TouchPrinter::isRepeated(const Listener& listener, FunctionCode function, const CanFrame& frame) {
  return function == FunctionCode::kContact && frame == listener.contact && listener.heartbeats < 2;
}

/// A touch's frames go out together. One HEARTBEAT may get in between: of the end of a touch, which no
/// CONTACT follows, the next one shows that there is no more.
bool TouchPrinter::showsEnd(Listener& listener, FunctionCode function) {
  if (function == FunctionCode::kHeartbeat) return ++listener.heartbeats >= 2;
  return function == FunctionCode::kContact;
}

void TouchPrinter::giveUp(std::string_view interface, std::uint8_t node, Listener& listener) {
  appendRow(listener.receiver->giveUp(), interface, node, listener);
}

void TouchPrinter::appendRow(const std::optional<TouchReport>& touch, std::string_view interface,
                             std::uint8_t node, const Listener& listener) {
  if (!touch) return;
  start_.append(out_, listener.contactTime_ns, interface, node);
  append(*touch);
  endRow(out_, format_);
}

void TouchPrinter::append(const TouchReport& touch) {
  const ContactReport second = touch.second.value_or(ContactReport{});
  appendNumber("angle_deg", touch.angle_deg);
  appendNumber("normal_n", touch.normal_n);
  appendNumber("tangential_n", touch.tangential_n);
  appendNumber("width_m", touch.width_m);
  appendNumber("sigma_angle_deg", touch.sigmaAngle_deg);
  appendNumber("sigma_normal_n", touch.sigmaNormal_n);
  appendNumber("sigma_tangential_n", touch.sigmaTangential_n);
  appendNumber("sigma_width_m", touch.sigmaWidth_m);
  appendNumber("quality_percent", touch.quality_percent);
  appendNumber("chi", touch.chi);
  appendKey("flags");
  const char* const quote = format_ == TableFormat::kJson ? "\"" : "";
  out_.append(quote).append(valueText(kTouchFlags, touch.flags.raw())).append(quote);
  appendNumber("sequence", touch.sequence);
  appendNumber("angle2_deg", second.angle_deg);
  appendNumber("normal2_n", second.normal_n);
  appendNumber("tangential2_n", second.tangential_n);
}

void TouchPrinter::appendKey(std::string_view name) {
  out_.push_back(',');
  if (format_ == TableFormat::kJson) out_.append("\"").append(name).append("\":");
}

void TouchPrinter::appendNumber(std::string_view name, double value) {
  appendKey(name);
  if (!std::isnan(value))
    fmt::format_to(std::back_inserter(out_), "{}", value);
  else if (format_ == TableFormat::kJson)
    out_.append("null");
}

}  // namespace strainfinger::can
