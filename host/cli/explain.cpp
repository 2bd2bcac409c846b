#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/frames.hpp"
#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/text_parts.hpp"
#include "host/can/candump_text.hpp"
#include "host/can/field_text.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/glossary.hpp"
#include "host/can/remedies.hpp"
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
    "--json: a name is an object name,kind,meaning,remedy; a field of a frame one of "
    "frame,node,field,value,meaning,remedy, and each flag or choice in it another.\n"
    "Exit status 2: no such name or frame.";

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

/// What a text is as a line of candump, which may lack its time or its interface.
std::variant<can::LogLine, can::LogError> lineOf(const std::string& text) {
  auto whole = can::parseLogLine(text);
  if (std::holds_alternative<can::LogLine>(whole)) return whole;
  const bool isBare = text.find('#') != std::string::npos && text.find(' ') == std::string::npos;
  auto completed = can::parseLogLine((isBare ? "(0.000000) bus " : "bus ") + text);
  return isBare || std::holds_alternative<can::LogLine>(completed) ? completed : whole;
}

/// The words as one text: without quotes they come without the brackets of "[8]", which are the command line
/// library's.
std::vector<std::string> textsOf(const std::vector<std::string>& words) {
  std::vector<std::string> texts{std::string(trimmed(fmt::format("{}", fmt::join(words, " "))))};
  for (std::size_t i = 1; i < std::min<std::size_t>(words.size(), 4); ++i) {
    if (words[i].size() != 1) continue;
    std::vector<std::string> bracketed = words;
    bracketed[i] = fmt::format("[{}]", words[i]);
    texts.push_back(fmt::format("{}", fmt::join(bracketed, " ")));
  }
  return texts;
}

/// What the words together are, if they are a frame. Throws Failure(kUsage) where they look like one that is
/// none.
std::optional<can::LogLine> frameOf(const std::vector<std::string>& words) {
  for (const std::string& text : textsOf(words)) {
    const auto line = lineOf(text);
    const auto* const read = std::get_if<can::LogLine>(&line);
    if (read != nullptr && read->kind != can::LineKind::kNothing) return *read;
  }
  const std::string text = textsOf(words).front();
  const auto line = lineOf(text);
  const auto* const error = std::get_if<can::LogError>(&line);
  if (error != nullptr && text.find('#') != std::string::npos)
    throw Failure(ExitCode::kUsage,
                  fmt::format("explain: '{}' is no frame: {}", excerpt(text), error->reason));
  return std::nullopt;
}

/// What the value says by name: its flags, or its choice.
std::vector<can::Term> termsIn(const can::FieldValue& value) {
  const FieldMeaning& meaning = value.field->meaning;
  std::vector<can::Term> terms;
  if (meaning.kind == FieldKind::kNumber || !value.isKnown) return terms;
  for (const ValueName& name : meaning.names)
    if (meaning.kind == FieldKind::kFlags ? (value.raw >> name.value & 1) != 0 : value.raw == name.value)
      std::ranges::copy_if(can::termsNamed(name.name), std::back_inserter(terms), [&](const can::Term& term) {
        return term.meaning == name.comment;  // and not another value of that name
      });
  return terms;
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
    for (const can::Term& term : termsIn(value)) {
      fmt::print("        {}: {}\n", term.name, term.meaning);
      printRemedy(term, 8);
    }
  }
}

void printFrame(const can::FrameEntry& entry, const CanFrame& frame, TableFormat format) {
  if (format == TableFormat::kCsv) return printText(entry, frame);
  std::vector<std::string> columns{"frame", "node"};
  columns.insert(columns.end(), kFieldColumns.begin(), kFieldColumns.end());
  columns.emplace_back("remedy");
  TableWriter table(stdout, format, columns);
  const std::int64_t node = *nodeOf(frame.id, entry.spec.function);
  for (const can::FieldValue& value : can::fieldValues(entry, frame)) {
    std::vector<Cell> row{entry.spec.name, node};
    std::ranges::move(fieldRow(value), std::back_inserter(row));
    row.emplace_back("");
    table.row(row);
    for (const can::Term& term : termsIn(value))
      table.row({entry.spec.name, node, can::columnName(value.field->meaning), term.name, term.meaning,
                 term.remedy});
  }
}

/// What of the frames' table a frame with this identifier should be.
std::string whyNone(const CanFrame& frame) {
  for (const auto& catalogue : {can::frameCatalogue(), can::commandCatalogue()})
    for (const auto& [spec, fields] : catalogue) {
      if (!nodeOf(frame.id, spec.function)) continue;
      if (spec.function == FunctionCode::kRequest || spec.function == FunctionCode::kResponse)
        return fmt::format("no {} that there is (common/BUS_REQUESTS.md)", spec.name);
      return fmt::format("{} has {} bytes, not {}", spec.name, spec.length, frame.length);
    }
  return fmt::format("identifier 0x{:03X}; `strainfinger explain` lists those there are", frame.id);
}

/// Why a line is none of a finger's frames.
std::string whyNone(const can::LogLine& line) {
  if (line.kind == can::LineKind::kError) return "it is an error frame, a report of the CAN controller";
  if (line.kind == can::LineKind::kDropped) return "it says how many frames candump dropped";
  if (line.kind == can::LineKind::kRemote) return "it is a remote request";
  if (line.frame.fd) return "it is of CAN FD";
  if (line.frame.extended) return "its identifier has 29 bits";
  return whyNone(*can::classicFrame(line));
}

struct Explained {
  const can::FrameEntry* entry;
  CanFrame frame;
};

/// Throws Failure(kUsage) where it is none of a finger's.
Explained fingersFrame(const can::LogLine& line) {
  const auto frame = can::classicFrame(line);
  const can::FrameEntry* const entry = frame ? can::findAnyFrame(*frame) : nullptr;
  if (entry == nullptr)
    throw Failure(ExitCode::kUsage, fmt::format("explain: none of a finger's frames: {}", whyNone(line)));
  return {entry, *frame};
}

void warnOfProtocol(const Explained& explained) {
  if (explained.entry->spec.function != FunctionCode::kHeartbeat) return;
  const auto heartbeat = decode<HeartbeatFrame>(explained.frame);
  if (heartbeat && heartbeat->protocol != kProtocolVersion)
    warn("explain", fmt::format("it {}; its other fields may mean something else",
                                can::foreignText(heartbeat->protocol)));
}

[[noreturn]] void refuse(const std::string& word) {
  const std::vector<std::string> like = can::namesLike(word);
  throw Failure(
      ExitCode::kUsage,
      fmt::format("explain: '{}' is no name on the bus{}; `strainfinger explain` lists them", excerpt(word),
                  like.empty() ? "" : fmt::format(" (did you mean {}?)", fmt::join(like, ", "))));
}

/// Names, however they are joined: "contact+uncertain", "noisy,".
std::vector<std::string> namesIn(const std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (const std::string& word : words) {
    const std::size_t before = names.size();
    std::string name;
    for (const char c : word + "+") {
      const bool isEnd = c == '+' || c == ',' || c == ':' || c == ';';
      if (!isEnd) name.push_back(c);
      if (isEnd && !name.empty()) names.push_back(std::exchange(name, ""));
    }
    if (names.size() == before) names.push_back(word);
  }
  return names;
}

/// The words are a name each, or all together one: "stale zero".
std::vector<can::Term> termsOf(const std::vector<std::string>& words) {
  std::vector<can::Term> terms = can::termsNamed(fmt::format("{}", fmt::join(words, " ")));
  if (!terms.empty()) return terms;
  for (const std::string& name : namesIn(words)) {
    const std::vector<can::Term> named = can::termsNamed(name);
    if (named.empty()) refuse(name);
    terms.insert(terms.end(), named.begin(), named.end());
  }
  return terms;
}

/// The frames that the words are: one, which may be a whole line, or one a word; none: they are names. Throws
/// as frameOf() and fingersFrame() do.
std::vector<Explained> framesOf(const std::vector<std::string>& words) {
  const auto hasFrame = [](const std::string& word) { return word.find('#') != std::string::npos; };
  std::vector<Explained> frames;
  if (words.size() > 1 && std::ranges::all_of(words, hasFrame)) {
    for (const std::string& word : words)
      if (const auto line = frameOf({word})) frames.push_back(fingersFrame(*line));
  } else if (const auto line = frameOf(words)) {
    frames.push_back(fingersFrame(*line));
  }
  return frames;
}

void runExplain(const ExplainOptions& options) {
  options.common.requireGoodConfig();
  const TableFormat format = options.common.format();
  if (options.words.empty()) return printTerms(can::glossary(), format);
  const std::vector<Explained> frames = framesOf(options.words);
  for (const Explained& explained : frames) {
    warnOfProtocol(explained);
    printFrame(*explained.entry, explained.frame, format);
  }
  if (frames.empty()) printTerms(termsOf(options.words), format);
}

}  // namespace

void addExplain(CLI::App& app) { addCommand<ExplainOptions>(app, "explain", kExplainHelp, runExplain); }

}  // namespace strainfinger::cli
