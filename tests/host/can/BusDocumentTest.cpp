// common/BUS.md and the pages it names are written by people; what can be computed in them is computed here
// again.

#include <CppUTest/TestHarness.h>
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <span>
#include <sstream>
#include <string>

#include "common/commands.hpp"
#include "common/frames.hpp"
#include "common/raw_share.hpp"
#include "host/can/candump_text.hpp"
#include "host/can/frame_catalogue.hpp"

using namespace strainfinger;
using namespace strainfinger::can;

namespace {

std::string readPage(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(STRAINFINGER_BUS_PAGES + name).rdbuf();
  CHECK_FALSE_TEXT(text.str().empty(), name.c_str());
  return text.str();
}

/// BUS.md and the pages beside it that it leads to.
std::string readPages() {
  static const std::regex kLink(R"(\]\((BUS_[A-Z_]+\.md)\) \|)");
  const std::string first = readPage("BUS.md");
  std::string all = first;
  for (std::sregex_iterator link(first.begin(), first.end(), kLink), end; link != end; ++link)
    all += readPage((*link)[1]);
  return all;
}

std::string place(const FieldBits& bits) {
  const int byte = bits.lsb / 8;
  if (bits.width == 8) return fmt::format("{}", byte);
  if (bits.width % 8 == 0) return fmt::format("{}-{}", byte, byte + bits.width / 8 - 1);
  return fmt::format("{}, bits {}-{}", byte, bits.lsb % 8, bits.lsb % 8 + bits.width - 1);
}

std::string values(const FieldSpec& field) {
  std::string text;
  const bool flags = field.meaning.kind == FieldKind::kFlags;
  for (const ValueName& name : field.meaning.names)
    fmt::format_to(std::back_inserter(text), "{}{} {}", text.empty() ? (flags ? "bit " : "") : ", ",
                   name.value, name.name);
  if (text.empty()) text = fmt::format("{}..{}", minRaw(field.bits), maxRaw(field.bits));
  if (field.meaning.openEnded) text += field.bits.isSigned ? " or beyond" : " or more";
  return text;
}

/// The row of a field in the table of its frame.
std::string row(const FieldSpec& field) {
  const auto& [bits, meaning] = field;
  return fmt::format("| {} | {} | {}{} | {} {} | {} | {} | {} |\n", place(bits), meaning.name,
                     bits.isSigned ? 'i' : 'u', bits.width, stepOf(meaning), meaning.unit, values(field),
                     bits.unknowable ? fmt::format("{}", invalidRaw(bits)) : "", meaning.comment);
}

std::string tableOf(const FrameEntry& entry) {
  std::string table =
      "| byte | field | type | step | raw values | not known | meaning |\n|--|--|--|--|--|--|--|\n";
  for (const FieldSpec& field : entry.fields) table += row(field);
  return table;
}

std::string tableOf(std::span<const ValueName> names) {
  std::string table = "| bit | name | meaning |\n|--|--|--|\n";
  for (const ValueName& name : names)
    fmt::format_to(std::back_inserter(table), "| {} | {} | {} |\n", name.value, name.name, name.comment);
  return table;
}

/// Bits of a classic frame with an 11-bit identifier on the wire, interframe space included. Of the 34 + 8 n
/// bits from start of frame to checksum every fifth can be followed by a stuff bit, and each stuff bit counts
/// for the next five: (34 + 8 n - 1) / 4 of them at worst (Davis, Burns, Bril, Lukkien: Controller Area
/// Network (CAN) schedulability analysis, Real-Time Systems 35, 2007).
constexpr int kBytes = 8;
constexpr int kBitsUnstuffed = 47 + 8 * kBytes;
constexpr int kBitsWorst = kBitsUnstuffed + (34 + 8 * kBytes - 1) / 4;

/// FORCE and PATCH with each CONTACT; CONTACT2 and FORCE2 while there is a second contact.
std::string loadRow(int fingers, int contacts, double contactRate_hz) {
  const int framesOfTouch = 1 + 2 * contacts;
  const double aliveRate_hz =
      1000.0 / kHeartbeatPeriod_ms + 1000.0 / kInfoPeriod_ms + 1000.0 / kGaugesPeriod_ms;
  const double frames = fingers * (framesOfTouch * contactRate_hz + aliveRate_hz);
  return fmt::format("| {} | {} | {} | {} | {:.1f} % | {:.1f} % |\n", fingers, contacts, contactRate_hz,
                     frames, frames * kBitsUnstuffed / 1e6 * 100, frames * kBitsWorst / 1e6 * 100);
}

/// The pages of each set, and of the zeros once a second.
std::string rawRow(int gauges, int rate_hz) {
  const double frames = (gauges + 2) / 3 * (rate_hz + 1);
  return fmt::format("| {} | {} | {} | {:.1f} % | {:.1f} % |\n", gauges, rate_hz, frames,
                     frames * kBitsUnstuffed / 1e6 * 100, frames * kBitsWorst / 1e6 * 100);
}

}  // namespace

TEST_GROUP(BusDocument) {
  std::string pages_;

  void setup() override { pages_ = readPages(); }
  void checkHas(const std::string& text) { STRCMP_CONTAINS(text.c_str(), pages_.c_str()); }
};

TEST(BusDocument, HasTheTableOfEachFrame) {
  for (const auto catalogue : {frameCatalogue(), commandCatalogue()})
    for (const FrameEntry& entry : catalogue) {
      checkHas(
          fmt::format("## {}: 0x{:03X} + node\n", entry.spec.name, static_cast<int>(entry.spec.function)));
      checkHas(tableOf(entry));
    }
}

TEST(BusDocument, ExplainsTheFlags) {
  checkHas(tableOf(kFingerFlagNames));
  checkHas(tableOf(kFingerFaultNames));
  checkHas(fmt::format("| value{}", tableOf(kCrashNames).substr(5)));
  checkHas(fmt::format("| value{}", tableOf(kRawKindNames).substr(5)));
}

TEST(BusDocument, ExplainsTheCommands) {
  std::string table = "| value | command | argument | meaning |\n|--|--|--|--|\n";
  for (const ArgumentSpec& spec : kArguments) {
    const ValueName* name = findName(kCommandNames, static_cast<int>(spec.command));
    table += fmt::format(
        "| {} | {} | {}..{}, {} bytes | {} |\n", name->value, name->name, spec.least, spec.most,
        spec.leastBytes == spec.mostBytes ? fmt::format("{}", spec.mostBytes)
                                          : fmt::format("{} or {}", spec.leastBytes, spec.mostBytes),
        name->comment);
  }
  checkHas(table);
  checkHas(fmt::format("| value{}", tableOf(kCommandStatusNames).substr(5)));
  checkHas(fmt::format("| value{}", tableOf(kCountNames).substr(5)));
  checkHas(fmt::format("within {} ms", kAnswerWithin_ms));
}

TEST(BusDocument, ItsExamplesAreWhatIsSent) {
  const FingerFlags flags{FingerFlag::kContact, FingerFlag::kSimulated};
  const auto line = [](const auto& frame) {
    return formatLogLine(1609779922655421, "can0", encode(frame, 5));
  };
  checkHas(line(ContactFrame{1000, 290, kNotKnown<std::int8_t>, flags, 97, 163}));
  checkHas(line(ForceFrame{290, -226, 7, 9, flags, 163}));
  checkHas(line(PatchFrame{2040, 150, 17, 2, flags, 163}));
  checkHas(line(Contact2Frame{{19'980, 310, kNotKnown<std::int8_t>, flags, 95, 163}}));
  checkHas(line(Force2Frame{{410, 35, 9, 9, flags, 163}}));
  checkHas(line(HeartbeatFrame{.state = FingerState::kRun,
                               .uptime_s = 3661,
                               .temperature_degC = 25,
                               .tx_error_steps = 0,
                               .rx_error_steps = 0,
                               .table_crc = 0xA7}));
  checkHas(line(InfoFrame{.reset_cause = ResetCause::kWatchdog,
                          .crash = Crash::kHang,
                          .restarts = 3,
                          .version_major = 0,
                          .version_minor = 1,
                          .crash_address = 0x2AB6,
                          .board = 0x5C}));
  checkHas(line(GaugesFrame{.out_of_use = 1u << 5, .zero_age_s = 61, .zero_rate_nano_per_s = 510}));
  checkHas(line(RawFrame{2, RawKind::kReadings, 42, 32752, 33072, 32352}));
  checkHas(line(contactRateRequest(200)));
  checkHas(line(responseTo(Command::kContactRate, CommandStatus::kDone)));
  checkHas(line(tareRequest(true)));
  checkHas(line(responseTo(Command::kTare, CommandStatus::kTouched)));
  checkHas(line(responseTo(Command::kKeep, CommandStatus::kWait, 45)));
  checkHas(line(wordRequest(4711, 0x11223344)));
  checkHas(line(responseTo(Command::kWord, CommandStatus::kDone, 4712)));
}

TEST(BusDocument, ItsBusLoadsAreComputed) {
  checkHas(fmt::format("{} bits", kBitsUnstuffed));
  checkHas(fmt::format("{} bits", kBitsWorst));
  for (const int fingers : {1, 5}) checkHas(loadRow(fingers, 1, 500));
  checkHas(loadRow(1, 2, 500));
  checkHas(loadRow(5, 2, 250));
  checkHas(loadRow(5, 1, 20));
  for (const int rate_hz : {10, 100, 1000}) checkHas(rawRow(16, rate_hz));
  checkHas(rawRow(32, fastestRaw_hz(32, 1'000'000)));
  checkHas(fmt::format("RAW may take {} %", kRawShare_percent));
  LONGS_EQUAL(kBitsUnstuffed, kFrameBits);
}

TEST(BusDocument, NamesTheProtocolVersion) {
  checkHas(fmt::format("Protocol version: {}\n", kProtocolVersion));
}
