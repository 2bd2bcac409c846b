#include "tests/architecture/rooms.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace strainfinger::architecture {
namespace {

std::vector<std::string> linesOf(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The names in `backticks`, without a slash at their end.
std::set<std::string> namesIn(const std::string& text) {
  static const std::regex kName("`([a-z_/]+?)/?`");
  std::set<std::string> names;
  for (std::sregex_iterator match(text.begin(), text.end(), kName), end; match != end; ++match)
    names.insert((*match)[1]);
  return names;
}

/// Cells of a row of a Markdown table; none if it isn't one.
std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream row(line);
  std::string cell;
  std::getline(row, cell, '|');
  if (!cell.empty() || line.empty()) return {};
  while (std::getline(row, cell, '|')) cells.push_back(cell);
  return cells;
}

bool isIn(const std::string& path, const std::string& folder) {
  return path == folder || path.starts_with(folder + "/");
}

/// "can" in host/README.md is host/can if there is such a row, else the folder of that name.
void resolveNames(Rooms& rooms, const std::string& folder) {
  for (auto& [room, names] : rooms) {
    if (!isIn(room, folder)) continue;
    std::set<std::string> resolved;
    for (const std::string& name : names)
      resolved.insert(rooms.contains(folder + "/" + name) ? folder + "/" + name : name);
    names = resolved;
  }
}

std::string withoutCommentsAndStrings(std::string_view text) {
  static const std::regex kIgnored(R"(//[^\n]*|/\*[^]*?\*/|"(\\.|[^"\\\n])*"|'(\\.|[^'\\\n])')");
  const std::string source(text);
  std::string code;
  std::size_t from = 0;
  for (std::sregex_iterator match(source.begin(), source.end(), kIgnored), end; match != end; ++match) {
    const auto position = static_cast<std::size_t>(match->position());
    code += source.substr(from, position - from);
    const std::string ignored = match->str();
    code.append(static_cast<std::size_t>(std::ranges::count(ignored, '\n')), '\n');  // keeps line numbers
    from = position + ignored.size();
  }
  return code + source.substr(from);
}

}  // namespace

void addRooms(Rooms& rooms, const std::string& folder, std::string_view readme) {
  std::set<std::string> besides;
  std::set<std::string> asAWhole;
  bool hasRows = false;
  for (const std::string& line : linesOf(readme)) {
    const auto cells = cellsOf(line);
    if (line.starts_with("Depends on:")) asAWhole = namesIn(line);
    if (cells.empty()) continue;
    if (cells.back().find("may include") != std::string::npos) besides = namesIn(cells.back());
    if (cells.front().find("/`") == std::string::npos || namesIn(cells.front()).size() != 1) continue;
    auto& names = rooms[folder + "/" + *namesIn(cells.front()).begin()];
    names = namesIn(cells.back());
    if (cells.back() == " all ") names = {"common", "hal", "firmware", "host"};
    names.insert(besides.begin(), besides.end());
    hasRows = true;
  }
  if (!hasRows) rooms[folder] = asAWhole;
  resolveNames(rooms, folder);
}

std::string roomOf(const Rooms& rooms, const std::string& path) {
  std::string best;
  for (const auto& entry : rooms)
    if (path.starts_with(entry.first + "/") && entry.first.size() > best.size()) best = entry.first;
  return best;
}

std::vector<std::string> forbiddenIncludes(const Rooms& rooms, const std::string& path,
                                           std::string_view text) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*"([^"]+)\".*)");
  const std::string room = roomOf(rooms, path);
  std::vector<std::string> found;
  if (room.empty()) found.push_back(path + " is in no room that a README.md tells of");
  int number = 0;
  for (const std::string& line : linesOf(text)) {
    ++number;
    std::smatch match;
    if (room.empty() || !std::regex_match(line, match, kInclude)) continue;
    const std::string target = roomOf(rooms, match[1]);
    const auto allows = [&](const std::string& name) { return isIn(target, name); };
    if (target == room || std::ranges::any_of(rooms.at(room), allows)) continue;
    found.push_back(path + ":" + std::to_string(number) + ": " + room + " may not include " + match[1].str());
  }
  return found;
}

std::vector<std::string> forbiddenWords(const std::string& path, std::string_view text) {
  static const std::regex kForbidden(
      R"(\b(float|double|new|throw|try|catch|malloc|calloc|realloc|free|dynamic_cast|typeid)\b)"
      R"(|\bstd::(vector|string|deque|list|map|set|unordered_\w+|function|any|(unique|shared)_ptr|make_\w+|thread|\w*stream)\b)"
      R"(|#\s*include\s*<(vector|string|deque|list|map|set|memory|functional|cmath|iostream|stdexcept)>)");
  std::vector<std::string> found;
  int number = 0;
  for (const std::string& line : linesOf(withoutCommentsAndStrings(text))) {
    ++number;
    std::smatch match;
    if (std::regex_search(line, match, kForbidden))
      found.push_back(path + ":" + std::to_string(number) + ": " + match.str());
  }
  return found;
}

std::vector<std::string> sourcesUnder(const std::filesystem::path& root, const std::string& folder) {
  std::vector<std::string> sources;
  if (!std::filesystem::exists(root / folder)) return sources;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".hpp" || extension == ".cpp" || extension == ".h" || extension == ".c")
      sources.push_back(entry.path().lexically_relative(root).generic_string());
  }
  std::ranges::sort(sources);
  return sources;
}

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace strainfinger::architecture
