#include "host/base/number_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "host/base/failure.hpp"

namespace strainfinger {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// True if all of `text` is a number; NaN and infinities are.
bool parseNumber(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// A row in which nothing is a number, between commas or semicolons.
bool isAllNames(const std::string& line) {
  double value = 0;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find_first_of(",;", begin), line.size());
    if (parseNumber(trimmed(std::string_view(line).substr(begin, end - begin)), value)) return false;
    begin = end + 1;
  }
  return true;
}

bool isPassedOver(const std::string& line) {
  const std::string_view content = trimmed(line);
  return content.empty() || content.front() == '#';
}

}  // namespace

NumberRowReader::NumberRowReader(std::istream& stream, std::string name, std::size_t columns, Limit limit)
    : stream_(stream), name_(std::move(name)), columns_(columns), limit_(std::move(limit)) {}

bool NumberRowReader::next(std::vector<double>& row) {
  for (std::string line; std::getline(stream_, line);) {
    ++line_;
    if (isPassedOver(line)) continue;
    const bool isHeader = mayBeHeader_ && isAllNames(line);
    mayBeHeader_ = false;
    if (isHeader) {
      takeHeader(line);
      continue;
    }
    parse(line, row);
    return true;
  }
  return false;
}

void NumberRowReader::takeHeader(const std::string& line) const {
  std::string names = line;
  std::erase_if(names, [](char c) { return kBlanks.find(c) != std::string_view::npos; });
  const bool isCommas = names.find(';') == std::string::npos;  // or the rows tell of semicolons
  if (isCommas && !limit_.header.empty() && names != limit_.header)
    fail(1, fmt::format("the header is \"{}\", not \"{}\"", names, limit_.header));
}

void NumberRowReader::parse(const std::string& line, std::vector<double>& row) const {
  row.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view field = trimmed(std::string_view(line).substr(begin, end - begin));
    double value = 0;
    if (field.find(';') != std::string_view::npos)
      fail(begin + 1, fmt::format("\"{}\" has semicolons: separate columns by commas", field));
    if (!parseNumber(field, value)) fail(begin + 1, fmt::format("\"{}\" is no number", field));
    if (!std::isfinite(value)) fail(begin + 1, fmt::format("{} is no finite number", field));
    if (std::abs(value) > limit_.most)
      fail(begin + 1, fmt::format("{} is beyond +-{}: {}", field, limit_.most, limit_.hint));
    if (row.size() == columns_) fail(begin + 1, fmt::format("more than {} columns", columns_));
    row.push_back(value);
    begin = end + 1;
  }
  if (row.size() < columns_)
    fail(line.size() + 1, fmt::format("{} columns where {} are needed", row.size(), columns_));
}

void NumberRowReader::fail(std::size_t column, const std::string& what) const {
  throw Failure(ExitCode::kFailure, fmt::format("{}:{}:{}: {}", name_, line_, column, what));
}

}  // namespace strainfinger
