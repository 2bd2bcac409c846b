#pragma once
// A request to a finger whose response is awaited while the bus goes on being read. can::ask() waits for one
// and reads nothing else.

#include <cstdint>
#include <optional>
#include <string>

#include "common/commands.hpp"

namespace strainfinger::live {

/// What became of a request.
struct Outcome {
  std::uint8_t node = 0;
  bool isDone = false;  ///< it did what it was told to
  std::string text;     ///< for people
};

class PendingRequest {
 public:
  /// `now_us`: when it was made, on the clock of take() and expire().
  PendingRequest(std::uint8_t node, const RequestFrame& request, std::int64_t now_us)
      : node_(node), request_(request), asked_us_(now_us) {}

  std::uint8_t node() const { return node_; }
  CanFrame frame() const { return encode(request_, node_); }

  /// True once the bus took frame(); until then that is to be tried again.
  bool isSent() const { return sent_; }
  void markSent() { sent_ = true; }

  /// The outcome, of the frame that answers it.
  std::optional<Outcome> take(const CanFrame& frame) const;
  /// The outcome of one that is not to be sent, and why.
  Outcome refused(const std::string& why) const { return outcome(false, why); }
  /// The outcome when no answer came within twice the time that a finger has for it.
  std::optional<Outcome> expire(std::int64_t now_us) const;

 private:
  Outcome outcome(bool isDone, const std::string& what) const;

  std::uint8_t node_;
  RequestFrame request_;
  std::int64_t asked_us_;
  bool sent_ = false;
};

}  // namespace strainfinger::live
