#pragma once
// Times of a log that run backwards.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/line_reader.hpp"

namespace strainfinger::can {

/// Watches the times of frames as they stand in logs.
class LogTimes {
 public:
  /// Whether the frames of all interfaces are in one order, as in one log, or those of each are in an order
  /// of their own, as in logs of several buses that are read one after the other.
  enum class Order { kOfAll, kOfEachInterface };
  explicit LogTimes(Order order) : order_(order) {}

  /// Takes a frame's time, as it stands in the last line.
  void watch(std::string_view interface, std::int64_t time_ns, const LineReader& lines);

  /// What to tell, once all is read: where times first went back by more than frames of several interfaces
  /// may, or that they are differences; "": nothing.
  std::string warning() const;

 private:
  struct Clock {
    std::int64_t last_ns, latest_ns;
  };
  Clock& clockOf(std::string_view interface, std::int64_t time_ns);

  Order order_;
  std::map<std::string, Clock, std::less<>> clocks_;     ///< by interface
  std::pair<const std::string, Clock>* last_ = nullptr;  ///< of the frame before
  std::optional<std::int64_t> latest_ns_;                ///< of all
  std::uint64_t times_ = 0, timesBack_ = 0;              ///< earlier than the frame's before
  std::string name_;                                     ///< of the log where one first was
  std::string timesGoBack_;                              ///< where, first, and by how much
};

}  // namespace strainfinger::can
