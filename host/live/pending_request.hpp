#pragma once
// A request to a finger whose response is awaited while the bus goes on being read. can::ask() waits for one
// and reads nothing else.

#include <cstdint>
#include <optional>
#include <string>

#include "common/commands.hpp"

namespace strainfinger::live {

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

  /// What to tell people once it is known: of the frame that answers it.
  std::optional<std::string> take(const CanFrame& frame) const;
  /// And when no answer came within twice the time that a finger has for it.
  std::optional<std::string> expire(std::int64_t now_us) const;

 private:
  std::string told(const std::string& what) const;

  std::uint8_t node_;
  RequestFrame request_;
  std::int64_t asked_us_;
  bool sent_ = false;
};

}  // namespace strainfinger::live
