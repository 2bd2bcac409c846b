#pragma once
// A log as `candump -L` writes it, which stays readable whatever ends this program.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/can_frame.hpp"
#include "host/can/other_frame.hpp"

namespace strainfinger::can {

/// Writes whole lines. What flush() has handed to the system is in the file even if the program is killed
/// next.
class LogWriter {
 public:
  /// Makes the file. Throws Failure(kFailure) if there is one of that name already, or it cannot be made.
  explicit LogWriter(const std::string& path);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  void add(std::int64_t time_ns, std::string_view interface, const CanFrame& frame);
  void add(std::string_view interface, const OtherFrame& other);

  /// Throws Failure(kFailure) when the disk is full or broken; then the file ends with the last whole line
  /// that it took, and the rest of what has been added is lost. Throws it too when others have removed the
  /// file, or cut it, since it was made.
  void flush();

  /// The name that others gave the file; "": it still has its own. What is written goes into it as before.
  std::string renamedTo() const;

 private:
  void requireWhole(std::size_t last_bytes) const;

  std::string path_;
  int descriptor_;
  std::string text_;  ///< not written yet
  std::size_t written_bytes_ = 0;
};

}  // namespace strainfinger::can
