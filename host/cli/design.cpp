#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/no_value.hpp"
#include "host/base/notice.hpp"
#include "host/base/parse_number.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/model_options.hpp"
#include "host/config/finger_config.hpp"
#include "host/design/assessment.hpp"
#include "host/design/bounds_picture.hpp"
#include "host/plot/picture.hpp"
#include "host/simulation/scenario.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kDesignHelp =
    "Which finger to build: what gauges could tell of a touch, by their number and the radius of their "
    "ring.\n"
    "Each row is one finger as drawn, with an even ring. All other values come from the config, which must "
    "be\n"
    "valid itself. gauges.angle_deg, [calibration] and [as_built] are not used.\n"
    "  ..._median, ..._worst  of 256 places within a pitch: the least standard deviation that an unbiased\n"
    "                         fit can have (Cramer and Rao), the shear as the firmware fits it, from noise\n"
    "                         alone; deviations from the drawing\n"
    "                         (gauges.model_error) are not included. inf (JSON: null): undetermined; empty: "
    "no width, or\n"
    "                         a known one\n"
    "  identifiable_share     of the places, where the readings determine the touch: the place within\n"
    "                         half a pitch, the load within itself\n"
    "  table_bytes            of the firmware's tables; empty like what follows where none can be made\n"
    "  certain_share          of the places, at how many the firmware tells the touch without a flag,\n"
    "                         from readings without noise\n"
    "  detected_n_per_m       from which load on the firmware sees a line contact anywhere\n"
    "  full_scale_n_per_m     the line contact that the gauges' full scale allows\n"
    "  problem                why the finger is unsuitable for such a touch; empty: it is suitable";

/// Of the outer radius. Nearer to the surface the elastic model takes seconds a finger.
constexpr double kLeastDepth = 1e-3;
constexpr int kMostGauges = 128, kMostRadii = 1000;
constexpr double kFaintestTouch_n_per_m = 1e-3, kFirmestTouch_n_per_m = 1e6;

struct DesignOptions {
  explicit DesignOptions(CLI::App& command) : common(command) {
    command
        .add_option("--noise-strain", noise_strain,
                    "Standard deviation of a reading (the config's gauges.noise_strain)")
        ->type_name("S")
        ->check(isFrom(1e-12, 0.1));
    command
        .add_option("--gauges", gauges,
                    "Numbers of gauges: one, or from a to b, every second or every step-th")
        ->type_name("a[:b[:step]]")
        ->capture_default_str();
    command
        .add_option("--radius-m", radii, "Radii of the ring [m]: one, or n evenly from a to b (the config's)")
        ->type_name("a[:b:n]");
    command.add_option("--normal-n-per-m", normal_n_per_m, "Normal load of the touch [N/m]")
        ->type_name("P")
        ->check(isFrom(kFaintestTouch_n_per_m, kFirmestTouch_n_per_m))
        ->capture_default_str();
    command.add_option("--tangential-n-per-m", tangential_n_per_m, "Its tangential load [N/m]")
        ->type_name("Q")
        ->check(isFrom(-kFirmestTouch_n_per_m, kFirmestTouch_n_per_m))
        ->capture_default_str();
    command
        .add_option("--width-m", width_m,
                    "Its width [m], as PATCH tells that of a round object: the even pressure of the same "
                    "second moment is so wide; known where the config knows one (contact.width_m, or 0.001)")
        ->type_name("W")
        ->check(isFrom(0, 1));
    command.add_option("--picture", picturePath, "Draws the worst bounds there, .svg or .png; needs gnuplot")
        ->type_name("FILE");
  }
  CommonOptions common;
  std::optional<double> noise_strain;
  std::string gauges = "12:32";
  std::optional<std::string> radii;
  double normal_n_per_m = 30;
  double tangential_n_per_m = 0;
  std::optional<double> width_m;
  std::string picturePath;
};

/// The numbers between colons; nothing where one of them is none.
std::optional<std::vector<double>> numbersOf(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const auto value = takeNumber<double>(text);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    numbers.push_back(*value);
    if (text.empty()) return numbers;
    if (text.front() != ':') return std::nullopt;
    text.remove_prefix(1);
  }
}

std::vector<int> gaugesOf(const std::string& text) {
  const auto numbers = numbersOf(text).value_or(std::vector<double>{});
  const double first = numbers.empty() ? 0 : numbers[0], last = numbers.size() > 1 ? numbers[1] : first,
               step = numbers.size() > 2 ? numbers[2] : 2;
  bool isGood = !numbers.empty() && numbers.size() <= 3;
  for (const double number : {first, last, step})
    isGood = isGood && number == std::round(number) && number >= 1 && number <= kMostGauges;
  if (!isGood || last < first)
    throw Failure(
        ExitCode::kUsage,
        fmt::format(
            "--gauges {}: must be a, a:b or a:b:step, whole numbers from 1 to {}, a at most b, such as "
            "8:32 or 12:32:4",
            excerpt(text), kMostGauges));
  std::vector<int> counts;
  for (double count = first; count <= last; count += step) counts.push_back(static_cast<int>(count));
  return counts;
}

std::vector<double> radiiOf(const std::optional<std::string>& text, const config::FingerConfig& config) {
  if (!text) return {config.gauges.radius_m};
  const auto numbers = numbersOf(*text).value_or(std::vector<double>{});
  const bool isOne = numbers.size() == 1;
  const double count = isOne ? 1 : numbers.size() == 3 ? numbers[2] : 0;
  if (count != std::round(count) || count < (isOne ? 1 : 2) || count > kMostRadii)
    throw Failure(ExitCode::kUsage,
                  fmt::format("--radius-m {}: must be a radius, or a:b:n with n from 2 to {}, such as "
                              "9e-3:12e-3:7",
                              excerpt(*text), kMostRadii));
  const std::vector<double> radii = isOne ? numbers : evenly(numbers[0], numbers[1], static_cast<int>(count));
  for (const double radius_m : radii) {
    requireInRubber(radius_m, config.finger);
    if (radius_m > (1 - kLeastDepth) * config.finger.outer_radius_m)
      throw Failure(ExitCode::kUsage,
                    fmt::format("--radius-m: gauges at {} m would be nearer to the surface than {} of its "
                                "radius, where no table holds what they feel; choose a smaller radius",
                                radius_m, kLeastDepth));
  }
  return radii;
}

simulation::Touch touchOf(const DesignOptions& options, const config::Contact& contact) {
  constexpr double kWidth_m = 1e-3;
  const double width_m =
      options.width_m.value_or(contact.width_m.value_or(std::min(kWidth_m, contact.largest_width_m)));
  if (width_m > contact.largest_width_m)
    throw Failure(ExitCode::kUsage, fmt::format("--width-m {}: must be at most contact.largest_width_m = {}",
                                                width_m, contact.largest_width_m));
  const double most_n_per_m = contact.friction_coefficient * options.normal_n_per_m;
  if (std::abs(options.tangential_n_per_m) > most_n_per_m)
    throw Failure(ExitCode::kUsage,
                  fmt::format("--tangential-n-per-m {}: the contact would slip; it must be within +-{}, "
                              "contact.friction_coefficient times --normal-n-per-m",
                              options.tangential_n_per_m, most_n_per_m));
  return {0, options.normal_n_per_m, options.tangential_n_per_m, width_m, model::Profile::kUniform};
}

constexpr design::Bound kNoBound{kNoValue, kNoValue};

/// A row: the finger, its bounds, what the firmware makes of it.
NamedRow candidateRow(const design::Candidate& finger) {
  const design::Assessment& found = finger.found;
  const auto bounds =
      found.bounds.value_or(design::Bounds{kNoBound, kNoBound, kNoBound, std::nullopt, kNoValue});
  const design::Bound width_m = bounds.width_m.value_or(kNoBound);
  const auto trial = found.trial.value_or(design::Trial{0, kNoValue, kNoValue, kNoValue});
  return {{"gauges", std::int64_t{finger.gauges}},
          {"radius_m", finger.radius_m},
          {"arc_median_m", bounds.arc_m.median},
          {"arc_worst_m", bounds.arc_m.worst},
          {"normal_median_n_per_m", bounds.normal_n_per_m.median},
          {"normal_worst_n_per_m", bounds.normal_n_per_m.worst},
          {"tangential_median_n_per_m", bounds.tangential_n_per_m.median},
          {"tangential_worst_n_per_m", bounds.tangential_n_per_m.worst},
          {"width_median_m", width_m.median},
          {"width_worst_m", width_m.worst},
          {"identifiable_share", bounds.identifiableShare},
          {"table_bytes", found.trial ? Cell(static_cast<std::int64_t>(trial.tableBytes)) : kNoValue},
          {"certain_share", trial.certainShare},
          {"detected_n_per_m", trial.detected_n_per_m},
          {"full_scale_n_per_m", trial.fullScale_n_per_m},
          {"problem", found.problem.empty() ? Cell(kNoValue) : Cell(found.problem)}};
}

/// Of the fingers without a problem, the one with the least worst error of places.
const design::Candidate* bestOf(const std::vector<design::Candidate>& candidates) {
  const design::Candidate* best = nullptr;
  const auto worstArc_m = [](const design::Candidate& finger) { return finger.found.bounds->arc_m.worst; };
  for (const design::Candidate& finger : candidates)
    if (finger.found.problem.empty() && (best == nullptr || worstArc_m(finger) < worstArc_m(*best)))
      best = &finger;
  return best;
}

void tellOf(const design::Candidate* best) {
  if (best == nullptr) {
    tell("design: each of these fingers has a problem with this touch, see there\n");
    return;
  }
  tell(
      "design: of the fingers without a problem with this touch, {} gauges at {:.4g} m have the least "
      "worst error of places, {:.3g} m\n",
      best->gauges, best->radius_m, best->found.bounds->arc_m.worst);
}

void runDesign(const DesignOptions& options) {
  if (!options.picturePath.empty())
    options.common.requireNoneNamed("--picture", plot::filesBeside(options.picturePath, design::kBoundsData));
  config::FingerConfig config = options.common.config();
  const std::vector<int> counts = gaugesOf(options.gauges);
  const std::vector<double> radii = radiiOf(options.radii, config);
  const simulation::Touch touch = touchOf(options, config.contact);
  if (!options.picturePath.empty()) plot::requirePicturePath(options.picturePath);
  requireFolderOf("--picture", options.picturePath);
  if (config.contact.width_m) config.contact.width_m = touch.width_m;
  if (options.noise_strain) config.gauges.noise_strain = *options.noise_strain;
  TableWriter table(stdout, options.common.format(), columnsOf(candidateRow({})));
  const system::StopSignal stop;
  std::vector<design::Candidate> candidates;
  for (const double radius_m : radii)
    for (const int count : counts) {
      if (stop.asked())
        throw Failure(ExitCode::kInterrupted, fmt::format("design: interrupted after {} of {} fingers",
                                                          candidates.size(), radii.size() * counts.size()));
      config.gauges.count = count;
      config.gauges.radius_m = radius_m;
      candidates.push_back({count, radius_m, design::assess(config, touch)});
      table.row(valuesOf(candidateRow(candidates.back())));
      table.flush();
    }
  if (!options.picturePath.empty()) plot::draw(design::boundsPicture(candidates), options.picturePath);
  tellOf(bestOf(candidates));
}

}  // namespace

void addDesign(CLI::App& app) { addCommand<DesignOptions>(app, "design", kDesignHelp, runDesign); }

}  // namespace strainfinger::cli
