#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/base/text_output.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/paper/figure.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kFiguresHelp =
    "The figures of Nicolson & Fearing (1993), each as figure-N.svg and figure-N.png with its data "
    "(figure-N-*.csv) and the script that draws the .png again (figure-N.gp). Without gnuplot, all but the "
    "pictures are written, and the exit status is 1.\n"
    "On stdout, and in claims.csv: what the paper says about them, what was computed for the paper's "
    "finger, and whether that bears the paper out. With --config the figures are those of another finger.";

/// As texts: of numbers, CLI11 has no complaint about what is none.
std::vector<std::string> figureNumbers() {
  std::vector<std::string> numbers;
  for (const paper::Figure& figure : paper::figures()) numbers.push_back(fmt::to_string(figure.number));
  return numbers;
}

struct FiguresOptions {
  explicit FiguresOptions(CLI::App& command) : common(command) {
    command.add_option("-o,--output", folder, "Folder for the files; made if it isn't there")
        ->required()
        ->type_name("DIR");
    addList(command, "--only", only, "Only these figures, separated by commas",
            CLI::IsMember(figureNumbers()))
        .type_name("N,N");
  }

  bool wants(const paper::Figure& figure) const {
    return only.empty() || std::ranges::find(only, figure.number) != only.end();
  }

  CommonOptions common;
  std::string folder;
  std::vector<int> only;
};

void makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw Failure(ExitCode::kFailure, fmt::format("cannot make the folder {}: {}", folder, error.message()));
}

void writeClaims(std::FILE* stream, TableFormat format, const std::vector<paper::Claim>& claims) {
  TableWriter table(stream, format, {"claim", "paper", "computed", "verdict"});
  for (const paper::Claim& claim : claims)
    table.row({claim.name, claim.paper, claim.computed, std::string(nameOf(claim.verdict))});
}

std::string claimsText(const std::vector<paper::Claim>& claims) {
  return textWritten([&](std::FILE* stream) { writeClaims(stream, TableFormat::kCsv, claims); });
}

/// Why nothing can be drawn; empty if it can be.
std::string whyNoPictures() {
  try {
    plot::requireGnuplot();
    return {};
  } catch (const Failure& failure) {
    return failure.what();
  }
}

void writeFigure(const paper::Figure& figure, const paper::Subject& subject, const std::string& folder,
                 bool isDrawn) {
  const plot::Picture picture = figure.picture(subject);
  const std::string stem = fmt::format("{}/figure-{}", folder, figure.number);
  if (!isDrawn) return plot::writeUndrawn(picture, stem + ".png");
  for (const char* ending : {".svg", ".png"}) draw(picture, stem + ending);
}

/// Runs `work`; a failure of it after a signal, which ends gnuplot too, is an interruption.
template <typename Work>
void doInterruptibly(const system::StopSignal& stop, int figure, Work work) {
  try {
    work();
  } catch (const Failure&) {
    if (!stop.asked()) throw;
  }
  if (stop.asked())
    throw Failure(ExitCode::kInterrupted, fmt::format("figures: interrupted at figure {}", figure));
}

void runFigures(const FiguresOptions& options) {
  const paper::Subject subject(options.common.config());
  const std::string whyNone = whyNoPictures();
  makeFolder(options.folder);
  const system::StopSignal stop;
  std::vector<paper::Claim> claims;
  for (const paper::Figure& figure : paper::figures()) {
    if (!options.wants(figure)) continue;
    tell("figure {}: {}\n", figure.number, figure.title);
    if (const std::string lacks = figure.lacks(subject); !lacks.empty())
      warn("figures", fmt::format("figure {}: {}", figure.number, lacks));
    doInterruptibly(stop, figure.number, [&] {
      writeFigure(figure, subject, options.folder, whyNone.empty());
      for (paper::Claim& claim : figure.claims()) claims.push_back(std::move(claim));
    });
  }
  writeFileAtomically(options.folder + "/claims.csv", claimsText(claims));
  writeClaims(stdout, options.common.format(), claims);
  if (!whyNone.empty())
    throw Failure(
        ExitCode::kFailure,
        fmt::format("{}. No picture was drawn in {}; data, scripts and claims are there. With gnuplot, run "
                    "this again, or draw one .png: cd there and gnuplot figure-N.gp",
                    whyNone, options.folder));
}

}  // namespace

void addFigures(CLI::App& app) { addCommand<FiguresOptions>(app, "figures", kFiguresHelp, runFigures); }

}  // namespace strainfinger::cli
