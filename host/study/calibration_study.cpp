// How near calibrations of many simulated fingers come to the truth, as a page.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/quantile.hpp"
#include "host/calibration/wiring.hpp"
#include "host/study/calibration_score.hpp"
#include "host/study/calibration_session.hpp"

namespace strainfinger::study {
namespace {

constexpr int kNewTouches = 300;  ///< a finger
constexpr std::array kNames{"arc", "normal", "tangential"};

struct Options {
  int fingers = 30;
  int sessions = 1;  ///< a finger
  std::vector<int> touches{300};
  int wiring = 0, healthy = 0;
  std::string output;
};

/// What became of the fingers of one plan.
struct Outcome {
  std::array<std::vector<double>, 3> overPredicted, overBound, error;
  std::vector<Eigen::Matrix3Xd> byChance;  ///< of each finger, overPredicted if errors are the covariance's
  std::array<std::vector<double>, 3> overWithoutJunk;  ///< of the same finger by the same rows but the junk
  std::vector<double> overSigma;                       ///< errors of all unknowns over their sigmas
  double mostUnexplained = 0, mostWritten = 0, mostSeconds = 0;
  /// Of place [m^2] and normal load [(N/m)^2], summed: squared errors beyond noise, and as they are written.
  Eigen::Array2d beyondNoise = Eigen::Array2d::Zero(), written = Eigen::Array2d::Zero();
  int refused = 0;
};

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The session without its junk.
Session healthyPart(const Session& session) {
  Session part{session.finger, {}, {}, {}};
  std::vector<Eigen::Index> rows;
  for (std::size_t row = 0; row < session.known.size(); ++row) {
    if (session.isJunk[row]) continue;
    rows.push_back(static_cast<Eigen::Index>(row));
    part.known.push_back(session.known[row]);
  }
  part.readings = session.readings(rows, Eigen::all);
  return part;
}

/// One session of a finger; what came of its calibration.
NewTouches addSession(const config::FingerConfig& finger, std::uint64_t seed, const SessionPlan& plan,
                      Outcome& outcome) {
  const Session session = sessionOf(finger, plan, seed);
  const double start_s = processor_s();
  const auto result = calibration::calibrate(finger, session.known, session.readings, kExactlyKnown);
  outcome.mostSeconds = std::max(outcome.mostSeconds, processor_s() - start_s);
  const NewTouches touches = newTouches(result, finger, kNewTouches, seed);
  if (plan.junk > 0) {
    const Session healthy = healthyPart(session);
    const auto without = calibration::calibrate(finger, healthy.known, healthy.readings, kExactlyKnown);
    const NewTouches same = newTouches(without, finger, kNewTouches, seed);
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      outcome.overWithoutJunk[i].push_back(touches.error[at] / same.error[at]);
    }
  }
  const Eigen::VectorXd errors = errorsOverSigma(result, finger);
  outcome.overSigma.insert(outcome.overSigma.end(), errors.begin(), errors.end());
  outcome.mostUnexplained = std::max(outcome.mostUnexplained, result.modelError().value);
  const config::FingerConfig applied = result.applied();
  outcome.mostWritten = std::max(outcome.mostWritten, applied.gauges.model_error);
  outcome.beyondNoise += (touches.error.cwiseAbs2() - touches.bound.cwiseAbs2()).head<2>().array();
  outcome.written +=
      Eigen::Array2d(applied.calibration.place_error_m, applied.calibration.load_error * touches.load_n_per_m)
          .square();
  return touches;
}

/// Of touches after several sessions.
NewTouches rootMeanSquare(const std::vector<NewTouches>& all) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  NewTouches mean{zero, zero, Eigen::Matrix3Xd::Zero(3, kChances), zero};
  for (const NewTouches& each : all) {
    mean.error += each.error.cwiseAbs2();
    mean.predicted += each.predicted.cwiseAbs2();
    mean.bound += each.bound.cwiseAbs2();
    mean.byChance += (each.predicted.asDiagonal() * each.byChance).cwiseAbs2();
  }
  mean.byChance = (mean.predicted.cwiseInverse().asDiagonal() * mean.byChance).cwiseSqrt();
  for (Eigen::Vector3d* each : {&mean.error, &mean.predicted, &mean.bound})
    *each = (*each / static_cast<double>(all.size())).cwiseSqrt();
  return mean;
}

void addFinger(std::uint64_t seed, const SessionPlan& plan, int sessions, Outcome& outcome) {
  constexpr std::uint64_t kSeedsApart = 100'000;
  const config::FingerConfig finger = randomFinger(seed);
  std::vector<NewTouches> all;
  for (int i = 0; i < sessions; ++i)
    all.push_back(addSession(finger, seed + kSeedsApart * static_cast<std::uint64_t>(i), plan, outcome));
  const NewTouches touches = rootMeanSquare(all);
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    outcome.overPredicted[i].push_back(touches.error[at] / touches.predicted[at]);
    outcome.overBound[i].push_back(touches.error[at] / touches.bound[at]);
    outcome.error[i].push_back(touches.error[at]);
  }
  outcome.byChance.push_back(touches.byChance);
}

Outcome outcomeOf(const SessionPlan& plan, int fingers, int sessions) {
  Outcome outcome;
  for (int seed = 1; seed <= fingers; ++seed) try {
      addFinger(static_cast<std::uint64_t>(seed), plan, sessions, outcome);
    } catch (const Failure& failure) {
      ++outcome.refused;
      fmt::print(stderr, "finger {}: {}\n", seed, failure.what());
    }
  return outcome;
}

double quantile(std::vector<double> values, double share) {
  return values.empty() ? 0 : quantileOf(std::move(values), share);
}

std::string three(const std::array<std::vector<double>, 3>& each, double share) {
  return fmt::format("{:.2f} / {:.2f} / {:.2f}", quantile(each[0], share), quantile(each[1], share),
                     quantile(each[2], share));
}

/// The worst of all fingers, were their errors drawn by their covariances: what no estimator betters.
std::string chanceLines(const Outcome& outcome) {
  constexpr double kBar = 1.4;
  if (outcome.byChance.empty()) return {};
  Eigen::Matrix3Xd worst = outcome.byChance.front();
  for (const Eigen::Matrix3Xd& each : outcome.byChance) worst = worst.cwiseMax(each);
  std::array<std::vector<double>, 3> worsts;
  for (std::size_t i = 0; i < worsts.size(); ++i) {
    const Eigen::VectorXd row = worst.row(static_cast<Eigen::Index>(i));
    worsts[i].assign(row.begin(), row.end());
  }
  const auto met = (worst.colwise().maxCoeff().array() <= kBar).count();
  return fmt::format(
      "| the worst, were errors drawn by the covariance: median of {} draws; 95 % quantile | {} | {} |\n"
      "| share of draws in which no finger is worse than {} | {:.0f} % | |\n",
      kChances, three(worsts, 0.5), three(worsts, 0.95), kBar,
      100.0 * static_cast<double>(met) / static_cast<double>(kChances));
}

std::string sectionOf(const SessionPlan& plan, int fingers, int sessions) {
  const Outcome outcome = outcomeOf(plan, fingers, sessions);
  double squares = 0;
  int covered = 0;
  for (const double each : outcome.overSigma) {
    squares += each * each;
    covered += std::abs(each) < 1.96;
  }
  const double count = std::max<double>(1, static_cast<double>(outcome.overSigma.size()));
  std::string text = fmt::format(
      "\n## {} touches{}, {} fingers, sessions of each: {}\n\n| figure | median finger | worst finger "
      "|\n|--|--|--|\n",
      plan.touches, plan.junk > 0 ? ", a tenth of them junk" : "", fingers, sessions);
  text +=
      fmt::format("| error of new touches over what is predicted: arc / normal / tangential | {} | {} |\n",
                  three(outcome.overPredicted, 0.5), three(outcome.overPredicted, 1));
  text += chanceLines(outcome);
  if (plan.junk > 0)
    text += fmt::format("| over the error of the same session without its junk | {} | {} |\n",
                        three(outcome.overWithoutJunk, 0.5), three(outcome.overWithoutJunk, 1));
  text += fmt::format("| over the bound of a finger perfectly known | {} | {} |\n",
                      three(outcome.overBound, 0.5), three(outcome.overBound, 1));
  text += fmt::format("| error: um, N/m, N/m | {:.1f}, {:.3f}, {:.3f} | {:.1f}, {:.3f}, {:.3f} |\n",
                      1e6 * quantile(outcome.error[0], 0.5), quantile(outcome.error[1], 0.5),
                      quantile(outcome.error[2], 0.5), 1e6 * quantile(outcome.error[0], 1),
                      quantile(outcome.error[1], 1), quantile(outcome.error[2], 1));
  text += fmt::format(
      "\n"
      "Errors of the fingers' unknowns over their sigmas: RMS {:.2f}, {:.1f} % within 1.96. Unexplained "
      "share of a reading at most {:.3f} %; gauges.model_error written at most {:.2f} %. Errors of new "
      "touches beyond their noise over calibration.place_error_m, .load_error as written: {:.2f}, {:.2f} "
      "(RMS of all). Processor time at most {:.1f} s a finger. Refused: {}.\n",
      std::sqrt(squares / count), 100 * covered / count, 100 * outcome.mostUnexplained,
      100 * outcome.mostWritten, std::sqrt(std::max(0.0, outcome.beyondNoise[0]) / outcome.written[0]),
      std::sqrt(std::max(0.0, outcome.beyondNoise[1]) / outcome.written[1]), outcome.mostSeconds,
      outcome.refused);
  return text;
}

constexpr const char* kIntroduction =
    R"(# Calibrations of simulated fingers, against the truth

Gauges off by 0.5 deg, 0.05 mm and 3 % (standard deviations), the core by up to 0.1 mm, Poisson's ratio 0.47 to 0.5; noise of 6 microstrain; touches
of 2 to 40 N/m within 45 degrees of pressing, 0.5 to 4 mm wide, unknown but for 5 loads and one direction. New touches are of 30 N/m and 2 mm, located
in double precision with the finger as calibrated; predicted is what noise and the calibration's own covariance make of them.
)";

/// One way to wire a ring wrongly, of the gauges that the number names, and what should be found.
struct Miswiring {
  const char* name;
  void (*apply)(Eigen::MatrixXd& readings, int number);
  calibration::WiringFault (*fault)(int number);
};

void turn(Eigen::MatrixXd& readings, int shift, int sense) {
  const Eigen::MatrixXd drawn = readings;
  const auto count = static_cast<int>(readings.cols());
  for (int i = 0; i < count; ++i) readings.col(i) = drawn.col((count + shift + sense * i) % count);
}

using Kind = calibration::WiringFault::Kind;

/// Gauges are drawn so far off even places.
constexpr double kUneven_deg[] = {0, 1, 2.5};

constexpr int swappedWith(int number) { return (number + 1 + number / 16) % 16; }

constexpr std::array<Miswiring, 6> kMiswirings{{
    {"swapped pair", [](Eigen::MatrixXd& r, int n) { r.col(n % 16).swap(r.col(swappedWith(n))); },
     [](int n) {
       return calibration::WiringFault{Kind::kSwapped, std::min(n % 16, swappedWith(n)),
                                       std::max(n % 16, swappedWith(n))};
     }},
    {"wrong sign", [](Eigen::MatrixXd& r, int n) { r.col(n % 16) *= -1; },
     [](int n) {
       return calibration::WiringFault{Kind::kSign, n % 16};
     }},
    {"dead", [](Eigen::MatrixXd& r, int n) { r.col(n % 16) *= 1e-3; },
     [](int n) {
       return calibration::WiringFault{Kind::kDead, n % 16};
     }},
    {"reads its neighbour's strain", [](Eigen::MatrixXd& r, int n) { r.col(n % 16) = r.col((n + 1) % 16); },
     [](int n) {
       return calibration::WiringFault{Kind::kGlued, n % 16, (n + 1) % 16};
     }},
    {"shifted", [](Eigen::MatrixXd& r, int n) { turn(r, 1 + n % 15, 1); },
     [](int n) {
       return calibration::WiringFault{Kind::kShifted, 0, 1 + n % 15};
     }},
    {"reversed", [](Eigen::MatrixXd& r, int n) { turn(r, n % 16, -1); },
     [](int n) {
       return calibration::WiringFault{Kind::kReversed, 0, n % 16};
     }},
}};

/// Keeps of all directions one, of a firm touch a quarter of a pitch from a gauge, as the guide asks for:
/// about a gauge and about the middle of a gap, a ring that is reversed reads as one that is turned does.
void knowOneMark(Session& session) {
  constexpr double kFirm_strain = 4e-3;  ///< of 15 N/m
  const double quarter_deg = 360.0 / (4 * session.finger.gauges.count);
  const auto away_deg = [&](std::size_t row) {
    const auto& angle_deg = session.known[row].angle_deg;
    const double peak_strain = session.readings.row(static_cast<Eigen::Index>(row)).cwiseAbs().maxCoeff();
    if (!angle_deg || peak_strain < kFirm_strain) return 360.0;
    return std::abs(std::remainder(*angle_deg - quarter_deg, 2 * quarter_deg));
  };
  std::size_t nearest = 0;
  for (std::size_t row = 1; row < session.known.size(); ++row)
    if (away_deg(row) < away_deg(nearest)) nearest = row;
  for (std::size_t row = 0; row < session.known.size(); ++row)
    if (row != nearest) session.known[row].angle_deg.reset();
}

/// A random finger whose gauges are drawn up to so much off even places.
config::FingerConfig unevenFinger(std::uint64_t seed, double most_deg) {
  config::FingerConfig finger = randomFinger(seed);
  if (most_deg == 0) return finger;
  for (int gauge = 0; gauge < finger.gauges.count; ++gauge)
    finger.gauges.angles_deg.push_back((gauge + 0.5) * 360 / finger.gauges.count +
                                       most_deg * std::cos(gauge * gauge + static_cast<double>(seed)));
  return finger;
}

std::vector<calibration::WiringFault> faultsOf(int seed, double uneven_deg, const Miswiring* miswiring) {
  const auto number = static_cast<std::uint64_t>(seed);
  const SessionPlan plan{.touches = 300, .knownDirections = 300};
  Session session = sessionOf(unevenFinger(number, uneven_deg), plan, number);
  knowOneMark(session);
  if (miswiring != nullptr) miswiring->apply(session.readings, seed);
  return findWiringFaults(session.finger, session.known, session.readings, kExactlyKnown);
}

void printMissed(const char* wired, int seed, double uneven_deg,
                 const std::vector<calibration::WiringFault>& faults) {
  fmt::print(stderr, "finger {} of {} degrees, {}:", seed, uneven_deg, wired);
  for (const auto& fault : faults) fmt::print(stderr, " {};", textOf(fault));
  fmt::print(stderr, "{}\n", faults.empty() ? " nothing found" : "");
}

/// Whichever mark tells a turn.
bool areOnly(const std::vector<calibration::WiringFault>& faults, calibration::WiringFault expected) {
  if (faults.size() != 1) return false;
  expected.onlyMark = faults.front().onlyMark;
  return faults.front() == expected;
}

std::string wiringSection(int fingers, int healthy, double uneven_deg) {
  std::string text = fmt::format(
      "\n## Wiring, gauges drawn up to {} degrees off even places: 300 touches, 1 direction known, of a firm "
      "touch a quarter of a pitch from a gauge\n\n| wired | found | of | found first |\n|--|--|--|--|\n",
      uneven_deg);
  for (const Miswiring& miswiring : kMiswirings) {
    int found = 0;
    std::string example;
    for (int seed = 1; seed <= fingers; ++seed) {
      const auto faults = faultsOf(seed, uneven_deg, &miswiring);
      const bool isFound = areOnly(faults, miswiring.fault(seed));
      found += isFound;
      if (!isFound) printMissed(miswiring.name, seed, uneven_deg, faults);
      if (example.empty() && !faults.empty()) example = textOf(faults.front());
    }
    text += fmt::format("| {} | {} | {} | {} |\n", miswiring.name, found, fingers, example);
  }
  int alarms = 0;
  for (int seed = 1; seed <= healthy; ++seed) {
    const auto faults = faultsOf(seed, uneven_deg, nullptr);
    alarms += !faults.empty();
    if (!faults.empty()) printMissed("as drawn", seed, uneven_deg, faults);
  }
  return text + fmt::format("| as drawn | {} | {} | |\n", alarms, healthy);
}

void run(const Options& options) {
  std::string page = kIntroduction;
  if (options.wiring + options.healthy > 0)
    for (const double uneven_deg : kUneven_deg)
      page += wiringSection(options.wiring, options.healthy, uneven_deg);
  for (const int touches : options.touches) {
    if (options.fingers == 0) break;
    page += sectionOf({.touches = touches}, options.fingers, options.sessions);
    if (touches <= 300 && options.sessions == 1)
      page += sectionOf({.touches = touches, .junk = 0.1}, options.fingers, options.sessions);
  }
  if (options.output.empty())
    fmt::print("{}", page);
  else
    writeFileAtomically(options.output, page);
}

}  // namespace
}  // namespace strainfinger::study

int main(int argc, char** argv) {
  strainfinger::study::Options options;
  CLI::App app("Calibrates random simulated fingers and compares with the truth.");
  app.add_option("--fingers", options.fingers, "How many; 0: only wiring (30)")->check(CLI::Range(0, 10'000));
  app.add_option("--sessions", options.sessions,
                 "Of each finger, none with junk; its errors and what is predicted are their root mean "
                 "square (1)")
      ->check(CLI::Range(1, 1000));
  app.add_option("--touches", options.touches, "Touches of a session; several: one after the other (300)")
      ->check(CLI::Range(40, 100'000));
  app.add_option("--wiring", options.wiring, "Also so many fingers of each fault of wiring (0)")
      ->check(CLI::Range(0, 10'000));
  app.add_option("--healthy", options.healthy, "And so many that are wired as drawn (0)")
      ->check(CLI::Range(0, 100'000));
  app.add_option("-o,--output", options.output, "The page; stdout without it");
  CLI11_PARSE(app, argc, argv);
  try {
    strainfinger::study::run(options);
  } catch (const strainfinger::Failure& failure) {
    fmt::print(stderr, "calibration_study: {}\n", failure.what());
    return static_cast<int>(failure.code());
  }
  return 0;
}
