#include "tests/stability/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "host/plot/style.hpp"

namespace strainfinger::stability {
namespace {

constexpr const char* kRowNames = "trr,trt,ttt,ur,ut,err,ett,ert";

std::string nameOf(const Range& range) {
  return range.from == range.to ? fmt::format("{:g}", range.from)
                                : fmt::format("{:g} to {:g}", range.from, range.to);
}

std::string nameOfPoissonRatio(const Range& range) {
  return range.from == range.to ? "1/2" : range.from >= 0.49 ? "just below 1/2" : nameOf(range);
}

/// A table with named rows and columns in the order in which they came; cells keep the largest value.
class LargestTable {
 public:
  void take(const std::string& row, const std::string& column, double value) {
    double& cell = cells_[{indexOf(rows_, row), indexOf(columns_, column)}];
    if (!std::isnan(cell) && !(value <= cell)) cell = value;  // what is no number is the largest
  }

  /// The cell says so if it has no value.
  void refuse(const std::string& row, const std::string& column) {
    refused_.insert({indexOf(rows_, row), indexOf(columns_, column)});
  }

  std::string markdown(const std::string& corner) const {
    std::string text = fmt::format("| {} | {} |\n|--|", corner, fmt::join(columns_, " | "));
    for (std::size_t i = 0; i < columns_.size(); ++i) text += "--|";
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      text += fmt::format("\n| {} |", rows_[i]);
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        const auto cell = cells_.find({i, k});
        text += cell != cells_.end()        ? fmt::format(" {:.1e} |", cell->second)
                : refused_.contains({i, k}) ? " refused |"
                                            : " |";
      }
    }
    return text + "\n";
  }

  plot::DataFile data(const std::string& name) const {
    plot::DataFile file{name, {"column", "row", "log10_error"}, {}};
    for (const auto& [place, value] : cells_)
      file.rows.push_back({static_cast<double>(place.second), static_cast<double>(place.first),
                           std::log10(std::max(value, 1e-17))});
    return file;
  }

  /// For gnuplot: the names of both axes' tics.
  std::string tics() const {
    const auto list = [](const std::vector<std::string>& names) {
      std::string text;
      for (std::size_t i = 0; i < names.size(); ++i)
        text += fmt::format("{}'{}' {}", i == 0 ? "" : ", ", names[i], i);
      return text;
    };
    return fmt::format("set xtics ({}) rotate by -30; set ytics ({})\n", list(columns_), list(rows_));
  }

 private:
  static std::size_t indexOf(std::vector<std::string>& names, const std::string& name) {
    const auto index = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    if (index == names.size()) names.push_back(name);
    return index;
  }
  std::vector<std::string> rows_, columns_;
  std::map<std::pair<std::size_t, std::size_t>, double> cells_;
  std::set<std::pair<std::size_t, std::size_t>> refused_;
};

const char* nameOf(contact::Regime regime) {
  constexpr std::array kRegimes{"frictionless", "sliding", "stick"};
  return kRegimes[static_cast<std::size_t>(regime)];
}

LargestTable byHarmonic(const std::vector<HarmonicRegion>& regions) {
  LargestTable table;
  for (const auto& region : regions)
    table.take(nameOf(region.alpha), nameOf(region.n), region.worst.largest());
  return table;
}

LargestTable byPlace(const std::vector<HarmonicRegion>& regions) {
  LargestTable table;
  for (const auto& region : regions)
    table.take(nameOfPoissonRatio(region.poissonRatio), kPlaceNames[static_cast<std::size_t>(region.place)],
               region.worst.largest());
  return table;
}

LargestTable byDepth(const std::vector<FieldRegion>& regions) {
  LargestTable table;
  for (const auto& region : regions) {
    const std::string alpha = fmt::format("{:g}", region.alpha),
                      depth = fmt::format("{:g}", region.depthOfRubber);
    if (region.isRefused)
      table.refuse(alpha, depth);
    else
      table.take(alpha, depth, region.worst.largest());
  }
  return table;
}

LargestTable byWidth(const std::vector<FieldRegion>& regions) {
  LargestTable table;
  for (const auto& region : regions)
    if (!region.isRefused)  // for its depth, whatever the width
      table.take(fmt::format("{:g}", region.alpha), fmt::format("{:.3g}", region.width_rad),
                 region.worst.largest());
  return table;
}

LargestTable byContact(const std::vector<ContactRegion>& regions, bool isWarnedOf) {
  LargestTable table;
  for (const auto& region : regions) {
    const std::string alpha = fmt::format("{:g}", region.alpha),
                      width = fmt::format("{:.3g}", region.width_rad);
    if (region.isRefused)
      table.refuse(alpha, width);
    else if (region.isWarnedOf == isWarnedOf)
      table.take(alpha, width, region.misfit);
  }
  return table;
}

/// By Poisson's ratio and indenter, where 100 digits have nothing to say.
LargestTable byIndenter(const std::vector<ContactRegion>& regions, bool isWarnedOf) {
  LargestTable table;
  for (const auto& region : regions)
    if (!region.isRefused && region.isWarnedOf == isWarnedOf)
      table.take(fmt::format("{:g}", region.poissonRatio),
                 fmt::format("{}, {}", region.indenter, nameOf(region.regime)), region.misfit);
  return table;
}

std::string errors(const Worst& worst) {
  std::string text = fmt::format("{},{}", worst.samples, worst.notFinite);
  for (const double error : worst.error) text += fmt::format(",{:.3g}", error);
  return text;
}

}  // namespace

std::string harmonicTable(const std::vector<HarmonicRegion>& regions) {
  std::string text = fmt::format(
      "alpha_from,alpha_to,n_from,n_to,poisson_ratio_from,poisson_ratio_to,place,underflowing,samples,not_"
      "finite,{}\n",
      kRowNames);
  for (const auto& [alpha, n, nu, place, worst] : regions)
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", alpha.from, alpha.to, n.from, n.to, nu.from, nu.to,
                        kPlaceNames[static_cast<std::size_t>(place)], worst.underflowing, errors(worst));
  return text;
}

std::string fieldTable(const std::vector<FieldRegion>& regions) {
  std::string text =
      fmt::format("alpha,poisson_ratio,width_rad,depth_of_rubber,refused,samples,not_finite,{}\n", kRowNames);
  for (const FieldRegion& region : regions)
    text += fmt::format("{},{},{},{},{:d},{}\n", region.alpha, region.poissonRatio, region.width_rad,
                        region.depthOfRubber, region.isRefused, errors(region.worst));
  return text;
}

std::string contactTable(const std::vector<ContactRegion>& regions) {
  std::string text = "alpha,poisson_ratio,width_rad,indenter,regime,residual_per_depth,warned_of,refused\n";
  for (const ContactRegion& region : regions)
    text += fmt::format("{},{},{},{},{},{:.3g},{:d},{:d}\n", region.alpha, region.poissonRatio,
                        region.width_rad, region.indenter, nameOf(region.regime), region.misfit,
                        region.isWarnedOf, region.isRefused);
  return text;
}

bool holds(const std::vector<ContactRegion>& regions) {
  for (const ContactRegion& region : regions)
    if (!(region.misfit <= kContactBar) && (std::isnan(region.misfit) || !region.isWarnedOf)) return false;
  return !regions.empty();
}

std::string summary(const Surveys& surveys) {
  return fmt::format(
      "Harmonics, relative to the larger of a row's two coefficients (tau_tt passes through zero with "
      "both: relative to tau_rr's, if larger); below 1e-290 they only have to be as "
      "small:\n\n{}\n{}\nFields under line loads (width 0) and uniform loads of some width, relative to "
      "the peak of the row (depth 0: the surface, where a line load has no field and is refused; 1: the "
      "core; refused: the series needs more than a million harmonics, and computeField() says so). Of "
      "depths that take more than 10,000 harmonics two widths and four angles are looked at (the others "
      "are blank where all depths do), of more than 100,000 nu = 1/2 only:\n\n{}\n{}\nContacts (flat, a "
      "cylinder of 5 mm, a wedge of 160 degrees; all regimes; nu = 0, 0.3, 0.499999, 1/2; at alpha 0.999 "
      "beyond 0.01 rad flat, frictionless and nu = 1/2 only), residual over depth, recomputed from the "
      "tractions: answers without a warning, then those that warn (stick below nu = 1/2, layers far "
      "thinner than the contact is wide; refused: no answer but an error; blank: none):\n\n{}\n{}\n{}\n{}",
      byHarmonic(surveys.harmonics).markdown("alpha \\ harmonic"),
      byPlace(surveys.harmonics).markdown("Poisson's ratio \\ place"),
      byDepth(surveys.fields).markdown("alpha \\ depth / rubber"),
      byWidth(surveys.fields).markdown("alpha \\ width, rad"),
      byContact(surveys.contacts, false).markdown("alpha \\ width, rad"),
      byContact(surveys.contacts, true).markdown("warned of: alpha \\ width, rad"),
      byIndenter(surveys.contacts, false).markdown("nu \\ indenter, regime"),
      byIndenter(surveys.contacts, true).markdown("warned of: nu \\ indenter, regime"));
}

int countNotFinite(const Surveys& surveys) {
  int count = 0;
  for (const HarmonicRegion& region : surveys.harmonics) count += region.worst.notFinite;
  for (const FieldRegion& region : surveys.fields) count += region.worst.notFinite;
  for (const ContactRegion& region : surveys.contacts) count += std::isfinite(region.misfit) ? 0 : 1;
  return count;
}

plot::Picture heatMaps(const Surveys& surveys) {
  struct Panel {
    const char *name, *title, *x, *y;
    LargestTable table;
  };
  const std::array panels{
      Panel{"harmonics", "harmonics", "harmonic n", "α", byHarmonic(surveys.harmonics)},
      Panel{"places", "harmonics", "radius", "Poisson's ratio", byPlace(surveys.harmonics)},
      Panel{"contacts", "contacts that warn of nothing", "width (rad)", "α",
            byContact(surveys.contacts, false)},
      Panel{"depths", "fields", "depth / rubber", "α", byDepth(surveys.fields)},
      Panel{"widths", "fields", "width of the load (rad)", "α", byWidth(surveys.fields)},
      Panel{"warned", "contacts that warn", "width (rad)", "α", byContact(surveys.contacts, true)}};
  std::string script = plot::kStyle;
  script +=
      R"(set multiplot layout 2,3 margins 0.08,0.99,0.1,0.92 spacing 0.08,0.22 title 'log_{10} of the worst error'
unset grid; unset key; set tics scale 0
set palette defined (-17 '#f7fbff', -16 '#deebf7', -15 '#9ecae1', -14 '#6baed6', -13 '#fff5eb', -8 '#fdbe85', 0 '#e6550d')
set cbrange [-17:0]; unset colorbox; set offsets 0.5,0.5,0.5,0.5
)";
  plot::Picture picture{1700, 1000, {}, {}};
  for (const Panel& panel : panels) {
    script += panel.table.tics();
    script +=
        fmt::format("set title '{}'; set xlabel '{}'; set ylabel \"{}\"\n", panel.title, panel.x, panel.y);
    script += fmt::format(
        "plot data('{0}') using 1:2:(0.48):(0.48):3 every ::1 with boxxyerror fillstyle solid noborder "
        "palette, '' using 1:2:(sprintf('%.1f', $3)) every ::1 with labels font ',9'\n",
        panel.name);
    picture.data.push_back(panel.table.data(panel.name));
  }
  picture.script = script + "unset multiplot\n";
  return picture;
}

}  // namespace strainfinger::stability
