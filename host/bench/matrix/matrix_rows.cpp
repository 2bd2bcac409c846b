#include "host/bench/matrix/matrix_rows.hpp"

#include <fmt/format.h>

namespace strainfinger::bench {
namespace {

constexpr double kMicro = 1e-6;

class Rows {
 public:
  Disturbance& add(std::string name) {
    rows_.push_back({});
    rows_.back().name = std::move(name);
    return rows_.back();
  }

  void widths() {
    for (const model::Profile profile : model::allProfiles())
      for (const double width_mm : {1, 2, 3, 4, 6, 8}) {
        Disturbance& row = add(fmt::format("{:g} mm wide, {}", width_mm, nameOf(profile)));
        row.touches.width_m = {width_mm * 1e-3, width_mm * 1e-3};
        row.touches.profile = profile;
      }
  }

  /// The answer may be narrower, and elsewhere.
  void widerThanTables() {
    for (const double width_mm : {9, 10, 11}) {
      Disturbance& row =
          add(fmt::format("{:g} mm wide, uniform, wider than the tables, model error 5 %", width_mm));
      row.touches.width_m = {width_mm * 1e-3, width_mm * 1e-3};
      row.touches.profile = model::Profile::kUniform;
      row.told = {};
    }
  }

  void pairs() {
    for (const double apart : {0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0})
      for (const double ratio : {1.0, 0.5, 0.25}) pair(apart, ratio, 5, 0);
    for (const int rise : {20, 100, 500})
      for (const double apart : {1.0, 2.5, 4.0}) pair(apart, 0.5, rise, 0);
    for (const double apart : {0.5, 1.0, 2.5, 4.0})
      for (const double ratio : {1.0, 0.25}) {
        for (const int rise : {5, 100}) {
          pair(apart, ratio, rise, kJoins_sets);
          if (ratio != 1) pair(apart, ratio, rise, -kJoins_sets);
        }
      }
    Disturbance& wide = pair(4, 0.5, 5, 0);
    wide.name += ", both 2 mm wide";
    wide.touches.width_m = {2e-3, 2e-3};
  }

  /// As hands and machines press: nothing in the firmware knows of it.
  void motions() {
    const auto moves = [this](std::string name, Motion motion, int touched_sets) {
      Disturbance& row = add(std::move(name));
      row.motion = motion;
      row.touched_sets = touched_sets;
      row.rarer = 4;
    };
    for (const double hz : {5, 15, 50}) {
      moves(fmt::format("loads tremble by 30 %, {:g} Hz", hz), {.trembles_hz = hz, .trembling = 0.3}, 600);
      moves(fmt::format("contacts tap, {:g} Hz", hz), {.trembles_hz = hz, .trembling = 1}, 600);
    }
    for (const double speed_mm_per_s : {10, 50, 200})
      moves(fmt::format("contacts slide, {:g} mm/s", speed_mm_per_s),
            {.slides_m_per_s = speed_mm_per_s * 1e-3}, 300);
  }

  void failures() {
    const auto fails = [this](std::string name, Failure failure) -> Disturbance& {
      Disturbance& row = add(std::move(name));
      row.failure = failure;
      return row;
    };
    const auto reads = [&](double gain) -> Disturbance& {
      Disturbance& row = fails(fmt::format("gain of a gauge {:g}", gain), Failure::kGain);
      row.failedGain = gain;
      return row;
    };
    // Most searches have ended by then; of shorter touches they have not.
    const auto held = [](Disturbance& row) {
      row.name += ", touches half a second long";
      row.touched_sets = 500;
    };
    fails("a dead gauge", Failure::kDead);
    fails("two dead neighbours", Failure::kTwoDead);
    fails("a gauge at its rail", Failure::kOpen);
    fails("a stuck gauge", Failure::kStuck);
    fails("a noisy gauge", Failure::kNoisy);
    fails("wires of two neighbours swapped", Failure::kSwapped);
    fails("bad glue: a gauge feels 30 % of its neighbour", Failure::kBadGlue);
    for (const double gain : {0.5, 0.8, 1.2, 1.5}) reads(gain);
    held(fails("a dead gauge", Failure::kDead));
    held(reads(0.5));
  }

  /// What a builder or a calibration leaves: with tables that know of no error, and with the default's.
  void builds() {
    for (const bool isKnown : {false, true}) {
      const char* tables = isKnown ? ", model error 5 %" : "";
      const config::FingerConfig told = isKnown ? config::FingerConfig{} : perfectFinger();
      for (const double gain : {0.02, 0.05, 0.1}) {
        Disturbance& row = add(fmt::format("gains off by {:g} %{}", 100 * gain, tables));
        row.gainSpread = gain;
        row.told = told;
      }
    }
    for (const double width_mm : {0, 1, 2, 4}) {
      built(width_mm).name = fmt::format("as built, {:g} mm wide, model error 5 %", width_mm);
      Disturbance& row = built(width_mm);
      row.name = fmt::format("as built, {:g} mm wide, calibrated", width_mm);
      row.isCalibrated = true;
    }
    Disturbance& two = built(0);
    two.name = "as built, two contacts 4 pitches apart, 1:0.5, model error 5 %";
    two.second = SecondContact{4, 0.5};
    two.touched_sets = kLongestSearch_sets + two.rise_sets;
    Disturbance& dead = built(0);
    dead.name = "as built, a dead gauge, model error 5 %";
    dead.failure = Failure::kDead;
  }

  /// Hardly more than what the gate sees, held until searches have ended.
  void light() {
    for (const double width_mm : {0, 1}) {
      light(add(fmt::format("{:g} mm wide, 0.5 to 2 N/m", width_mm)), width_mm);
      Disturbance& own = light(built(width_mm), width_mm);
      own.name = fmt::format("as built, {:g} mm wide, 0.5 to 2 N/m, calibrated", width_mm);
      own.isCalibrated = true;
      light(built(width_mm), width_mm).name =
          fmt::format("as built, {:g} mm wide, 0.5 to 2 N/m, model error 5 %", width_mm);
    }
  }

  /// Perfect, but on which a narrow touch and a wide one near by may read alike.
  void otherFingers() {
    const std::size_t first = rows_.size();
    const auto finger = [this](const std::string& name) -> config::FingerConfig& {
      Disturbance& row = add("other finger: " + name);
      row.touches.width_m = {0, 2e-3};
      return row.actual;
    };
    finger("16 gauges up to 4 degrees off an even ring").gauges.angles_deg = {
        3.929,   25.623,  52.387,  72.981,  95.497,  115.627, 141.584, 158.984,
        188.273, 207.505, 227.522, 252.196, 276.712, 300.097, 322.956, 344.621};
    for (const int count : {14, 16}) {
      config::FingerConfig& shear = finger(fmt::format("{} gauges of shear", count));
      shear.gauges.count = count;
      shear.gauges.component = StrainComponent::kShear;
      config::FingerConfig& soft = finger(fmt::format("{} gauges, Poisson's ratio 0.3", count));
      soft.gauges.count = count;
      soft.finger.poisson_ratio = 0.3;
    }
    config::FingerConfig& shallow = finger("32 gauges 1.5 mm below the surface, 1 to 15 N/m");
    shallow.gauges.count = 32;
    shallow.gauges.radius_m = 11.2e-3;
    shallow.contact.largest_width_m = 4e-3;
    rows_.back().touches.load_n_per_m = {1, 15};  // its gauges read more of a touch
    for (std::size_t i = first; i < rows_.size(); ++i) rows_[i].told = rows_[i].actual;
  }

  void electronics() {
    for (const double zero : {20, 50}) {
      add(fmt::format("zeros off by {:g} microstrain", zero)).zeroSpread_strain = zero * kMicro;
    }
    for (const double drift : {2, 10}) {
      add(fmt::format("each gauge drifts {:g} microstrain a second", drift)).drift_strain_per_s =
          drift * kMicro;
      add(fmt::format("all gauges drift {:g} microstrain a second", drift)).commonDrift_strain_per_s =
          drift * kMicro;
    }
    for (const double hum : {20, 100, 300})
      for (const bool isEven : {true, false})
        add(fmt::format("hum of {:g} microstrain{}", hum, isEven ? "" : ", uneven")).hum = {hum * kMicro,
                                                                                            isEven};
    for (const double times : {3, 10})
      add(fmt::format("noise times {:g}", times)).actual.gauges.noise_strain *= times;
    for (const double spike : {100, 1000, 10000})
      add(fmt::format("spikes of {:g} microstrain", spike)).spike_strain = spike * kMicro;
  }

  void untouched() {
    for (const double hum : {20, 100, 300})
      for (const bool isEven : {true, false})
        untouched(fmt::format("untouched, hum of {:g} microstrain{}", hum, isEven ? "" : ", uneven"), 1000, 1)
            .hum = {hum * kMicro, isEven};
    untouched("untouched, each gauge drifts 20 microstrain in 10 s", 10'000, 10).drift_strain_per_s =
        2 * kMicro;
    untouched("untouched, all gauges drift 20 microstrain in 10 s", 10'000, 10).commonDrift_strain_per_s =
        2 * kMicro;
    untouched("untouched, noise times 3", 1000, 1).actual.gauges.noise_strain *= 3;
    untouched("untouched, noise times 10", 1000, 1).actual.gauges.noise_strain *= 10;
    untouched("untouched", 1000, 1);
  }

  void slow() {
    for (const double load : {5.0, 30.0}) {
      slow(load, 2, 5);
      slow(load, 20, 30);
      slow(load, 120, 150);
      slow(load, 300, 300);
    }
  }

  /// As hands hold things: what the zeros take from a touch adds up over seconds, and over touches.
  void held() {
    for (const bool isBuilt : {false, true}) {
      held(isBuilt, "loads tremble by 30 %, 1 Hz").motion = {.trembles_hz = 1, .trembling = 0.3};
      held(isBuilt, "contacts slide, 2 mm/s").motion = {.slides_m_per_s = 2e-3};
      for (const double drift : {0.5, 2.0}) {
        const std::string drifts = fmt::format("drift {:g} microstrain a second", drift);
        held(isBuilt, "gauges " + drifts + " each").drift_strain_per_s = drift * kMicro;
        held(isBuilt, "gauges " + drifts + " alike").commonDrift_strain_per_s = drift * kMicro;
      }
    }
  }

  std::vector<Disturbance> take() { return std::move(rows_); }

 private:
  static constexpr int kJoins_sets = 60;

  Disturbance& pair(double apart, double ratio, int rise_sets, int later_sets) {
    std::string name = fmt::format("two contacts {:g} pitches apart, 1:{:g}", apart, ratio);
    if (rise_sets > 5) name += fmt::format(", over {} ms", rise_sets);
    if (later_sets > 0) name += ratio == 1 ? ", one after the other" : ", the weaker joins";
    if (later_sets < 0) name += ", the stronger joins";
    Disturbance& row = add(name);
    row.second = SecondContact{apart, ratio, later_sets};
    row.rise_sets = rise_sets;
    row.touched_sets = kLongestSearch_sets + rise_sets + (later_sets != 0 ? kJoins_sets : 0);
    row.rarer = 4;
    return row;
  }
  Disturbance& built(double width_mm) {
    Disturbance& row = add("");
    row.isBuiltAnew = true;
    row.told = {};
    row.touches.width_m = {width_mm * 1e-3, width_mm * 1e-3};
    return row;
  }
  static Disturbance& light(Disturbance& row, double width_mm) {
    row.touches.width_m = {width_mm * 1e-3, width_mm * 1e-3};
    row.touches.load_n_per_m = {0.5, 2};
    row.touched_sets = 400;
    return row;
  }
  Disturbance& untouched(std::string name, int sets, int rarer) {
    Disturbance& row = add(std::move(name));
    row.isUntouched = true;
    row.touched_sets = sets;
    row.rarer = rarer;
    return row;
  }
  void slow(double load_n_per_m, int seconds, int rarer) {
    Disturbance& row = add(fmt::format("{:g} N/m growing over {} s", load_n_per_m, seconds));
    row.touches.load_n_per_m = {load_n_per_m, load_n_per_m};
    row.rise_sets = 1000 * seconds;
    row.touched_sets = row.rise_sets + 120;
    row.rarer = rarer;
  }

  Disturbance& held(bool isBuilt, const std::string& what) {
    constexpr int kSeconds = 5;
    Disturbance& row = isBuilt ? built(0) : add("");
    row.name = fmt::format("{}touches of {} s, {}{}", isBuilt ? "as built, " : "", kSeconds, what,
                           isBuilt ? ", model error 5 %" : "");
    row.touched_sets = 1000 * kSeconds;
    row.rest_sets = 1000;
    row.rarer = 20;
    return row;
  }

  std::vector<Disturbance> rows_;
};

}  // namespace

std::vector<Disturbance> matrixRows() {
  Rows rows;
  rows.add("nothing wrong");
  rows.widths();
  rows.widerThanTables();
  rows.pairs();
  rows.motions();
  rows.failures();
  rows.builds();
  rows.light();
  rows.otherFingers();
  rows.electronics();
  rows.untouched();
  rows.slow();
  rows.held();
  return rows.take();
}

}  // namespace strainfinger::bench
