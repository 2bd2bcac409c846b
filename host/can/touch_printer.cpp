#include "host/can/touch_printer.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {
namespace {

double second(const TouchReport& touch, double ContactReport::*value) {
  const auto& said = touch.second ? touch.second : touch.secondsEnd;
  return said ? (*said).*value : kNoValue;
}

struct TouchColumn {
  std::string_view name;
  double (*valueOf)(const TouchReport& touch);  ///< null: it has the flags, as text
};
using Touch = const TouchReport&;
constexpr std::array kTouchColumns{
    TouchColumn{"angle_deg", [](Touch touch) { return touch.angle_deg; }},
    TouchColumn{"normal_n", [](Touch touch) { return touch.normal_n; }},
    TouchColumn{"tangential_n", [](Touch touch) { return touch.tangential_n; }},
    TouchColumn{"width_m", [](Touch touch) { return touch.width_m; }},
    TouchColumn{"sigma_angle_deg", [](Touch touch) { return touch.sigmaAngle_deg; }},
    TouchColumn{"sigma_normal_n", [](Touch touch) { return touch.sigmaNormal_n; }},
    TouchColumn{"sigma_tangential_n", [](Touch touch) { return touch.sigmaTangential_n; }},
    TouchColumn{"sigma_width_m", [](Touch touch) { return touch.sigmaWidth_m; }},
    TouchColumn{"quality_percent", [](Touch touch) { return touch.quality_percent; }},
    TouchColumn{"chi", [](Touch touch) { return touch.chi; }},
    TouchColumn{"flags", nullptr},
    TouchColumn{"sequence", [](Touch touch) { return static_cast<double>(touch.sequence); }},
    TouchColumn{"angle2_deg", [](Touch touch) { return second(touch, &ContactReport::angle_deg); }},
    TouchColumn{"normal2_n", [](Touch touch) { return second(touch, &ContactReport::normal_n); }},
    TouchColumn{"tangential2_n", [](Touch touch) { return second(touch, &ContactReport::tangential_n); }},
    TouchColumn{"alternative_deg", [](Touch touch) { return touch.alternative_deg; }},
    TouchColumn{"contacts", [](Touch touch) { return touch.contacts; }},
    TouchColumn{"sigma_angle2_deg",
                [](Touch touch) { return second(touch, &ContactReport::sigmaAngle_deg); }},
    TouchColumn{"sigma_normal2_n", [](Touch touch) { return second(touch, &ContactReport::sigmaNormal_n); }},
    TouchColumn{"sigma_tangential2_n",
                [](Touch touch) { return second(touch, &ContactReport::sigmaTangential_n); }},
    TouchColumn{"quality2_percent",
                [](Touch touch) { return second(touch, &ContactReport::quality_percent); }},
    TouchColumn{"alternative2_deg",
                [](Touch touch) { return second(touch, &ContactReport::alternative_deg); }},
};

}  // namespace

TouchPrinter::TouchPrinter(std::string& out, TableFormat format)
    : out_(out), format_(format), start_(format) {
  if (format != TableFormat::kCsv) return;
  out.append(RowStart::kColumns);
  for (const TouchColumn& column : kTouchColumns) out.append(",").append(column.name);
  out.push_back('\n');
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
  for (const TouchColumn& column : kTouchColumns) {
    out_.push_back(',');
    if (format_ == TableFormat::kJson) out_.append("\"").append(column.name).append("\":");
    if (column.valueOf != nullptr)
      appendNumber(column.valueOf(touch));
    else
      appendFlags(touch.flags);
  }
}

void TouchPrinter::appendNumber(double value) {
  if (!std::isnan(value))
    fmt::format_to(std::back_inserter(out_), "{}", value);
  else if (format_ == TableFormat::kJson)
    out_.append("null");
}

void TouchPrinter::appendFlags(FingerFlags flags) {
  const char* const quote = format_ == TableFormat::kJson ? "\"" : "";
  out_.append(quote).append(flagsText(kFingerFlagNames, flags.raw())).append(quote);
}

}  // namespace strainfinger::can
