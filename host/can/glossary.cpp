#include "host/can/glossary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>

#include "common/commands.hpp"
#include "host/base/edit_distance.hpp"
#include "host/can/field_text.hpp"
#include "host/can/frame_catalogue.hpp"
#include "host/can/remedies.hpp"

namespace strainfinger::can {
namespace {

constexpr std::size_t kMostLike = 3, kMostLettersOff = 3;

/// What to do about a value of one of the lists of names; "" for lists without remedies.
std::string_view remedyOf(const ValueName* names, std::uint8_t value) {
  if (names == kFingerFaultNames.data()) return remedyFor(FingerFault{value});
  if (names == kFingerFlagNames.data()) return remedyFor(FingerFlag{value});
  if (names == kFingerStateNames.data()) return remedyFor(FingerState{value});
  if (names == kResetCauseNames.data()) return remedyFor(ResetCause{value});
  if (names == kCrashNames.data()) return remedyFor(Crash{value});
  if (names == kCommandStatusNames.data()) return remedyFor(CommandStatus{value});
  return "";
}

std::string sentWhen(const FrameSpec& spec) {
  if (spec.function == FunctionCode::kRequest) return "to the finger";
  if (spec.onChange) return fmt::format("on change, in contact every {} ms at least", spec.period_ms);
  return spec.period_ms == 0 ? "on request" : fmt::format("every {} ms", spec.period_ms);
}

/// Terms of the same name and meaning, in several frames, are one.
class Glossary {
 public:
  Glossary() {
    for (const auto& catalogue : {frameCatalogue(), commandCatalogue()})
      for (const FrameEntry& entry : catalogue) addFrame(entry);
    for (const ValueName& count : kCountNames)
      note(values_,
           {count.name, fmt::format("value {} of count's argument", count.value), count.comment,
            std::string(remedyFor(Count{count.value}))},
           kLayout<RequestFrame>.spec.name);
  }

  std::vector<Term> terms() const {
    std::vector<Term> all = frames_;
    for (const auto& list : {fields_, values_})
      for (const Found& found : list) {
        all.push_back(found.term);
        all.back().kind += fmt::format(" in {}", fmt::join(found.frames, ", "));
      }
    return all;
  }

 private:
  struct Found {
    Term term;
    std::vector<std::string> frames;
  };

  void addFrame(const FrameEntry& entry) {
    const FrameSpec& spec = entry.spec;
    frames_.push_back(
        {spec.name,
         fmt::format("frame 0x{:03X} + node, {}", static_cast<int>(spec.function), sentWhen(spec)),
         spec.comment,
         {}});
    for (const FieldSpec& field : entry.fields) {
      if (!isShown(field)) continue;
      const FieldMeaning& meaning = field.meaning;
      const std::string unit = *meaning.unit == '\0' ? "" : fmt::format(" [{}]", meaning.unit);
      note(fields_, {columnName(meaning), "field" + unit, meaning.comment, {}, meaning.name}, spec.name);
      for (const ValueName& name : meaning.names)
        note(values_,
             {name.name,
              fmt::format("{} {} of {}", meaning.kind == FieldKind::kFlags ? "bit" : "value", name.value,
                          meaning.name),
              name.comment, std::string(remedyOf(meaning.names.data(), name.value))},
             spec.name);
    }
  }

  static void note(std::vector<Found>& list, Term term, const char* frame) {
    const auto same = std::ranges::find_if(list, [&](const Found& found) {
      return found.term.name == term.name && found.term.kind == term.kind &&
             found.term.meaning == term.meaning;
    });
    if (same == list.end())
      list.push_back({std::move(term), {frame}});
    else if (same->frames.back() != frame)
      same->frames.emplace_back(frame);
  }

  std::vector<Term> frames_;
  std::vector<Found> fields_, values_;
};

/// As names on the bus are written, but for their case.
std::string normal(std::string_view word) {
  std::string text(word);
  std::ranges::transform(text, text.begin(), [](unsigned char c) {
    return c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(c));
  });
  return text;
}

}  // namespace

std::span<const Term> glossary() {
  static const std::vector<Term> kTerms = Glossary().terms();
  return kTerms;
}

std::vector<Term> termsNamed(std::string_view word) {
  std::vector<Term> found;
  std::ranges::copy_if(glossary(), std::back_inserter(found), [&](const Term& term) {
    return normal(term.name) == normal(word) || (!term.alias.empty() && term.alias == normal(word));
  });
  return found;
}

std::vector<std::string> namesLike(std::string_view word) {
  std::multimap<std::size_t, std::string> byDistance;
  for (const Term& term : glossary()) {
    const std::size_t off = editDistance(normal(word), normal(term.name));
    if (off <= std::min(kMostLettersOff, word.size() / 2)) byDistance.emplace(off, term.name);
  }
  std::vector<std::string> names;
  for (const auto& [off, name] : byDistance)
    if (names.size() < kMostLike && std::ranges::find(names, name) == names.end()) names.push_back(name);
  return names;
}

}  // namespace strainfinger::can
