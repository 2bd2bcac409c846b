#include "host/bench/model/model_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/plot/style.hpp"

namespace strainfinger::bench {
namespace {

constexpr std::array kTasks{"table", "field", "contact", "svd"};
constexpr std::array kTitles{"impulse table, 1024 angles", "field, 8 rows x 360 angles", "contact, flat 2 mm",
                             "singular values, 2 mm"};

std::string duration(double time_s) {
  return time_s < 1e-3 ? fmt::format("{:.3g} us", time_s * 1e6)
         : time_s < 1  ? fmt::format("{:.3g} ms", time_s * 1e3)
                       : fmt::format("{:.3g} s", time_s);
}

std::vector<std::string> methodsOf(const std::vector<MeasuredCase>& cases, const std::string& task) {
  std::vector<std::string> methods;
  for (const MeasuredCase& each : cases)
    if (each.task == task && std::ranges::find(methods, each.method) == methods.end())
      methods.push_back(each.method);
  return methods;
}

/// As gnuplot has it.
std::string quoted(const std::string& text) {
  std::string result(1, '\'');
  for (const char each : text) result.append(each == '\'' ? 2 : 1, each);
  result.push_back('\'');
  return result;
}

/// Errors of zero have a place on a logarithmic axis too.
std::vector<double> point(const MeasuredCase& each) { return {each.time_s, std::max(each.error, 1e-17)}; }

std::string rowOf(const MeasuredCase& each) {
  return fmt::format("| {} | {:g} {} | {:.1e} | {} |\n", each.method, each.value, each.knob, each.error,
                     duration(each.time_s));
}

/// Of every method its closest answer, and the fastest way to it.
MeasuredCase closest(const std::vector<MeasuredCase>& cases, const std::string& task,
                     const std::string& method) {
  const MeasuredCase* best = nullptr;
  for (const MeasuredCase& each : cases) {
    if (each.task != task || each.method != method) continue;
    if (best == nullptr || each.error < best->error / 2 ||
        (each.error < 2 * best->error && each.time_s < best->time_s))
      best = &each;
  }
  return *best;
}

}  // namespace

std::string MeasuredCase::name() const { return fmt::format("{}/{}/{:g} {}", task, method, value, knob); }

std::vector<MeasuredCase> paretoOf(const std::vector<MeasuredCase>& cases, const std::string& task) {
  std::vector<MeasuredCase> front, some;
  std::ranges::copy_if(cases, std::back_inserter(some),
                       [&](const MeasuredCase& each) { return each.task == task; });
  std::ranges::stable_sort(some, {}, &MeasuredCase::time_s);
  for (const MeasuredCase& each : some)
    if (!std::isnan(each.error) && (front.empty() || each.error < front.back().error)) front.push_back(each);
  return front;
}

std::string modelCsv(const std::vector<MeasuredCase>& cases) {
  std::string text = "task,method,knob,value,error,time_s\n";
  for (const MeasuredCase& each : cases)
    text += fmt::format("{},\"{}\",{},{},{},{}\n", each.task, each.method, each.knob, each.value,
                        std::isnan(each.error) ? "" : fmt::format("{}", each.error), each.time_s);
  return text;
}

std::string savingsCsv(const std::vector<Saving>& savings) {
  std::string text = "what,needed_s,all_s,ratio\n";
  for (const Saving& saving : savings)
    text += fmt::format("\"{}\",{},{},{}\n", saving.what, saving.needed.time_s, saving.all.time_s,
                        saving.ratio());
  return text;
}

std::string modelMarkdown(const std::vector<MeasuredCase>& cases, const std::vector<Saving>& savings) {
  std::string text =
      "# Run time against error of the model\n\nWritten by `bench_model`; what it measures: "
      "[README.md](README.md).\n";
  for (std::size_t i = 0; i < kTasks.size(); ++i) {
    text += fmt::format(
        "\n**{}**: each method at its closest.\n\n| method | at | error / peak | time |\n|--|--|--|--|\n",
        kTitles[i]);
    for (const std::string& method : methodsOf(cases, kTasks[i]))
      text += rowOf(closest(cases, kTasks[i], method));
    text += "\nThe front (nothing is both faster and closer): ";
    for (const MeasuredCase& each : paretoOf(cases, kTasks[i]))
      text +=
          fmt::format("{} {:g} ({:.0e}, {}); ", each.method, each.value, each.error, duration(each.time_s));
    text += "\n";
  }
  text +=
      "\n**Others** (errors where there is one to measure)\n\n| what | error / peak | time |\n|--|--|--|\n";
  for (const MeasuredCase& each : cases)
    if (std::ranges::find(kTasks, each.task) == kTasks.end())
      text +=
          fmt::format("| {}: {} | {} | {} |\n", each.task, each.method,
                      std::isnan(each.error) ? "" : fmt::format("{:.1e}", each.error), duration(each.time_s));
  text +=
      "\n**What isn't asked for isn't computed**\n\n| left out | with it | without | ratio "
      "|\n|--|--|--|--|\n";
  for (const Saving& saving : savings)
    text += fmt::format("| {} | {} | {} | {:.1f} |\n", saving.what, duration(saving.all.time_s),
                        duration(saving.needed.time_s), saving.ratio());
  return text;
}

plot::Picture paretoPicture(const std::vector<MeasuredCase>& cases) {
  plot::Picture picture{1500, 1100, plot::kStyle, {}};
  picture.script += R"(set multiplot layout 2,2 margins 0.06,0.985,0.07,0.95 spacing 0.08,0.12
set logscale xy; set format xy '10^{%T}'; set xlabel 'time (s)'; set ylabel 'worst error / peak'
set yrange [5e-18:2]; set key inside bottom left vertical Left reverse samplen 1 font ',9'
array colours[8] = [blue, vermilion, green, orange, black, lightBlue, '#CC79A7', faint]
)";
  for (std::size_t i = 0; i < kTasks.size(); ++i) {
    picture.script += fmt::format("set title '{}' offset 0,-0.5; set key bottom {}\nplot ", kTitles[i],
                                  kTasks[i] == std::string_view("field") ? "right" : "left");
    const auto methods = methodsOf(cases, kTasks[i]);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      plot::DataFile data{fmt::format("{}-{}", kTasks[i], k), {"time_s", "error"}, {}};
      for (const MeasuredCase& each : cases)
        if (each.task == kTasks[i] && each.method == methods[k]) data.rows.push_back(point(each));
      picture.script += fmt::format(
          "data('{}') using 1:2 every ::1 with points pointtype {} pointsize 1.1 linecolor rgb colours[{}] "
          "title {}, ",
          data.name, 4 + k, k % 8 + 1, quoted(methods[k]));
      picture.data.push_back(std::move(data));
    }
    plot::DataFile front{fmt::format("{}-front", kTasks[i]), {"time_s", "error"}, {}};
    for (const MeasuredCase& each : paretoOf(cases, kTasks[i])) front.rows.push_back(point(each));
    picture.script +=
        fmt::format("data('{}') using 1:2 every ::1 with steps linecolor rgb faint notitle\n", front.name);
    picture.data.push_back(std::move(front));
  }
  picture.script += "unset multiplot\n";
  return picture;
}

}  // namespace strainfinger::bench
