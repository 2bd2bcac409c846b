#include "host/base/number_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <optional>
#include <string_view>
#include <utility>

#include "host/base/byte_order_mark.hpp"
#include "host/base/compressed.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/line_reader.hpp"
#include "host/base/notice.hpp"
#include "host/base/parse_number.hpp"
#include "host/base/text_parts.hpp"

namespace strainfinger {
namespace {

constexpr std::array kOtherSeparators{std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}};
/// What numbers consist of, and parts of them.
constexpr const char* kOfNumbers = "+-.0123456789eE";
/// What other programs write where there is no number; NaN and infinities are numbers to signedNumber().
constexpr std::array kNoNumbers{"na", "n/a", "null", "none", "nil", "missing", "empty"};

/// All of `text` as a number, which may begin with a +.
std::optional<double> signedNumber(std::string_view text) {
  if (text.starts_with("+-")) return std::nullopt;
  if (text.starts_with('+')) text.remove_prefix(1);
  return parseNumber<double>(text);
}

/// Where a field that begins at `begin` ends: at the next comma, or, if it is quoted, the next behind its
/// closing quote. A quote in it is written twice (RFC 4180). Nothing: a quote is not closed.
std::optional<std::size_t> endOfField(std::string_view line, std::size_t begin) {
  const std::size_t first = std::min(line.find_first_not_of(kBlanks, begin), line.size());
  if (first == line.size() || line[first] != '"') return std::min(line.find(',', first), line.size());
  for (std::size_t quote = line.find('"', first + 1); quote != line.npos; quote = line.find('"', quote + 2))
    if (quote + 1 == line.size() || line[quote + 1] != '"')
      return std::min(line.find(',', quote), line.size());
  return std::nullopt;
}

std::vector<std::string_view> fieldsOf(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = endOfField(line, begin).value_or(line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return fields;
}

/// Without the blanks around it, and its quotes.
std::string textOf(std::string_view field) {
  const std::string_view inside = trimmed(field);
  const bool isQuoted = inside.size() >= 2 && inside.starts_with('"') && inside.ends_with('"');
  if (!isQuoted) return std::string(inside);
  std::string text;
  for (std::size_t i = 1; i + 1 < inside.size(); ++i) {
    text += inside[i];
    if (inside[i] == '"' && i + 2 < inside.size() && inside[i + 1] == '"') ++i;
  }
  return text;
}

std::vector<std::string> namesOf(std::string_view line) {
  std::vector<std::string> names;
  for (const std::string_view field : fieldsOf(line)) names.push_back(textOf(field));
  return names;
}

/// Of a field in its line, from 1.
std::size_t columnOf(std::string_view field, const std::string& line) {
  return static_cast<std::size_t>(field.data() - line.data()) + 1;
}

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool isNoNumberOf(std::string_view field, const char* word) {
  return field.size() == std::strlen(word) && strncasecmp(field.data(), word, field.size()) == 0;
}

/// Of a column: nothing that could have been meant as a value, or as several.
bool isName(std::string_view field) {
  const std::string name = textOf(field);
  const auto standsForNone = [&](const char* word) { return isNoNumberOf(name, word); };
  return !name.empty() && isLetter(name.front()) && name.find_first_of(";\t") == std::string_view::npos &&
         !signedNumber(name) && std::ranges::none_of(kNoNumbers, standsForNone);
}

bool isAllNames(std::string_view line) {
  const auto fields = fieldsOf(line);
  return std::all_of(fields.begin(), fields.end(), isName);
}

/// Two fields that may be one number, whose fraction a comma sets off; what to do then. Empty: there are
/// none.
std::string decimalCommaHint(const std::vector<std::string_view>& fields) {
  for (std::size_t i = 0; i + 1 < fields.size(); ++i) {
    const std::string_view both(fields[i].data(), fields[i].size() + 1 + fields[i + 1].size());
    if (const auto point = withPoint(both))
      return fmt::format("; if {} is one number, write {} with a point", both, *point);
  }
  return {};
}

bool isPassedOver(const std::string& line) {
  const std::string_view content = trimmed(line);
  return content.empty() || content.front() == '#';
}

}  // namespace

NumberRowReader::NumberRowReader(std::istream& stream, std::string name, std::size_t columns, Limit limit)
    : stream_(stream),
      name_(std::move(name)),
      columns_(columns),
      limit_(std::move(limit)),
      buffer_(LineReader::kLongestLine_bytes + 1) {}

bool NumberRowReader::next(std::vector<double>& row) {
  for (std::string line; readLine(line);) {
    if (line_ == 1) requireUncompressed(name_, line);
    if (line_ == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
    if (isPassedOver(line)) continue;
    const bool isFirst = std::exchange(mayBeHeader_, false);
    if (isFirst && isAllNames(line)) {
      takeHeader(line);
      continue;
    }
    if (isHeaderAgain(line)) continue;
    isCut_ = !isFirst && stream_.eof() && isCut(line);
    if (isCut_) {
      tell("strainfinger: {}: the file ends in the middle of this line, which is left out\n", place());
      return false;
    }
    parse(line, row);
    return true;
  }
  requireReadable();
  return false;
}

/// Of a line without its end: too few fields, or the last one may be part of a number alone, as one that is
/// beyond the limit for want of its exponent.
bool NumberRowReader::isCut(const std::string& line) const {
  const auto fields = fieldsOf(line);
  const std::size_t needed = columns_ + otherNames_.size();
  if (fields.size() != needed) return fields.size() < needed;
  const bool isText = !places_.empty() && places_.back() == columns_;
  const std::string last = textOf(fields.back());
  const bool mayBeNumber = last.find_first_not_of(kOfNumbers) == std::string::npos;
  const auto value = signedNumber(last);
  const bool isWhole = value ? std::abs(*value) <= limit_.most : last.empty() && limit_.mayBeEmpty;
  return !isText && mayBeNumber && !isWhole;
}

bool NumberRowReader::isHeaderAgain(std::string_view line) const {
  if (header_.empty()) return false;
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  const std::string_view content = trimmed(line);
  const bool mayBeNames = !content.empty() && (isLetter(content.front()) || content.front() == '"');
  return mayBeNames && namesOf(line) == header_;
}

bool NumberRowReader::readLine(std::string& line) {
  stream_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  const auto count = static_cast<std::size_t>(stream_.gcount());
  if (count == 0 || stream_.bad()) return false;
  ++line_;
  if (stream_.fail())
    fail(count + 1, fmt::format("the line has more than {} bytes", LineReader::kLongestLine_bytes));
  line.assign(buffer_.data(), stream_.eof() ? count : count - 1);
  return true;
}

/// Its end, not an error of reading. std::cin reads through stdin, which alone knows of those.
void NumberRowReader::requireReadable() const {
  const bool isOfStdin = &stream_ == &std::cin && std::ferror(stdin) != 0;
  if (stream_.bad() || isOfStdin)
    throw Failure(ExitCode::kFailure, fmt::format("{}: cannot read: {}", name_, std::strerror(errno)));
}

void NumberRowReader::takeHeader(const std::string& line) {
  header_ = namesOf(line);
  if (!limit_.columns.empty()) return chooseColumns(header_);
  if (const std::string all = fmt::format("{}", fmt::join(header_, ","));
      !limit_.header.empty() && all != limit_.header)
    fail(1, fmt::format("the header is \"{}\", not \"{}\"", excerpt(all), limit_.header));
  if (header_.size() != columns_)
    fail(1, fmt::format("the header has {} columns where {} are needed", header_.size(), columns_));
}

void NumberRowReader::chooseColumns(const std::vector<std::string>& names) {
  const auto& wanted = limit_.columns;
  for (const std::string& name : names) {
    const auto place =
        static_cast<std::size_t>(std::find(wanted.begin(), wanted.end(), name) - wanted.begin());
    if (place == wanted.size()) otherNames_.push_back(name);
    places_.push_back(place);
  }
  requireNoMore();
  for (std::size_t place = 0; place < wanted.size(); ++place)
    if (const auto count = std::count(places_.begin(), places_.end(), place); count != 1)
      fail(1, fmt::format("the header has {} column {}: name them {} to {}, or leave the header out",
                          count == 0 ? "no" : "more than one", wanted[place], wanted.front(), wanted.back()));
}

/// Of the family of columns that are wanted there are no others: they would be another ring's.
void NumberRowReader::requireNoMore() const {
  if (limit_.family.empty()) return;
  std::vector<std::string> more;
  for (const std::string& name : otherNames_)
    if (name.starts_with(limit_.family) && name.size() > limit_.family.size() &&
        name.find_first_not_of("0123456789", limit_.family.size()) == std::string::npos)
      more.push_back(name);
  if (more.empty()) return;
  fail(1, fmt::format("the file has {}{}, {}", excerpt(more.front()),
                      more.size() > 1 ? fmt::format(" .. {}", excerpt(more.back())) : "", limit_.familyHint));
}

void NumberRowReader::parse(const std::string& line, std::vector<double>& row) {
  row.assign(columns_, 0);
  others_.clear();
  const std::size_t needed = columns_ + otherNames_.size();
  const auto fields = fieldsOf(line);
  if (!endOfField(fields.back(), 0)) fail(columnOf(fields.back(), line), "a quote is not closed");
  requireCommas(fields, line);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i == needed)
      fail(columnOf(fields[i], line),
           fmt::format("more than {} columns{}", needed, decimalCommaHint(fields)));
    const std::size_t place = places_.empty() ? i : places_[i];
    if (place == columns_)
      others_.push_back(textOf(fields[i]));
    else
      row[place] = numberOf(textOf(fields[i]), columnOf(fields[i], line));
  }
  if (fields.size() < needed)
    fail(line.size() + 1, fmt::format("{} columns where {} are needed", fields.size(), needed));
}

/// Before numbers are looked at: of decimal commas between semicolons, parts are numbers, too.
void NumberRowReader::requireCommas(const std::vector<std::string_view>& fields,
                                    const std::string& line) const {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!places_.empty() && i < places_.size() && places_[i] == columns_) continue;
    const std::string field = textOf(fields[i]);
    for (const auto& [separator, name] : kOtherSeparators)
      if (field.find(separator) != std::string::npos)
        fail(columnOf(fields[i], line),
             fmt::format("\"{}\" has {}: separate columns by commas", excerpt(field), name));
  }
}

double NumberRowReader::numberOf(const std::string& field, std::size_t column) const {
  if (field.empty() && limit_.mayBeEmpty) return std::numeric_limits<double>::quiet_NaN();
  const auto value = signedNumber(field);
  if (const auto point = value ? std::nullopt : withPoint(field))
    fail(column, fmt::format("\"{}\" has a comma: write {} with a point", excerpt(field), *point));
  if (!value) fail(column, fmt::format("\"{}\" is no number", excerpt(field)));
  if (!std::isfinite(*value)) fail(column, fmt::format("{} is no finite number", excerpt(field)));
  if (std::abs(*value) > limit_.most)
    fail(column, fmt::format("{} is beyond +-{}: {}", excerpt(field), limit_.most, limit_.hint));
  return *value;
}

std::string NumberRowReader::place() const { return fmt::format("{}:{}", name_, line_); }

void NumberRowReader::fail(std::size_t column, const std::string& what) const {
  throw Failure(ExitCode::kFailure,
                fmt::format("{}:{}: {}", place(), column, printable(what)));  // a NUL would end it
}

}  // namespace strainfinger
