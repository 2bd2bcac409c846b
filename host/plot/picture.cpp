#include "host/plot/picture.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/read_file.hpp"
#include "host/base/table_writer.hpp"
#include "host/base/text_output.hpp"
#include "host/base/text_parts.hpp"
#include "host/system/process.hpp"

namespace strainfinger::plot {
namespace {

namespace fs = std::filesystem;
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void failWriting(const fs::path& path) {
  throw Failure(ExitCode::kFailure,
                fmt::format("{}: cannot write the file: {}", path.string(), std::strerror(errno)));
}

std::string csvOf(const DataFile& data) {
  return textWritten([&](std::FILE* stream) {
    TableWriter table(stream, TableFormat::kCsv, data.columns);
    for (const auto& row : data.rows)
      if (row.empty())
        writeText(stream, "\n");
      else
        table.row({row.begin(), row.end()});
  });
}

/// Beside a picture of that stem.
std::string scriptName(const std::string& stem) { return stem + ".gp"; }
std::string dataName(const std::string& stem, const std::string& name) {
  return fmt::format("{}-{}.csv", stem, name);
}

/// A folder inside that of `file`, in which it and what belongs to it are made whole before they appear
/// there. Gone with what is left in it when it goes.
class Workshop {
 public:
  explicit Workshop(const fs::path& file)
      : folder_(file.has_parent_path() ? file.parent_path() : fs::path(".")),
        inside_((folder_ / ".picture-XXXXXX").string()) {
    if (::mkdtemp(inside_.data()) == nullptr) failWriting(file);
  }
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(inside_, ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  const fs::path& folder() const { return folder_; }
  fs::path path() const { return inside_; }

  void deliver() const {
    for (const auto& file : fs::directory_iterator(inside_)) {
      const fs::path target = folder_ / file.path().filename();
      if (std::rename(file.path().c_str(), target.c_str()) != 0) failWriting(target);
    }
  }

 private:
  fs::path folder_;
  std::string inside_;
};

/// Fonts that every gnuplot finds; sizes that look alike in both terminals.
std::string terminal(const Picture& picture, const std::string& ending) {
  if (ending == ".png")
    return fmt::format("pngcairo size {},{} font 'sans,11' background '#ffffff'", picture.width_px,
                       picture.height_px);
  if (ending == ".svg")
    return fmt::format("svg size {},{} dynamic font 'sans-serif,14' background '#ffffff'", picture.width_px,
                       picture.height_px);
  throw Failure(ExitCode::kUsage, fmt::format("pictures are .svg or .png, not \"{}\"", excerpt(ending)));
}

}  // namespace

std::string quoted(const std::string& text) {
  const std::string inside = replacedAll(text, "'", "''");
  return fmt::format("'{}'", inside);
}

std::string completeScript(const Picture& picture, const std::string& stem, const std::string& ending) {
  return fmt::format(
      "set terminal {}\nset output {}\nset datafile separator ','\n"
      "data(name) = {}.name.'.csv'\ngap(n) = valid(n) ? column(n) : NaN\n{}unset output\n",
      terminal(picture, ending), quoted(stem + ending), quoted(stem + "-"), picture.script);
}

namespace {

void runGnuplot(const fs::path& folder, const std::string& argument) {
  system::runIn(folder.string(), {"gnuplot", argument}, "gnuplot-nox");
}

/// A failure names the file as it would be called in the end.
void write(const Workshop& workshop, const std::string& name, const std::string& text) {
  File file(std::fopen((workshop.path() / name).c_str(), "w"), &std::fclose);
  const bool isWritten = file && std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  if (!isWritten || std::fclose(file.release()) != 0) failWriting(workshop.folder() / name);
}

void writeIn(const Workshop& workshop, const Picture& picture, const std::string& stem,
             const std::string& ending) {
  write(workshop, scriptName(stem), completeScript(picture, stem, ending));
  for (const DataFile& data : picture.data) write(workshop, dataName(stem, data.name), csvOf(data));
}

void drawIn(const Workshop& workshop, const Picture& picture, const std::string& stem,
            const std::string& ending) {
  writeIn(workshop, picture, stem, ending);
  runGnuplot(workshop.path(), "./" + scriptName(stem));  // it takes "-a.gp" for an option
  std::error_code notThere;  // is -1 then, and 0 where gnuplot has opened the file only
  if (fs::file_size(workshop.path() / (stem + ending), notThere) + 1 <= 1)
    throw Failure(ExitCode::kFailure, fmt::format("{}: gnuplot has not drawn it", stem + ending));
}

}  // namespace

void requireGnuplot() { runGnuplot(".", "--version"); }

void requirePicturePath(const std::string& path) {
  terminal({}, fs::path(path).extension().string());
  requireGnuplot();
}

void draw(const Picture& picture, const std::string& path) {
  const fs::path file(path);
  terminal(picture, file.extension().string());
  const Workshop workshop(file);
  drawIn(workshop, picture, file.stem().string(), file.extension().string());
  workshop.deliver();
}

void writeUndrawn(const Picture& picture, const std::string& path) {
  const fs::path file(path);
  const std::string ending = file.extension().string();
  terminal(picture, ending);
  const Workshop workshop(file);
  writeIn(workshop, picture, file.stem().string(), ending);
  workshop.deliver();
}

std::vector<std::string> filesBeside(const std::string& path, std::span<const char* const> dataNames) {
  const fs::path file(path);
  const auto beside = [&](const std::string& name) { return (file.parent_path() / name).string(); };
  std::vector<std::string> files{beside(scriptName(file.stem().string()))};
  for (const char* const name : dataNames) files.push_back(beside(dataName(file.stem().string(), name)));
  return files;
}

std::string svgElement(const Picture& picture, const std::string& name) {
  const Workshop workshop(fs::temp_directory_path() / (name + ".svg"));
  drawIn(workshop, picture, name, ".svg");
  std::string svg = readFile((workshop.path() / (name + ".svg")).string(), ExitCode::kFailure);
  svg.erase(0, svg.find("<svg"));
  svg = replacedAll(std::move(svg), "<title>Gnuplot</title>", "");  // a page would show it at every point
  for (const std::string begin : {"id='", "id=\"", "href='#", "href=\"#", "url(#"})
    svg = replacedAll(std::move(svg), begin, begin + name + "-");
  return svg;
}

}  // namespace strainfinger::plot
