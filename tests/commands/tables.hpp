#pragma once
// Tables that the program printed.

#include <sstream>
#include <string>
#include <vector>

namespace strainfinger {

/// The numbers after the header of a CSV table.
inline std::vector<std::vector<double>> tableOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::vector<double>> rows;
  std::string line;
  for (std::getline(stream, line); std::getline(stream, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(std::stod(field));
  }
  return rows;
}

}  // namespace strainfinger
