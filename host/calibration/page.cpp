#include "host/calibration/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "host/calibration/expected_error.hpp"
#include "host/calibration/findings.hpp"
#include "host/calibration/result_pictures.hpp"
#include "host/calibration/row_use.hpp"

namespace strainfinger::calibration {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html xmlns="http://www.w3.org/1999/xhtml" lang="en">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width"/>
<title>Calibration of a finger</title>
<style>
body { font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 64rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; }
table { border-collapse: collapse; } .wide { overflow-x: auto; }
th, td { text-align: right; padding: .15rem .6rem; border-bottom: 1px solid #ddd; font-variant-numeric: tabular-nums; white-space: nowrap; }
th { white-space: normal; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; } td.words { text-align: left; white-space: normal; }
figure { margin: 1rem 0; } figcaption { color: #555; } svg { width: 100%; height: auto; }
</style>
</head>
<body>
)";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c;
    }
  return result;
}

/// A number as people read it, in a unit of theirs; and as it is.
std::string number(const char* column, double value, const std::string& shown) {
  return fmt::format(R"(<data class="{}" value="{:.17g}">{}</data>)", column, value, shown);
}

/// A value and its sigma, rounded to what the sigma leaves of it.
std::string estimated(const char* column, const Estimate& estimate, double scale) {
  const double sigma = scale * estimate.sigma;
  const int digits = sigma > 0 ? std::max(0, 1 - static_cast<int>(std::floor(std::log10(sigma)))) : 6;
  return number(column, estimate.value, fmt::format("{:.{}f}", scale * estimate.value, digits)) + " ± " +
         number(fmt::format("sigma_{}", column).c_str(), estimate.sigma,
                fmt::format("{:.{}f}", sigma, digits));
}

std::string row(std::initializer_list<std::string> cells) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += "<td>" + cell + "</td>";
  return text + "</tr>\n";
}

std::string table(const char* id, std::initializer_list<const char*> heads, const std::string& rows) {
  std::string text = fmt::format("<div class=\"wide\"><table id=\"{}\">\n<tr>", id);
  for (const char* const head : heads) text += fmt::format("<th>{}</th>", head);
  return text + "</tr>\n" + rows + "</table></div>\n";
}

std::string heading(const char* text) { return fmt::format("<h2>{}</h2>\n", text); }

std::string figure(const plot::Picture& picture, const char* name, const char* caption) {
  std::string svg = svgElement(picture, name);
  svg.insert(4, fmt::format(R"( role="img" aria-label="{}")", caption));
  return fmt::format("<figure id=\"{}\">{}<figcaption>{}</figcaption></figure>\n", name, svg, caption);
}

std::string sourceParagraph(const CalibrationResult& result, const ResultSource& source) {
  const auto named = [](const std::string& path, const char* otherwise) {
    return path.empty() ? std::string(otherwise) : escaped(path);
  };
  return fmt::format("<p id=\"source\">Config: {}. Rows: {}. Known touches: {}. Calibrated {}.</p>\n",
                     named(result.drawing().config().source, "the default finger"),
                     named(source.strainsPath, "stdin"), named(source.touchesPath, "none"),
                     escaped(source.time));
}

std::string worthSection(const CalibrationResult& result) {
  const ExpectedErrors errors = expectedErrors(result);
  const auto line = [](const char* name, const char* when, const Eigen::Vector3d& error) {
    const auto cell = [&](const char* column, const char* unit, double value, double scale) {
      return number(fmt::format("{}_{}_{}", column, when, unit).c_str(), value,
                    fmt::format("{:.4f}", scale * value));
    };
    return row({name, cell("arc", "m", error[0], 1e3), cell("normal", "n_per_m", error[1], 1),
                cell("tangential", "n_per_m", error[2], 1)});
  };
  return heading("Errors to expect") +
         fmt::format("<p>Of {}, all around the ring (RMS).</p>\n", judgedTouchesText()) +
         table("errors", {"", "place, mm", "normal, N/m", "tangential, N/m"},
               line("before, as drawn", "before", errors.before) +
                   line("after, as found", "after", errors.after) +
                   line("by the noise alone", "bound", errors.bound));
}

std::string rubberSection(const CalibrationResult& result) {
  const config::Finger& drawn = result.drawing().config().finger;
  return heading("The rubber") +
         table("rubber", {"", "drawn", "found"},
               row({"core radius, mm", fmt::format("{:.4f}", 1e3 * drawn.core_radius_m),
                    estimated("core_radius_m", result.coreRadius_m(), 1e3)}) +
                   row({"Poisson's ratio", fmt::format("{:.5f}", drawn.poisson_ratio),
                        estimated("poisson_ratio", result.poissonRatio(), 1)}) +
                   row({"shear modulus, kPa", fmt::format("{:.2f}", 1e-3 * drawn.shear_modulus_pa),
                        estimated("shear_modulus_pa", result.shearModulus_pa(), 1e-3)}) +
                   row({"model error, % of a touch's largest reading", "",
                        estimated("model_error", result.modelError(), 100)}));
}

std::string gaugeSection(const CalibrationResult& result, const Residuals& residuals) {
  std::string rows;
  for (int i = 0; i < result.drawing().gauges(); ++i) {
    const Residuals::Of& left = residuals.gauges[static_cast<std::size_t>(i)];
    rows +=
        row({fmt::format("{}", i), estimated("gain", result.gain(i), 1),
             estimated("zero_strain", result.zero_strain(i), 1e6),
             estimated("angle_offset_deg", result.angleOffset_deg(i), 1),
             estimated("depth_offset_m", result.depthOffset_m(i), 1e6),
             fmt::format("{:.1f}", 1e6 * left.before_strain),
             number("residual_strain", left.after_strain, fmt::format("{:.2f}", 1e6 * left.after_strain))});
  }
  const std::string turn = turnText(result);
  return heading("The gauges") + (turn.empty() ? "" : "<p id=\"turn\">" + escaped(turn) + "</p>\n") +
         figure(ringPicture(result), "ring", "Each gauge as found, beside what the drawing allows.") +
         table("gauges",
               {"gauge", "gain", "zero, microstrain", "angle off, deg", "too deep, um",
                "left over before, microstrain", "after, microstrain"},
               rows);
}

std::string togetherSection(const CalibrationResult& result) {
  std::string rows;
  for (const Correlation& each : correlationsWorthKnowing(result))
    rows += row({escaped(each.one), escaped(each.other),
                 number("correlation", each.value, fmt::format("{:.3f}", each.value))});
  if (rows.empty()) return "";
  return heading("Correlated") +
         "<p>The touches determine these only in combination: each alone is less certain than its effect on "
         "a touch.</p>\n" +
         table("correlations", {"", "with", "correlation"}, rows);
}

std::string rowsSection(const CalibrationResult& result) {
  std::string rows;
  for (const LeftOut& left : rowsLeftOut(result)) {
    std::string numbers;
    for (const std::size_t each : left.rows)
      numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", each);
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"words\">{}</td></tr>\n", escaped(left.reason),
                        number(fmt::format("left-out {}", nameOf(left.use)).c_str(),
                               static_cast<double>(left.rows.size()), fmt::format("{}", left.rows.size())),
                        numbers);
  }
  const auto counted = [&](const char* column, RowUse use) {
    return number(column, result.count(use), fmt::format("{}", result.count(use)));
  };
  const std::string sum =
      fmt::format("<p>{} rows: {} fitted, {} untouched.</p>\n", result.rows().size(),
                  counted("fitted", RowUse::kFitted), counted("untouched", RowUse::kUntouched));
  const std::string moved = movedZeroText(result);
  return heading("Rows left out") + sum + (moved.empty() ? "" : "<p id=\"moved-zero\">" + moved + "</p>\n") +
         (rows.empty() ? "" : table("left-out", {"reason", "rows", "which"}, rows));
}

std::string farOffSection(const CalibrationResult& result) {
  std::string items;
  for (const std::string& sentence : whatIsFarOff(result))
    items += fmt::format("<li>{}</li>\n", escaped(sentence));
  return items.empty() ? "" : heading("Far off the drawing") + "<ul id=\"far-off\">\n" + items + "</ul>\n";
}

std::string untoldSection(const CalibrationResult& result) {
  std::string items;
  for (const std::string& sentence : whatIsUntold(result))
    items += fmt::format("<li>{}</li>\n", escaped(sentence));
  return heading("Not determined") + (items.empty() ? "<p id=\"untold\">Nothing: the touches determine every "
                                                      "gauge, and a direction and a load are known.</p>\n"
                                                    : "<ul id=\"untold\">\n" + items + "</ul>\n");
}

}  // namespace

std::string htmlPage(const CalibrationResult& result, const ResultSource& source) {
  const Residuals residuals = residualsOf(result);
  return kHead + std::string("<h1>A finger as it was built</h1>\n") + sourceParagraph(result, source) +
         worthSection(result) + farOffSection(result) + untoldSection(result) +
         gaugeSection(result, residuals) + rubberSection(result) + togetherSection(result) +
         heading("The touches") +
         figure(coveragePicture(result), "coverage", "Where the finger was touched, and how hard.") +
         figure(residualPicture(result, residuals), "residuals",
                "What is left over of the readings, by gauge and by row, before and after.") +
         rowsSection(result) + "</body>\n</html>\n";
}

}  // namespace strainfinger::calibration
