#include "host/bench/error_sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/base/angles.hpp"
#include "host/base/table_writer.hpp"
#include "host/bench/fingers.hpp"

namespace strainfinger::bench {
namespace {

constexpr double kAnyDirection = std::numeric_limits<double>::quiet_NaN();
constexpr double kLight_n_per_m = 5, kFirm_n_per_m = 30;

/// The default finger's noise before its converter: what stays when the converter is another one.
double analogNoise_strain() { return simulation::analogNoise_strain(config::Gauges{}); }

void setElectronics(config::Gauges& gauges, int bits, double analog_strain) {
  gauges.adc_bits = bits;
  gauges.noise_strain = std::hypot(analog_strain, gauges.quantisation_strain());
}

class Sweeps {
 public:
  explicit Sweeps(const SweepSettings& settings) : settings_(settings) {}

  void map(double load_n_per_m) {
    constexpr int kOffsets = 40, kDirections = 30;
    Trial trial(perfectFinger(), perfectFinger(), settings_.seed);
    const double pitch_rad = 2 * std::numbers::pi / config::Gauges{}.count;
    for (int i = 0; i <= kOffsets; ++i) {
      for (int k = 0; k <= kDirections; ++k) {
        const double offset = static_cast<double>(i) / kOffsets - 0.5;
        const double direction_deg = (static_cast<double>(k) / kDirections - 0.5) * 90;
        const double direction_rad = direction_deg * kRadPerDeg;
        ErrorCell cell{kMapSweep, offset, "pitch", direction_deg, load_n_per_m, true, {}};
        trial.touch({offset * pitch_rad, load_n_per_m * std::cos(direction_rad),
                     load_n_per_m * std::sin(direction_rad)},
                    settings_.repeats, cell.statistics);
        cells_.push_back(std::move(cell));
      }
    }
  }
  void load() {
    for (const double load : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0})
      add(kLoadSweep, load, "N/m", load, perfectFinger(), perfectFinger());
  }
  void noise() {
    constexpr int kFineBits = 16;
    for (const double strain : {1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4})
      withElectronics(kNoiseSweep, strain * 1e6, "microstrain", kFineBits, strain);
  }
  void bits() {
    for (const int bits : {8, 9, 10, 11, 12, 14, 16})
      withElectronics(kBitsSweep, bits, "bits", bits, analogNoise_strain());
  }
  void width() {
    for (const double width_mm : {0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0}) {
      config::FingerConfig finger = perfectFinger();
      finger.contact.width_m = width_mm * 1e-3;
      toldAndNot(kWidthSweep, width_mm, finger);
    }
  }
  /// Some fingers, each touched as often; tables of the drawing, the default model error.
  void asBuilt() {
    for (const double width_mm : {0.0, 1.0, 2.0, 4.0}) {
      ErrorCell cell{kBuiltSweep, width_mm, "mm", kAnyDirection, kFirm_n_per_m, false, {}};
      for (int seed = 1; seed <= kBuiltFingers; ++seed) {
        config::FingerConfig finger = fingerAsBuilt(seed);
        finger.contact.width_m = width_mm * 1e-3;
        Trial(finger, {}, settings_.seed)
            .touchAnywhere(kFirm_n_per_m, (settings_.contacts + kBuiltFingers - 1) / kBuiltFingers,
                           cell.statistics);
      }
      cells_.push_back(std::move(cell));
    }
  }
  void length() {
    for (const double length_mm : {0.0, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0}) {
      config::FingerConfig finger = perfectFinger();
      finger.gauges.arc_length_m = length_mm * 1e-3;
      toldAndNot(kLengthSweep, length_mm, finger);
    }
  }
  std::vector<ErrorCell> take() { return std::move(cells_); }

 private:
  void withElectronics(const char* sweep, double setting, const char* unit, int bits, double analog_strain) {
    config::FingerConfig finger = perfectFinger();
    setElectronics(finger.gauges, bits, analog_strain);
    for (const double load : {kLight_n_per_m, kFirm_n_per_m}) add(sweep, setting, unit, load, finger, finger);
  }
  void toldAndNot(const char* sweep, double setting, const config::FingerConfig& finger) {
    add(sweep, setting, "mm", kFirm_n_per_m, finger, finger);
    add(sweep, setting, "mm", kFirm_n_per_m, finger, perfectFinger());
    cells_.back().told = false;
  }
  void add(const char* sweep, double setting, const char* unit, double load_n_per_m,
           const config::FingerConfig& actual, const config::FingerConfig& told) {
    ErrorCell cell{sweep, setting, unit, kAnyDirection, load_n_per_m, true, {}};
    Trial(actual, told, settings_.seed).touchAnywhere(load_n_per_m, settings_.contacts, cell.statistics);
    cells_.push_back(std::move(cell));
  }

  SweepSettings settings_;
  std::vector<ErrorCell> cells_;
};

}  // namespace

std::vector<ErrorCell> errorSweeps(const SweepSettings& settings) {
  Sweeps sweeps(settings);
  sweeps.map(kFirm_n_per_m);
  sweeps.load();
  sweeps.noise();
  sweeps.width();
  sweeps.asBuilt();
  sweeps.length();
  sweeps.bits();
  return sweeps.take();
}

void writeErrorCsv(std::FILE* stream, const std::vector<ErrorCell>& cells) {
  TableWriter table(stream, TableFormat::kCsv,
                    {"sweep", "setting", "unit", "direction_deg", "load_n_per_m", "told", "contacts",
                     "unnoticed", "uncertain", "wrong", "arc_rms_mm", "arc_95_mm", "arc_worst_mm",
                     "normal_rms_n_per_m", "normal_95_n_per_m", "normal_worst_n_per_m",
                     "tangential_rms_n_per_m", "tangential_95_n_per_m", "tangential_worst_n_per_m"});
  for (const ErrorCell& cell : cells) {
    const ErrorStatistics& s = cell.statistics;
    std::vector<Cell> row{cell.sweep,
                          cell.setting,
                          cell.unit,
                          cell.direction_deg,
                          cell.load_n_per_m,
                          std::int64_t{cell.told},
                          std::int64_t{s.contacts},
                          std::int64_t{s.unnoticed},
                          std::int64_t{s.uncertain},
                          std::int64_t{s.wrong}};
    for (const evidence::Errors* spread : {&s.arc_mm, &s.normal_n_per_m, &s.tangential_n_per_m})
      row.insert(row.end(), {spread->rms(), spread->quantile(0.95), spread->worst()});
    table.row(row);
  }
}

std::vector<ErrorCell> cellsOf(const std::vector<ErrorCell>& cells, const std::string& sweep) {
  std::vector<ErrorCell> chosen;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(chosen),
               [&](const ErrorCell& cell) { return cell.sweep == sweep; });
  return chosen;
}

}  // namespace strainfinger::bench
