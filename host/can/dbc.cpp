#include "host/can/dbc.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "common/frames.hpp"
#include "host/can/frame_catalogue.hpp"

namespace strainfinger::can {
namespace {

struct NamedValue {
  std::int64_t raw;
  std::string name;
};

/// A field, or one named bit of a flags field.
struct Signal {
  std::string name;
  FieldBits bits;
  double factor;
  double min, max;
  std::string unit;
  std::string comment;
  std::vector<NamedValue> values;
};

struct Message {
  std::string name;
  std::string finger;  ///< that sends it, or is asked by it
  FrameSpec spec;
  std::uint16_t id;
  std::vector<Signal> signals;
};

std::vector<NamedValue> namedValues(const FieldSpec& field) {
  std::vector<NamedValue> values;
  for (const ValueName& value : field.meaning.names) values.push_back({value.value, value.name});
  if (field.meaning.openEnded) values.push_back({maxRaw(field.bits), "this_or_more"});
  if (field.meaning.openEnded && field.bits.isSigned) values.push_back({minRaw(field.bits), "this_or_less"});
  if (field.bits.unknowable) values.push_back({invalidRaw(field.bits), "not_known"});
  return values;
}

Signal fieldSignal(const FieldSpec& field) {
  const auto& [bits, meaning] = field;
  return {meaning.name,
          bits,
          stepOf(meaning),
          *toPhysical(field, minRaw(bits)),
          *toPhysical(field, maxRaw(bits)),
          meaning.unit,
          meaning.comment,
          namedValues(field)};
}

Signal flagSignal(const FieldSpec& field, const ValueName& flag) {
  const FieldBits bit{.lsb = static_cast<std::uint8_t>(field.bits.lsb + flag.value), .width = 1};
  return {flag.name, bit, 1, 0, 1, "", flag.comment, {{0, "no"}, {1, "yes"}}};
}

Message message(const FrameEntry& entry, std::uint8_t node) {
  Message result{
      entry.spec.name, fmt::format("FINGER_{}", node), entry.spec, canId(entry.spec.function, node), {}};
  for (const FieldSpec& field : entry.fields) {
    if (field.meaning.kind != FieldKind::kFlags || field.meaning.names.empty())
      result.signals.push_back(fieldSignal(field));
    else
      for (const ValueName& flag : field.meaning.names) result.signals.push_back(flagSignal(field, flag));
  }
  return result;
}

/// The file, section by section, in the order the format prescribes.
class DbcWriter {
 public:
  DbcWriter(const std::vector<int>& nodes, double contactRate_hz)
      : delay_ms_(static_cast<int>(std::clamp(std::round(1000 / contactRate_hz), 0.0, 65535.0))) {
    for (const int node : nodes) {
      for (const auto catalogue : {frameCatalogue(), commandCatalogue()})
        for (const FrameEntry& entry : catalogue)
          messages_.push_back(message(entry, static_cast<std::uint8_t>(node)));
      fingers_.push_back(messages_.back().finger);
    }
    if (nodes.size() == 1) return;
    for (Message& each : messages_) each.name += each.finger.substr(each.finger.rfind('_'));
  }

  std::string text() {
    line("VERSION \"protocol {}\"\n\nNS_ :\n\nBS_:\n\nBU_: {} {}\n", kProtocolVersion,
         fmt::join(fingers_, " "), kHost);
    for (const Message& each : messages_) writeMessage(each);
    for (const std::string& finger : fingers_)
      line("CM_ BU_ {} \"Tactile finger: where it is touched, and how hard\";", finger);
    line("CM_ BU_ {} \"Whoever listens, and asks\";", kHost);
    for (const Message& each : messages_) writeComments(each);
    writeAttributes();
    for (const Message& each : messages_) writeValues(each);
    return std::move(text_);
  }

 private:
  static constexpr std::string_view kHost = "HOST";

  void writeMessage(const Message& message) {
    const bool asked = message.spec.function == FunctionCode::kRequest;
    const std::string_view from = asked ? kHost : message.finger, to = asked ? message.finger : kHost;
    line("BO_ {} {}: {} {}", message.id, message.name, message.spec.length, from);
    for (const Signal& signal : message.signals)
      line(" SG_ {} : {}|{}@1{} ({},0) [{}|{}] \"{}\" {}", signal.name, signal.bits.lsb, signal.bits.width,
           signal.bits.isSigned ? '-' : '+', signal.factor, signal.min, signal.max, signal.unit, to);
    line("");
  }

  void writeComments(const Message& message) {
    line("CM_ BO_ {} \"{}\";", message.id, message.spec.comment);
    for (const Signal& signal : message.signals)
      line("CM_ SG_ {} {} \"{}\";", message.id, signal.name, signal.comment);
  }

  void writeAttributes() {
    line("BA_DEF_ \"BusType\" STRING ;");
    for (const char* name : {"GenMsgCycleTime", "GenMsgDelayTime"})
      line("BA_DEF_ BO_ \"{}\" INT 0 65535;", name);
    line("BA_DEF_DEF_ \"BusType\" \"CAN\";");
    for (const char* name : {"GenMsgCycleTime", "GenMsgDelayTime"}) line("BA_DEF_DEF_ \"{}\" 0;", name);
    line("BA_ \"BusType\" \"CAN\";");
    for (const Message& each : messages_) {
      if (each.spec.period_ms != 0) line("BA_ \"GenMsgCycleTime\" BO_ {} {};", each.id, each.spec.period_ms);
      if (each.spec.onChange) line("BA_ \"GenMsgDelayTime\" BO_ {} {};", each.id, delay_ms_);
    }
  }

  void writeValues(const Message& message) {
    for (const Signal& signal : message.signals) {
      if (signal.values.empty()) continue;
      std::string values;
      for (const NamedValue& value : signal.values)
        fmt::format_to(std::back_inserter(values), "{} \"{}\" ", value.raw, value.name);
      line("VAL_ {} {} {};", message.id, signal.name, values);
    }
  }

  template <typename... Parts>
  void line(fmt::format_string<Parts...> format, Parts&&... parts) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Parts>(parts)...);
    text_.push_back('\n');
  }

  int delay_ms_;
  std::vector<std::string> fingers_;
  std::vector<Message> messages_;
  std::string text_;
};

}  // namespace

std::string dbcText(const std::vector<int>& nodes, double contactRate_hz) {
  return DbcWriter(nodes, contactRate_hz).text();
}

}  // namespace strainfinger::can
