#pragma once
// How the program ends, and the exception that carries an ending to main().

#include <stdexcept>
#include <string>

namespace strainfinger {

/// Exit statuses: fixed, scripts rely on them.
enum class ExitCode : int {
  kOk = 0,
  kFailure = 1,
  kUsage = 2,        ///< usage or bad config
  kNoInterface = 3,  ///< no interface or no permission
  kNoNode = 4,       ///< no node answered
  kMismatch = 5,     ///< version or table mismatch
  kVerificationFailed = 6,
  kInterrupted = 130,
};

/// Ends the program. The message says what, where and how to fix it, without the program's name or a newline.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace strainfinger
