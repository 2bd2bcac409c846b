#include "host/bench/matrix/matrix_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <tuple>

#include "host/base/table_writer.hpp"
#include "host/bench/cells.hpp"

namespace strainfinger::bench {
namespace {

constexpr std::string_view kMatrixIntroduction = R"(# What disturbs the finger

Touches of a default finger, one disturbance a row, through the firmware's own pipeline from the converter's codes on.
The table has the worst rows, sorted by `silent`, then by `beyond 6 sigma`; all rows are in [disturbances.csv](disturbances.csv). Unless a row says otherwise: line contacts of 2 to 40 N/m, anywhere, pushed within 45 degrees of the
normal, on a finger exactly as drawn; tables without model error, the width unknown. A finger is switched on, left alone
for 0.3 s, and touched six times for 120 sample sets (light touches for 400, contacts that move for 300 or 600, two
contacts for 600 and more, so that searches end), 40 apart (touches of 5 s: a second apart); a gauge that fails does so
all the time, and touches are within two pitches of it. Answers count in the last sample set of a touch.

| column | of all touches, how many end with |
|--|--|
| silent | a contact reported more than half a pitch (2.5 mm on the default finger) from every true one, and no flag |
| beyond 6 sigma | place or a load off by more than six reported standard errors, and no flag |
| flagged | a flag: uncertain, or more contacts than the one that is reported |
| blamed | a healthy gauge out of use |
| missed | nothing reported |
| located | every contact reported within half a pitch, no other contact, no flag (may also be beyond 6 sigma) |
| ghosts | a contact reported in the untouched time before the touch (`run` counts these as `phantom`) |

"As built": gauges glued 0.5 degrees and 0.05 mm off, gains off by 3 % (standard deviations), the core 0.1 mm thicker,
Poisson's ratio 0.49; another finger for every six touches. "Calibrated": its own core, ratio, and each gauge's angle, depth and gain
are known exactly, and the model error is 0.05 %. "Other fingers" are perfect, and touched by contacts 0 to 2 mm wide. Loads that "tremble" swing about their mean as a sine; those of
contacts that "tap" swing to nothing and to twice the mean; contacts that "slide" go along the surface: all are judged by what they
are in the last sample set, in which a tap may press little.

A share that rests on few touches is uncertain: 1 of 1,500 stands for 0.002 to 0.37 %, 3 of 375 for 0.17 to 2.3 %
(Clopper-Pearson, 95 % confidence). With another seed such rows may change their order.

)";

constexpr std::size_t kRowsShown = 40;

double part(int count, const Tally& tally) { return static_cast<double>(count) / std::max(tally.touches, 1); }

auto badness(const Tally& tally) {
  return std::tuple(part(tally.silent, tally), part(tally.beyond, tally), part(tally.blamed, tally),
                    part(tally.ghosts, tally), part(tally.missed, tally), part(tally.flagged, tally));
}

std::string rowText(const MatrixRow& row) {
  const Tally& tally = row.tally;
  std::string text = "| " + row.name + " |";
  for (const int count :
       {tally.silent, tally.beyond, tally.flagged, tally.blamed, tally.missed, tally.located, tally.ghosts})
    text.append(" ").append(share(count, tally.touches)).append(" |");
  return text + fmt::format(" {} |\n", tally.touches);
}

}  // namespace

std::string matrixPage(std::vector<MatrixRow> rows, int touches, std::uint64_t seed) {
  std::stable_sort(rows.begin(), rows.end(), [](const MatrixRow& a, const MatrixRow& b) {
    return badness(a.tally) > badness(b.tally);
  });
  std::string text(kMatrixIntroduction);
  text +=
      "| disturbance | silent | beyond 6 sigma | flagged | blamed | missed | located | ghosts | touches |\n"
      "|--|--|--|--|--|--|--|--|--|\n";
  const std::size_t shown = std::min(kRowsShown, rows.size());
  for (std::size_t row = 0; row < shown; ++row) text += rowText(rows[row]);
  return text + fmt::format(
                    "\n{} of {} rows; {} touches a row, fewer where they take seconds; seed {}. Made by "
                    "`cmake --workflow --preset bench`.\n",
                    shown, rows.size(), touches, seed);
}

void writeMatrixCsv(std::FILE* stream, const std::vector<MatrixRow>& rows) {
  TableWriter table(stream, TableFormat::kCsv,
                    {"disturbance", "touches", "silent", "beyond_6_sigma", "flagged", "blamed", "missed",
                     "located", "ghosts"});
  for (const auto& [name, tally] : rows)
    table.row({name, std::int64_t{tally.touches}, std::int64_t{tally.silent}, std::int64_t{tally.beyond},
               std::int64_t{tally.flagged}, std::int64_t{tally.blamed}, std::int64_t{tally.missed},
               std::int64_t{tally.located}, std::int64_t{tally.ghosts}});
}

}  // namespace strainfinger::bench
