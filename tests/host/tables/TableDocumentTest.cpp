// common/TABLES.md is written by people; offsets, types and bytes in it are compared with the code here.

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "common/table_image.hpp"
#include "host/tables/table_builder.hpp"
#include "host/tables/table_file.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

template <typename Number>
struct TypeName {
  static std::string text() {
    if constexpr (std::is_enum_v<Number>) return TypeName<std::underlying_type_t<Number>>::text();
    return fmt::format("{}{}",
                       std::is_floating_point_v<Number> ? 'f'
                       : std::is_signed_v<Number>       ? 'i'
                                                        : 'u',
                       8 * sizeof(Number));
  }
};
template <>
struct TypeName<ScanSpan> : TypeName<std::uint8_t> {};
template <typename Number, std::size_t Count>
struct TypeName<std::array<Number, Count>> {
  static std::string text() { return fmt::format("{}[{}]", TypeName<Number>::text(), Count); }
};
template <std::size_t Count>
struct TypeName<std::array<FoldedWeights, Count>> : TypeName<std::array<std::int16_t, 8 * Count>> {};
template <std::size_t Count>
struct TypeName<std::array<StartWeights, Count>> : TypeName<std::array<std::int16_t, 4 * Count>> {};
template <typename Number, std::size_t Inner, std::size_t Count>
struct TypeName<std::array<std::array<Number, Inner>, Count>> : TypeName<std::array<Number, Inner * Count>> {
};

/// The fields of a part in order, as rows of its table: their offsets follow from their types, because there
/// is no padding.
class Rows {
 public:
  explicit Rows(std::size_t begin) : offset_(begin) {}
  template <typename Field>
  void add(const char* name, const Field&) {
    rows_.push_back(fmt::format("| {} | {} | {} |", offset_, name, TypeName<Field>::text()));
    offset_ += sizeof(Field);
  }
  const std::vector<std::string>& rows() const { return rows_; }
  std::size_t end() const { return offset_; }

 private:
  std::size_t offset_;
  std::vector<std::string> rows_;
};

Rows headerRows(const TableImage& image) {
  Rows rows(0);
  rows.add("magic", image.magic);
  rows.add("format", image.format);
  rows.add("reserved", image.reserved);
  rows.add("image_bytes", image.image_bytes);
  rows.add("crc32", image.crc32);
  return rows;
}

Rows parameterRows(const TableParameters& p) {
  Rows rows(offsetof(TableImage, parameters));
  rows.add("core_radius_m", p.core_radius_m);
  rows.add("outer_radius_m", p.outer_radius_m);
  rows.add("length_m", p.length_m);
  rows.add("shear_modulus_pa", p.shear_modulus_pa);
  rows.add("poisson_ratio", p.poisson_ratio);
  rows.add("gauge_radius_m", p.gauge_radius_m);
  rows.add("first_angle_deg", p.first_angle_deg);
  rows.add("arc_length_m", p.arc_length_m);
  rows.add("noise_strain", p.noise_strain);
  rows.add("full_scale_strain", p.full_scale_strain);
  rows.add("contact_width_m", p.contact_width_m);
  rows.add("friction_coefficient", p.friction_coefficient);
  rows.add("gauge_count", p.gauge_count);
  rows.add("component", p.component);
  rows.add("adc_bits", p.adc_bits);
  rows.add("reserved", p.reserved);
  return rows;
}

Rows constantRows(const TableConstants& c) {
  Rows rows(offsetof(TableImage, constants));
  rows.add("pitch_turn_q35", c.pitch_turn_q35);
  rows.add("first_angle_q32", c.first_angle_q32);
  rows.add("noise_variance", c.noise_variance);
  rows.add("gate_on", c.gate_on);
  rows.add("gate_off", c.gate_off);
  rows.add("load_scale", c.load_scale);
  rows.add("reading_gain", c.reading_gain);
  rows.add("force_per_load_q16", c.force_per_load_q16);
  rows.add("load_exponent", c.load_exponent);
  rows.add("friction_cone_q8", c.friction_cone_q8);
  rows.add("adc_rail", c.adc_rail);
  rows.add("tail_q16", c.tail_q16);
  rows.add("noise_variance_exponent", c.noise_variance_exponent);
  rows.add("amplitude_exponent", c.amplitude_exponent);
  rows.add("mirror_sign", c.mirror_sign);
  rows.add("anchor_sign", c.anchor_sign);
  rows.add("gauge_count", c.gauge_count);
  rows.add("gate_shift", c.gate_shift);
  rows.add("anchor_rule", c.anchor_rule);
  rows.add("scan_step", c.scan_step);
  rows.add("scan_span", c.scan_span);
  rows.add("near_pole_q15", c.near_pole_q15);
  rows.add("firm_exponent", c.firm_exponent);
  rows.add("reserved", c.reserved);
  return rows;
}

Rows startRows(const TableImage& image) {
  Rows rows(offsetof(TableImage, start));
  rows.add("start", image.start);
  return rows;
}

Rows fitRows(const FitRow& row) {
  Rows rows(0);
  rows.add("basis", row.basis);
  rows.add("gradient", row.gradient);
  rows.add("gradient_length", row.gradient_length);
  rows.add("gradient_cosine", row.gradient_cosine);
  rows.add("gradient_exponent", row.gradient_exponent);
  rows.add("reserved", row.reserved);
  rows.add("load", row.load);
  rows.add("triple", row.triple);
  rows.add("load_slope", row.load_slope);
  return rows;
}

Rows nearRows(const NearRow& row) {
  Rows rows(0);
  rows.add("normal", row.normal);
  rows.add("normal_load", row.normal_load);
  rows.add("tangential_load", row.tangential_load);
  return rows;
}

Rows gainRows(const GaugeGains& gains) {
  Rows rows(offsetof(TableImage, gains));
  rows.add("correction", gains.correction);
  rows.add("exponent", gains.exponent);
  rows.add("reserved", gains.reserved);
  return rows;
}

std::string readDocument() {
  std::ostringstream text;
  text << std::ifstream(STRAINFINGER_TABLE_DOCUMENT).rdbuf();
  return text.str();
}

/// A line of a hex dump: 16 bytes, in two groups.
std::string dumpLine(const std::string& bytes, std::size_t offset) {
  std::string line = fmt::format("    {:08x} ", offset);
  for (std::size_t i = 0; i < 16; ++i)
    line += fmt::format("{} {:02x}", i == 8 ? " " : "", static_cast<unsigned char>(bytes[offset + i]));
  return line + "\n";
}

}  // namespace

TEST_GROUP(TableDocument) {
  const std::string document_ = readDocument();
  const TableImage image_ = tables::buildTableImage({});

  void checkHas(const std::string& text) { STRCMP_CONTAINS(text.c_str(), document_.c_str()); }

  /// The section has a row for each field, in order, and no others.
  void checkTable(const std::string& heading, const Rows& rows) {
    const std::size_t begin = document_.find(heading + "\n");
    CHECK_TEXT(begin != std::string::npos, heading.c_str());
    std::istringstream section(document_.substr(begin + 2, document_.find("\n## ", begin) - begin - 2));
    std::vector<std::string> found;
    for (std::string line; std::getline(section, line);)
      if (line.starts_with("| ") && line.find("| field |") == std::string::npos) found.push_back(line);
    LONGS_EQUAL(rows.rows().size(), found.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      STRCMP_EQUAL(rows.rows()[i].c_str(), found[i].substr(0, rows.rows()[i].size()).c_str());
  }
  void checkPart(std::size_t offset, std::size_t bytes) {
    checkHas(fmt::format("\n| {} | {} | ", offset, bytes));
  }
};

TEST(TableDocument, HasEveryFieldAtItsOffset) {
  checkTable("## Header", headerRows(image_));
  checkTable("## Parameters", parameterRows(image_.parameters));
  checkTable("## Constants", constantRows(image_.constants));
  checkTable("## Start", startRows(image_));
  checkTable("## Rows", fitRows(image_.rows[0]));
  checkTable("## Near rows", nearRows(image_.near[0]));
  checkTable("## Gains", gainRows(image_.gains));
}

TEST(TableDocument, ItsFieldsLeaveNoGaps) {
  LONGS_EQUAL(kTableHeaderBytes, headerRows(image_).end());
  LONGS_EQUAL(offsetof(TableImage, constants), parameterRows(image_.parameters).end());
  LONGS_EQUAL(offsetof(TableImage, start), constantRows(image_.constants).end());
  LONGS_EQUAL(offsetof(TableImage, rows), startRows(image_).end());
  LONGS_EQUAL(sizeof(FitRow), fitRows(image_.rows[0]).end());
  LONGS_EQUAL(sizeof(NearRow), nearRows(image_.near[0]).end());
  LONGS_EQUAL(sizeof(TableImage), gainRows(image_.gains).end());
}

TEST(TableDocument, OffsetsThatDependOnAlignmentAreThoseOfTheCompiler) {
  LONGS_EQUAL(112, offsetof(TableImage, parameters) + offsetof(TableParameters, gauge_count));
  LONGS_EQUAL(152, offsetof(TableImage, constants) + offsetof(TableConstants, load_exponent));
  LONGS_EQUAL(160, offsetof(TableImage, constants) + offsetof(TableConstants, noise_variance_exponent));
  LONGS_EQUAL(72, offsetof(FitRow, load));
  LONGS_EQUAL(80, offsetof(FitRow, load_slope));
}

TEST(TableDocument, HasThePartsAtTheirOffsets) {
  checkPart(0, kTableHeaderBytes);
  checkPart(offsetof(TableImage, parameters), sizeof(TableParameters));
  checkPart(offsetof(TableImage, constants), sizeof(TableConstants));
  checkPart(offsetof(TableImage, start), sizeof(TableImage::start));
  checkPart(offsetof(TableImage, rows), sizeof(FitTable));
  checkPart(offsetof(TableImage, near), sizeof(NearTable));
  checkPart(offsetof(TableImage, gains), sizeof(GaugeGains));
  checkHas(fmt::format("{} weights of {} bytes", kShares, sizeof(StartWeights)));
  checkHas(fmt::format("{} of {} bytes", kFitRows, sizeof(FitRow)));
  checkHas(fmt::format("{} of {} bytes", kNearRows, sizeof(NearRow)));
}

TEST(TableDocument, NamesFormatMagicAndLength) {
  checkHas(fmt::format("\nFormat: {}\n", kTableFormat));
  checkHas(fmt::format("0x{:X}: \"SFTB\"", kTableMagic));
  checkHas(fmt::format("| image_bytes | u32 | {} |", sizeof(TableImage)));
}

TEST(TableDocument, ItsExampleIsTheDefaultFinger) {
  const std::string bytes = tables::imageBytes(image_);
  checkHas(dumpLine(bytes, 0) + dumpLine(bytes, 16));
  const std::size_t constants = offsetof(TableImage, constants);
  checkHas(
      dumpLine(bytes, constants) + dumpLine(bytes, constants + 16) + dumpLine(bytes, constants + 32) +
      dumpLine(bytes, constants + 48) +
      dumpLine(bytes, constants + 64).substr(0, std::string("    00000000  00 00 00 00 00 00 00 00").size()));
  checkHas(fmt::format("CRC-32 {:08X}\n", image_.crc32));
  checkHas(fmt::format("{} * 2^{}: (6e-6", image_.constants.noise_variance,
                       image_.constants.noise_variance_exponent));
  checkHas(
      fmt::format("opens at {}, closes below {}\n", image_.constants.gate_on, image_.constants.gate_off));
  checkHas(fmt::format("load {} * 2^{} *", image_.constants.load_scale, image_.constants.load_exponent));
  checkHas(fmt::format("reading gain {}: 0.03", image_.constants.reading_gain));
}
