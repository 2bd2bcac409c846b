#include "host/tables/table_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "host/base/failure.hpp"
#include "host/base/read_file.hpp"

namespace strainfinger::tables {
namespace {

std::string wordsFor(TableFault fault, const TableImage& image, std::size_t bytes) {
  switch (fault) {
    case TableFault::kTooShort:
      return fmt::format("{} bytes, too short for a table image", bytes);
    case TableFault::kMagic:
      return "not a table image";
    case TableFault::kFormat:
      return fmt::format("a table image of format {}, this program and its firmware read format {}",
                         image.format, kTableFormat);
    case TableFault::kLength:
      return fmt::format("{} bytes, and {} by its header, where an image has {}", bytes, image.image_bytes,
                         sizeof(TableImage));
    case TableFault::kChecksum:
      return "damaged, its CRC-32 does not match";
    default:
      return "its constants are none that the firmware can work with";
  }
}

TableFault faultOf(const TableImage& image, std::size_t bytes) {
  if (bytes < kTableHeaderBytes) return TableFault::kTooShort;
  const TableFault fault = checkTableImage(image);
  const bool isOurs = fault != TableFault::kMagic && fault != TableFault::kFormat;
  return isOurs && bytes != sizeof(TableImage) ? TableFault::kLength : fault;
}

/// Of what is no table image nobody is told to write over it.
std::string adviceOn(TableFault fault, const std::string& path) {
  if (fault == TableFault::kTooShort || fault == TableFault::kMagic)
    return path.ends_with(".toml") ? ": a config goes after -c" : "";
  return fmt::format("; make it anew with: strainfinger tables [-c CONFIG] -o {}", path);
}

}  // namespace

std::unique_ptr<TableImage> readTableFile(const std::string& path) {
  const std::string bytes = readFile(path, ExitCode::kFailure);
  auto image = std::make_unique<TableImage>();
  std::memcpy(image.get(), bytes.data(), std::min(bytes.size(), sizeof(TableImage)));
  const TableFault fault = faultOf(*image, bytes.size());
  if (fault == TableFault::kNone) return image;
  throw Failure(fault == TableFault::kFormat ? ExitCode::kMismatch : ExitCode::kVerificationFailed,
                fmt::format("{}: {}{}", path, wordsFor(fault, *image, bytes.size()), adviceOn(fault, path)));
}

std::string imageBytes(const TableImage& image) {
  std::string bytes(sizeof(image), '\0');
  std::memcpy(bytes.data(), &image, sizeof(image));
  return bytes;
}

}  // namespace strainfinger::tables
