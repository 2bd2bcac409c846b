#include "host/tables/table_header.hpp"

#include <fmt/format.h>

#include <iterator>

#include "host/tables/table_file.hpp"
#include "host/tables/table_text.hpp"

namespace strainfinger::tables {

std::string imageHeader(const TableImage& image) {
  std::string text =
      "#pragma once\n"
      "// Lookup tables of a finger, made by `strainfinger tables --header`. Not to be edited: make them "
      "anew.\n";
  for (const Parameter& parameter : parametersOf(image))
    fmt::format_to(std::back_inserter(text), "//   {} = {}\n", parameter.key, textOf(parameter));
  fmt::format_to(std::back_inserter(text),
                 "// CRC-32 0x{:08X}\n\n#include <cstdint>\n\nnamespace strainfinger {{\n\n"
                 "alignas(8) inline constexpr std::uint8_t kDefaultTableBytes[{}] = {{",
                 image.crc32, sizeof(image));
  const std::string bytes = imageBytes(image);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{}{},", i % 20 == 0 ? "\n    " : " ",
                   static_cast<unsigned char>(bytes[i]));
  text += "\n};\n\n}  // namespace strainfinger\n";
  return text;
}

}  // namespace strainfinger::tables
