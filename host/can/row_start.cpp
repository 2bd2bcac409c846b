#include "host/can/row_start.hpp"

#include <fmt/format.h>

namespace strainfinger::can {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

void appendPadded(std::string& out, std::int64_t number, std::size_t width) {
  const fmt::format_int digits(number);
  out.append(width - digits.size(), '0').append(digits.data(), digits.size());
}

void appendCsvTime(std::string& out, std::int64_t time_ns) {
  const fmt::format_int seconds(time_ns / kSecond_ns);
  out.append(seconds.data(), seconds.size()).push_back('.');
  if (time_ns % 1000 == 0)
    appendPadded(out, time_ns % kSecond_ns / 1000, 6);
  else
    appendPadded(out, time_ns % kSecond_ns, 9);
}

/// As in CSV, without zeros at its end: as a double it would be another one than a reader of the CSV has.
void appendJsonTime(std::string& out, std::int64_t time_ns) {
  appendCsvTime(out, time_ns);
  out.resize(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.push_back('0');
}

}  // namespace

void RowStart::append(std::string& out, std::optional<std::int64_t> time_ns, std::string_view interface,
                      int node) {
  const bool json = format_ == TableFormat::kJson;
  if (interface_ != interface || interfaceText_.empty()) {
    interface_ = interface;
    interfaceText_ = json ? jsonString(interface_) : csvField(interface_);
  }
  if (json) out.append("{\"time_s\":");
  if (time_ns && json) appendJsonTime(out, *time_ns);
  if (time_ns && !json) appendCsvTime(out, *time_ns);
  if (!time_ns && json) out.append("null");
  const fmt::format_int nodeText(node);
  out.append(json ? ",\"interface\":" : ",").append(interfaceText_);
  out.append(json ? ",\"node\":" : ",").append(nodeText.data(), nodeText.size());
}

}  // namespace strainfinger::can
