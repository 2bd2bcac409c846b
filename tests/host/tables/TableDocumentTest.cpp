// common/TABLES.md, TABLES_PATCHES.md and TABLES_EXAMPLE.md are written by people; offsets, types and bytes
// in them are compared with the code here.

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
template <typename Number, std::size_t Count>
struct TypeName<std::array<Number, Count>> {
  static std::string text() { return fmt::format("{}[{}]", TypeName<Number>::text(), Count); }
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
  rows.add("model_error", p.model_error);
  rows.add("place_error_m", p.place_error_m);
  rows.add("load_error", p.load_error);
  rows.add("moment_error_m2", p.moment_error_m2);
  rows.add("contact_width_m", p.contact_width_m);
  rows.add("largest_width_m", p.largest_width_m);
  rows.add("friction_coefficient", p.friction_coefficient);
  rows.add("gauge_count", p.gauge_count);
  rows.add("component", p.component);
  rows.add("adc_bits", p.adc_bits);
  rows.add("reserved", p.reserved);
  return rows;
}

Rows constantRows(const TableConstants& c) {
  Rows rows(offsetof(TableImage, constants));
  rows.add("noise_variance", c.noise_variance);
  rows.add("gate_on", c.gate_on);
  rows.add("gate_off", c.gate_off);
  rows.add("load_scale", c.load_scale);
  rows.add("reading_gain", c.reading_gain);
  rows.add("force_per_load_q16", c.force_per_load_q16);
  rows.add("reach_q32", c.reach_q32);
  rows.add("largest_moment_um2", c.largest_moment_um2);
  rows.add("known_moment_q20", c.known_moment_q20);
  rows.add("place_error_q32", c.place_error_q32);
  rows.add("load_exponent", c.load_exponent);
  rows.add("friction_q8", c.friction_q8);
  rows.add("cone_q8", c.cone_q8);
  rows.add("model_error_q16", c.model_error_q16);
  rows.add("load_scale_error_q16", c.load_scale_error_q16);
  rows.add("load_error_q16", c.load_error_q16);
  rows.add("moment_error_q16", c.moment_error_q16);
  rows.add("adc_rail", c.adc_rail);
  rows.add("node_count", c.node_count);
  rows.add("noise_variance_exponent", c.noise_variance_exponent);
  rows.add("mirror_sign", c.mirror_sign);
  rows.add("peak_sign", c.peak_sign);
  rows.add("gauge_count", c.gauge_count);
  rows.add("cell_count", c.cell_count);
  rows.add("width_is_known", c.width_is_known);
  rows.add("gate_shift", c.gate_shift);
  rows.add("spacing", c.spacing);
  rows.add("cell_edge_q15", c.cell_edge_q15);
  rows.add("cell_rate_q8", c.cell_rate_q8);
  rows.add("reserved2", c.reserved2);
  return rows;
}

Rows angleRows(const TableImage& image) {
  Rows rows(offsetof(TableImage, gauge_angle_q32));
  rows.add("gauge_angle_q32", image.gauge_angle_q32);
  return rows;
}

Rows patchRows(const PatchPair& pair) {
  Rows rows(0);
  rows.add("normal", pair.normal);
  rows.add("tangential", pair.tangential);
  return rows;
}

Rows gainRows(const GaugeGains& gains) {
  Rows rows(offsetof(TableImage, gains));
  rows.add("correction_q14", gains.correction_q14);
  rows.add("are_known", gains.are_known);
  rows.add("reserved", gains.reserved);
  return rows;
}

Rows depthRows(const GaugeDepths& depths) {
  Rows rows(offsetof(TableImage, depths));
  rows.add("steps", depths.steps);
  rows.add("normal_turn_q11", depths.normal_turn_q11);
  rows.add("tangential_turn_q11", depths.tangential_turn_q11);
  rows.add("tangential_q15", depths.tangential_q15);
  rows.add("step_nm", depths.step_nm);
  rows.add("normal_shape", depths.normal_shape);
  rows.add("tangential_shape", depths.tangential_shape);
  rows.add("shape_shift", depths.shape_shift);
  rows.add("reserved", depths.reserved);
  return rows;
}

std::string readDocument(const char* path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
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
  const std::string document_ = readDocument(STRAINFINGER_TABLE_DOCUMENT);
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
  checkTable("## Angles", angleRows(image_));
  checkTable("## Gains", gainRows(image_.gains));
  checkTable("## Depths", depthRows(image_.depths));
}

TEST(TableDocument, APatchHasEveryFieldAtItsOffset) {
  const Rows rows = patchRows(image_.patches[0]);
  const std::string patches = readDocument(STRAINFINGER_TABLE_PATCHES);
  for (const std::string& row : rows.rows()) STRCMP_CONTAINS(("\n" + row).c_str(), patches.c_str());
  LONGS_EQUAL(sizeof(PatchPair), rows.end());
}

TEST(TableDocument, ItsFieldsLeaveNoGaps) {
  LONGS_EQUAL(kTableHeaderBytes, headerRows(image_).end());
  LONGS_EQUAL(offsetof(TableImage, constants), parameterRows(image_.parameters).end());
  LONGS_EQUAL(offsetof(TableImage, gauge_angle_q32), constantRows(image_.constants).end());
  LONGS_EQUAL(offsetof(TableImage, gains), angleRows(image_).end());
  LONGS_EQUAL(offsetof(TableImage, depths), gainRows(image_.gains).end());
  LONGS_EQUAL(offsetof(TableImage, patches), depthRows(image_.depths).end());
}

TEST(TableDocument, OffsetsThatDependOnAlignmentAreThoseOfTheCompiler) {
  LONGS_EQUAL(152, offsetof(TableImage, parameters) + offsetof(TableParameters, gauge_count));
  LONGS_EQUAL(200, offsetof(TableImage, constants) + offsetof(TableConstants, load_exponent));
  LONGS_EQUAL(218, offsetof(TableImage, constants) + offsetof(TableConstants, noise_variance_exponent));
  LONGS_EQUAL(226, offsetof(TableImage, constants) + offsetof(TableConstants, cell_edge_q15));
}

TEST(TableDocument, HasThePartsAtTheirOffsets) {
  checkPart(0, kTableHeaderBytes);
  checkPart(offsetof(TableImage, parameters), sizeof(TableParameters));
  checkPart(offsetof(TableImage, constants), sizeof(TableConstants));
  checkPart(offsetof(TableImage, gauge_angle_q32), sizeof(GaugeAngles));
  checkPart(offsetof(TableImage, gains), sizeof(GaugeGains));
  checkPart(offsetof(TableImage, depths), sizeof(GaugeDepths));
  checkPart(offsetof(TableImage, patches), sizeof(TableImage::patches));
  checkHas(fmt::format("up to {} pairs of {} bytes", kMostPatches, sizeof(PatchPair)));
}

TEST(TableDocument, NamesFormatMagicAndLength) {
  checkHas(fmt::format("\nFormat: {}\n", kTableFormat));
  checkHas(fmt::format("0x{:X}: \"SFTB\"", kTableMagic));
  checkHas(fmt::format("| image_bytes | u32 | {} |", sizeof(TableImage)));
}

TEST(TableDocument, ItsExampleIsTheDefaultFinger) {
  const std::string example = readDocument(STRAINFINGER_TABLE_EXAMPLE);
  const auto checkExampleHas = [&](const std::string& text) {
    STRCMP_CONTAINS(text.c_str(), example.c_str());
  };
  const std::string bytes = tables::imageBytes(image_);
  checkExampleHas(dumpLine(bytes, 0) + dumpLine(bytes, 16));
  const std::size_t constants = offsetof(TableImage, constants);
  std::string dump;
  for (std::size_t line = 0; line < sizeof(TableConstants); line += 16)
    dump += dumpLine(bytes, constants + line);
  checkExampleHas(dump);
  checkExampleHas(dumpLine(bytes, offsetof(TableImage, patches)));
  checkExampleHas(fmt::format("CRC-32 {:08X}\n", image_.crc32));
  checkExampleHas(fmt::format("{} * 2^{}: (6e-6", image_.constants.noise_variance,
                              image_.constants.noise_variance_exponent));
  checkExampleHas(
      fmt::format("opens at {}, closes below {}\n", image_.constants.gate_on, image_.constants.gate_off));
  checkExampleHas(
      fmt::format("load {} * 2^{} *", image_.constants.load_scale, image_.constants.load_exponent));
  checkExampleHas(fmt::format("reading gain {}: 0.03", image_.constants.reading_gain));
}
