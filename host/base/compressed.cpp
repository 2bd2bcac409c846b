#include "host/base/compressed.hpp"

#include <fmt/format.h>

#include <array>

#include "host/base/failure.hpp"

namespace strainfinger {
namespace {

struct Compression {
  std::string_view name;
  std::string_view beginning;
  std::string_view reader;  ///< the program that prints what is in it
};
constexpr std::array kCompressions{Compression{"gzip", "\x1F\x8B", "zcat"},
                                   Compression{"xz", "\xFD\x37\x7A\x58\x5A", "xzcat"},
                                   Compression{"zstd", "\x28\xB5\x2F\xFD", "zstdcat"}};

}  // namespace

void requireUncompressed(const std::string& name, std::string_view beginning) {
  for (const Compression& compression : kCompressions)
    if (beginning.starts_with(compression.beginning))
      throw Failure(ExitCode::kFailure,
                    fmt::format("{} is compressed with {}: `{} {} | strainfinger decode`, and so for other "
                                "commands that read stdin; else unpack it first",
                                name, compression.name, compression.reader, name == "stdin" ? "FILE" : name));
}

}  // namespace strainfinger
