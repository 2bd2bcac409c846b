#pragma once
// Table images as files.

#include <memory>
#include <string>

#include "common/table_image.hpp"

namespace strainfinger::tables {

/// A file's image, whole and checked. Throws Failure: kFailure if it can't be read, kMismatch if it is of
/// another format, kVerificationFailed if it is damaged. On the heap, for its size.
std::unique_ptr<TableImage> readTableFile(const std::string& path);

/// The bytes of an image: a file's content.
std::string imageBytes(const TableImage& image);

}  // namespace strainfinger::tables
