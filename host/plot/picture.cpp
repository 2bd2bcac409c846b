#include "host/plot/picture.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "host/base/failure.hpp"
#include "host/base/table_writer.hpp"
#include "host/plot/process.hpp"

namespace strainfinger::plot {
namespace {

namespace fs = std::filesystem;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void failWriting(const fs::path& path) {
  throw Failure(ExitCode::kFailure,
                fmt::format("{}: cannot write the file: {}", path.string(), std::strerror(errno)));
}

File create(const fs::path& path) {
  File file(std::fopen(path.c_str(), "w"), &std::fclose);
  if (!file) failWriting(path);
  return file;
}

void close(File file, const fs::path& path) {
  if (std::fclose(file.release()) != 0) failWriting(path);
}

void writeText(const fs::path& path, const std::string& text) {
  File file = create(path);
  std::fputs(text.c_str(), file.get());
  close(std::move(file), path);
}

void writeData(const fs::path& path, const DataFile& data) {
  File file = create(path);
  TableWriter table(file.get(), TableFormat::kCsv, data.columns);
  for (const auto& row : data.rows) table.row({row.begin(), row.end()});
  close(std::move(file), path);
}

/// Fonts that every gnuplot finds; sizes that look alike in both terminals.
std::string terminal(const Picture& picture, const std::string& ending) {
  if (ending == ".png")
    return fmt::format("pngcairo size {},{} font 'sans,11' background '#ffffff'", picture.width_px,
                       picture.height_px);
  if (ending == ".svg")
    return fmt::format("svg size {},{} dynamic font 'sans-serif,14' background '#ffffff'", picture.width_px,
                       picture.height_px);
  throw Failure(ExitCode::kUsage, fmt::format("pictures are .svg or .png, not \"{}\"", ending));
}

}  // namespace

std::string completeScript(const Picture& picture, const std::string& stem, const std::string& ending) {
  return fmt::format(
      "set terminal {}\nset output '{}{}'\nset datafile separator ','\n"
      "data(name) = '{}-'.name.'.csv'\ngap(n) = strlen(strcol(n)) ? column(n) : NaN\n{}unset output\n",
      terminal(picture, ending), stem, ending, stem, picture.script);
}

void requirePicturePath(const std::string& path) { terminal({}, fs::path(path).extension().string()); }

void draw(const Picture& picture, const std::string& path) {
  const fs::path file(path), folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const std::string stem = file.stem().string();
  const std::string script = completeScript(picture, stem, file.extension().string());
  writeText(folder / (stem + ".gp"), script);
  for (const DataFile& data : picture.data)
    writeData(folder / fmt::format("{}-{}.csv", stem, data.name), data);
  runIn(folder.string(), {"gnuplot", stem + ".gp"}, "gnuplot-nox");
}

}  // namespace strainfinger::plot
