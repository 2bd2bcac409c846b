#pragma once
// Views as lines, for files and pipes.

#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>

#include "host/base/table_writer.hpp"
#include "host/live/finger_view.hpp"

namespace strainfinger::live {

/// Says when a view is due on the clock of the frames, and prints it: a line for each finger, or a JSON
/// object for each bus.
class PlainReport {
 public:
  /// Without `unicode` lines are ASCII alone.
  PlainReport(std::FILE* stream, TableFormat format, double every_s, bool unicode)
      : stream_(stream),
        format_(format),
        every_us_(static_cast<std::int64_t>(every_s * 1e6)),
        unicode_(unicode) {}

  /// When the next is due, at `time_us` or before; the first is a period after the first call. After a gap
  /// there is one, not one for each period.
  std::optional<std::int64_t> due(std::int64_t time_us);

  /// Throws Failure(kFailure) when the stream takes no more.
  void print(std::span<const BusView> buses) const;

 private:
  std::FILE* stream_;
  TableFormat format_;
  std::int64_t every_us_;
  bool unicode_;
  std::optional<std::int64_t> next_us_;
};

}  // namespace strainfinger::live
