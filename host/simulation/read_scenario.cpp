#include "host/simulation/read_scenario.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <ranges>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/excerpt.hpp"
#include "host/base/read_file.hpp"
#include "host/config/toml_text.hpp"

namespace strainfinger::simulation {
namespace {

using config::Domain;
using config::failAt;
using config::realIn;

constexpr int kSchema = 1;

// Ten days, ten revolutions, a hundred times what the default finger measures: beyond it is a slip of the
// pen.
const Domain& timeDomain() {
  static const Domain domain = Domain::between(0, 864'000);
  return domain;
}
const Domain& angleDomain() {
  static const Domain domain = Domain::between(-3600, 3600);
  return domain;
}
const Domain& pressDomain() {
  static const Domain domain = Domain::between(0, 10'000);
  return domain;
}
const Domain& rubDomain() {
  static const Domain domain = Domain::between(-10'000, 10'000);
  return domain;
}

/// As the config's contact.width_m.
const Domain& widthDomain() {
  static const Domain domain = Domain::between(0, 1);
  return domain;
}

struct ProfileName {
  std::string_view name;
  model::Profile profile;
};
constexpr std::array kProfileNames{ProfileName{"hertz", model::Profile::kEllipse},
                                   ProfileName{"uniform", model::Profile::kUniform}};

const std::vector<std::string>& topKeys() {
  static const std::vector<std::string> names{"schema", "repeat_s", "pause_s", "touch"};
  return names;
}

const std::vector<std::string>& touchKeys() {
  static const std::vector<std::string> names{
      "touch.start_s", "touch.end_s",  "touch.angle_deg", "touch.normal_n_per_m", "touch.tangential_n_per_m",
      "touch.width_m", "touch.profile"};
  return names;
}

/// The value of a key that must be there; `key` is dotted.
const toml::node& demand(const toml::table& touch, std::string_view key) {
  const toml::node* node = touch.get(key.substr(key.find('.') + 1));
  if (node == nullptr) failAt(touch.source(), fmt::format("{} is missing", key));
  return *node;
}

/// One point of a list: a number at an even share of the duration, or [seconds, number].
Course::Point readPoint(const toml::array& list, std::size_t index, std::string_view key,
                        const Domain& domain, double duration_s) {
  const toml::node& node = *list.get(index);
  if (!node.is_array()) {
    const double share = static_cast<double>(index) / static_cast<double>(list.size() - 1);
    return {share * duration_s, realIn(node, key, domain)};
  }
  const toml::array& pair = *node.as_array();
  if (pair.size() != 2) failAt(node.source(), fmt::format("{}: a point must be [seconds, number]", key));
  const auto time = Domain::between(0, duration_s);
  return {realIn(*pair.get(0), fmt::format("time in {}", key), time), realIn(*pair.get(1), key, domain)};
}

std::vector<Course::Point> readPoints(const toml::array& list, std::string_view key, const Domain& domain,
                                      double duration_s) {
  if (list.size() < 2) failAt(list.source(), fmt::format("{}: a list needs at least two points", key));
  std::vector<Course::Point> points;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list.get(i)->is_array() != list.get(0)->is_array())
      failAt(list.get(i)->source(), fmt::format("{}: all numbers or all [seconds, number], not both", key));
    points.push_back(readPoint(list, i, key, domain, duration_s));
    if (i > 0 && points[i].time_s < points[i - 1].time_s)
      failAt(list.get(i)->source(), fmt::format("{}: points must be in order of time", key));
  }
  return points;
}

Course readCourse(const toml::node& node, std::string_view key, const Domain& domain, double duration_s) {
  if (!node.is_array()) return Course({{0, realIn(node, key, domain)}});
  return Course(readPoints(*node.as_array(), key, domain, duration_s));
}

model::Profile readProfile(const toml::node& node) {
  const std::string name = config::textOf(node, "touch.profile");
  for (const ProfileName& each : kProfileNames)
    if (each.name == name) return each.profile;
  failAt(node.source(),
         fmt::format("touch.profile = \"{}\" is out of its domain; it must be one of {}", excerpt(name),
                     fmt::join(kProfileNames | std::views::transform(&ProfileName::name), ", ")));
}

/// To the nanosecond: a difference of decimal times is not quite the decimal that a list ends with.
double durationOf(double start_s, double end_s) { return std::round((end_s - start_s) * 1e9) / 1e9; }

TouchCourse readTouch(const toml::node& node) {
  const toml::table& touch = config::sectionOf(node, "touch");
  config::checkKeys(touch, "touch.", touchKeys(), touchKeys());
  const double start_s = realIn(demand(touch, "touch.start_s"), "touch.start_s", timeDomain());
  const toml::node& end = demand(touch, "touch.end_s");
  const double end_s = realIn(end, "touch.end_s", timeDomain());
  if (end_s <= start_s)
    failAt(end.source(), fmt::format("touch.end_s = {} must be after touch.start_s = {}", end_s, start_s));
  const auto course = [&](const toml::node& value, std::string_view key, const Domain& domain) {
    return readCourse(value, key, domain, durationOf(start_s, end_s));
  };
  const toml::node* rub = touch.get("tangential_n_per_m");
  TouchCourse read{start_s, end_s, course(demand(touch, "touch.angle_deg"), "touch.angle_deg", angleDomain()),
                   course(demand(touch, "touch.normal_n_per_m"), "touch.normal_n_per_m", pressDomain()),
                   rub == nullptr ? Course({{0, 0}}) : course(*rub, "touch.tangential_n_per_m", rubDomain())};
  if (const toml::node* width = touch.get("width_m"))
    read.width_m = course(*width, "touch.width_m", widthDomain());
  if (const toml::node* profile = touch.get("profile")) {
    if (!read.width_m)
      failAt(profile->source(),
             "touch.profile says how the load is spread over touch.width_m, which is missing");
    read.profile = readProfile(*profile);
  }
  return read;
}

std::vector<TouchCourse> readTouches(const toml::table& root) {
  std::vector<TouchCourse> touches;
  const toml::node* list = root.get("touch");
  if (list == nullptr) return touches;
  if (!list->is_array()) failAt(list->source(), "touch must be a list of sections: [[touch]]");
  for (const toml::node& node : *list->as_array()) touches.push_back(readTouch(node));
  return touches;
}

}  // namespace

Scenario readScenarioFile(const std::string& path) {
  return readScenario(readFile(path, ExitCode::kUsage), path);
}

Scenario readScenario(std::string_view text, const std::string& name) {
  const toml::table root = config::parseToml(text, name);
  config::checkSchema(root, kSchema);
  config::checkKeys(root, "", topKeys(), topKeys());
  auto touches = readTouches(root);
  const toml::node* repeat = root.get("repeat_s");
  const toml::node* pause = root.get("pause_s");
  if (repeat == nullptr && pause != nullptr)
    failAt(pause->source(), "pause_s is the time between repeats, and repeat_s is missing");
  if (repeat == nullptr) return Scenario(std::move(touches));
  const double end_s = Scenario(touches).duration_s();
  const double repeat_s = realIn(*repeat, "repeat_s", Domain::above(0, 864'000));
  if (repeat_s < end_s)
    failAt(repeat->source(),
           fmt::format("repeat_s = {} cuts off a touch: touch.end_s = {}", repeat_s, end_s));
  const double pause_s = pause == nullptr ? 0 : realIn(*pause, "pause_s", timeDomain());
  return Scenario(std::move(touches), repeat_s, pause_s);
}

Scenario builtInScenario() { return readScenario(builtInScenarioText(), "built-in scenario"); }

}  // namespace strainfinger::simulation
