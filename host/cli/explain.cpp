#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/can/candump_text.hpp"
#include "host/can/field_text.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/glossary.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/field_row.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kExplainHelp =
    "What a name or a frame on the bus means, and what to do about it.\n"
    "  explain                       every name: frames, fields, flags, faults, states, commands\n"
    "  explain uncertain             a name, in any case\n"
    "  explain 181#E2270200808164FF  a frame, or a whole line of candump, field by field\n"
    "With --json a name is an object name,kind,meaning,remedy, a field of a frame one "
    "frame,node,field,value,meaning. Exit status 2: no such name or frame.";

struct ExplainOptions {
  explicit ExplainOptions(CLI::App& command) : common(command) {
    command.add_option("WORD", words, "A name, or a frame as candump writes it; more than one name too");
  }
  CommonOptions common;
  std::vector<std::string> words;
};

void printRemedy(const can::Term& term, int indent) {
  if (!term.remedy.empty()) fmt::print("{:{}}What to do: {}\n", "", indent, term.remedy);
}

void printTerms(std::span<const can::Term> terms, TableFormat format) {
  if (format == TableFormat::kJson) {
    TableWriter table(stdout, format, {"name", "kind", "meaning", "remedy"});
    for (const can::Term& term : terms) table.row({term.name, term.kind, term.meaning, term.remedy});
    return;
  }
  for (const can::Term& term : terms) {
    fmt::print("{}: {}\n    {}\n", term.name, term.kind, term.meaning);
    printRemedy(term, 4);
  }
}

/// "181#E227" has neither a time nor an interface, which a line of a log has.
std::string asLogLine(const std::string& text) {
  const bool isBare = text.find('#') != std::string::npos && text.find(' ') == std::string::npos;
  return isBare ? "(0.000000) bus " + text : text;
}

/// What the words together are, if they are a frame.
std::optional<can::LogLine> frameOf(const std::vector<std::string>& words) {
  const auto line = can::parseLogLine(asLogLine(fmt::format("{}", fmt::join(words, " "))));
  const auto* const read = std::get_if<can::LogLine>(&line);
  if (read == nullptr || read->kind == can::LineKind::kNothing) return std::nullopt;
  return *read;
}

void printNames(const can::FieldValue& value) {
  const FieldMeaning& meaning = value.field->meaning;
  if (meaning.kind == FieldKind::kNumber || !value.isKnown) return;
  for (const ValueName& name : meaning.names)
    if (meaning.kind == FieldKind::kFlags ? (value.raw >> name.value & 1) != 0 : value.raw == name.value)
      for (const can::Term& term : can::termsNamed(name.name)) {
        if (term.meaning != name.comment) continue;  // another value of that name
        fmt::print("        {}: {}\n", term.name, term.meaning);
        printRemedy(term, 8);
      }
}

void printText(const can::FrameEntry& entry, const CanFrame& frame) {
  fmt::print("{} of node {} (0x{:03X}): {}\n", entry.spec.name, *nodeOf(frame.id, entry.spec.function),
             frame.id, entry.spec.comment);
  const std::vector<can::FieldValue> values = can::fieldValues(entry, frame);
  std::size_t nameWidth = 0, textWidth = 0;
  for (const can::FieldValue& value : values) {
    nameWidth = std::max(nameWidth, can::columnName(value.field->meaning).size());
    textWidth = std::max(textWidth, can::textOf(value).size());
  }
  for (const can::FieldValue& value : values) {
    const FieldMeaning& meaning = value.field->meaning;
    fmt::print("    {:{}}  {:{}}  {}\n", can::columnName(meaning), nameWidth, can::textOf(value), textWidth,
               meaning.comment);
    printNames(value);
  }
}

void printFrame(const can::FrameEntry& entry, const CanFrame& frame, TableFormat format) {
  if (format == TableFormat::kCsv) return printText(entry, frame);
  std::vector<std::string> columns{"frame", "node"};
  columns.insert(columns.end(), kFieldColumns.begin(), kFieldColumns.end());
  TableWriter table(stdout, format, columns);
  for (const can::FieldValue& value : can::fieldValues(entry, frame)) {
    std::vector<Cell> row{entry.spec.name, std::int64_t{*nodeOf(frame.id, entry.spec.function)}};
    std::ranges::move(fieldRow(value), std::back_inserter(row));
    table.row(row);
  }
}

void explainFrame(const can::LogLine& line, TableFormat format) {
  const auto frame = can::classicFrame(line);
  const can::FrameEntry* const entry = frame ? can::findAnyFrame(*frame) : nullptr;
  if (entry != nullptr) return printFrame(*entry, *frame, format);
  const can::FrameEntry* const meant = frame ? can::findFunction(frame->id) : nullptr;
  const std::string why = meant != nullptr
                              ? fmt::format("{} has {} bytes", meant->spec.name, meant->spec.length)
                              : "`strainfinger explain` lists the frames of fingers";
  throw Failure(ExitCode::kUsage,
                fmt::format("explain: none of a finger's frames: identifier 0x{:03X}, {} bytes: {}",
                            line.frame.id, line.frame.length, why));
}

[[noreturn]] void refuse(const std::string& word) {
  const std::vector<std::string> like = can::namesLike(word);
  throw Failure(ExitCode::kUsage,
                fmt::format("explain: {} is no name on the bus{}; `strainfinger explain` lists them", word,
                            like.empty() ? "" : fmt::format(" (did you mean {}?)", fmt::join(like, ", "))));
}

/// The words are a name each, or all together one: "stale zero".
std::vector<can::Term> termsOf(const std::vector<std::string>& words) {
  std::vector<can::Term> terms = can::termsNamed(fmt::format("{}", fmt::join(words, " ")));
  if (!terms.empty()) return terms;
  for (const std::string& word : words) {
    const std::vector<can::Term> named = can::termsNamed(word);
    if (named.empty()) refuse(word);
    terms.insert(terms.end(), named.begin(), named.end());
  }
  return terms;
}

void runExplain(const ExplainOptions& options) {
  const TableFormat format = options.common.format();
  if (options.words.empty()) return printTerms(can::glossary(), format);
  if (const auto line = frameOf(options.words)) return explainFrame(*line, format);
  printTerms(termsOf(options.words), format);
}

}  // namespace

void addExplain(CLI::App& app) { addCommand<ExplainOptions>(app, "explain", kExplainHelp, runExplain); }

}  // namespace strainfinger::cli
