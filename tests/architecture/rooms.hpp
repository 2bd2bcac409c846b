#pragma once
// Which folder may include which, as the folders' README.md say it: they are the table.

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace strainfinger::architecture {

/// What each room (a folder that is a target: "common", "host/can") may include; a name of several rooms
/// ("firmware") means all of them.
using Rooms = std::map<std::string, std::set<std::string>>;

/// Reads one README.md into `rooms`. Either it has a table whose rows begin with a folder (`can/`) and whose
/// last column names what that may include ("all": everything), the column's header what all rows may
/// besides; or a line "Depends on:" for the folder as a whole.
void addRooms(Rooms& rooms, const std::string& folder, std::string_view readme);

/// The room a file lies in by its path from the root, or "" if it is in none.
std::string roomOf(const Rooms& rooms, const std::string& path);

/// One line for each #include "..." of the file that its room may not have.
std::vector<std::string> forbiddenIncludes(const Rooms& rooms, const std::string& path,
                                           std::string_view text);

/// One line for each word of a source text that firmware/core does without: floating point, heap, exceptions.
/// Comments and strings are not looked at.
std::vector<std::string> forbiddenWords(const std::string& path, std::string_view text);

/// Paths from the root of the C++ files under a folder.
std::vector<std::string> sourcesUnder(const std::filesystem::path& root, const std::string& folder);

std::string contentOf(const std::filesystem::path& file);

}  // namespace strainfinger::architecture
