#pragma once
// The system calls of SocketCanPort, each of which fails when the test says so.

#include <linux/can/raw.h>
#include <net/if.h>

#include <cerrno>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "host/can/socket_calls.hpp"

namespace strainfinger::doubles {

class FakeSocketCalls final : public can::SocketCalls {
 public:
  /// What one read gives: a frame, less of it, or an error; and the kernel's count of lost frames, if it
  /// tells.
  struct Read {
    int result = CAN_MTU;
    canfd_frame frame{};
    std::optional<std::uint32_t> lost{};
    std::int64_t time_ns = 0;
  };

  int openResult = 0;        ///< these four: 0, or the -errno to fail with
  int opensThatWork = 1000;  ///< then open() fails with -EMFILE
  int optionResult = 0;
  int indexResult = 0;
  int bindResult = 0;
  int flags = IFF_UP | IFF_RUNNING;
  int pollResult = 0;
  std::deque<int> writeResults;  ///< of the next writes; then they succeed
  std::deque<Read> frames;       ///< of the next reads of data frames; then -EAGAIN
  std::deque<Read> errors;       ///< of the next reads of error frames; then -EAGAIN
  std::vector<can_frame> written;
  int writes = 0;
  std::vector<can_filter> filters;  ///< of the data frames

  std::size_t openSockets() const { return hearsErrors_.size(); }

  int open() noexcept override {
    if (openResult < 0) return openResult;
    if (opensThatWork-- == 0) return -EMFILE;
    hearsErrors_[++lastSocket_] = false;
    return lastSocket_;
  }

  int close(int socket) noexcept override { return hearsErrors_.erase(socket) == 1 ? 0 : -EBADF; }

  int setOption(int socket, int, int name, const void* value, socklen_t size) noexcept override {
    if (name == CAN_RAW_ERR_FILTER) hearsErrors_[socket] = *static_cast<const can_err_mask_t*>(value) != 0;
    if (name == CAN_RAW_FILTER && size > 0) {
      const auto* first = static_cast<const can_filter*>(value);
      filters.assign(first, first + size / sizeof *first);
    }
    return optionResult;
  }

  int interfaceIndex(int, const std::string&) noexcept override { return indexResult < 0 ? indexResult : 7; }
  int interfaceFlags(int, const std::string&) noexcept override { return flags; }
  int bind(int, int) noexcept override { return bindResult; }
  int poll(int, int) noexcept override { return pollResult; }

  int write(int socket, const can_frame& frame) noexcept override {
    if (!hearsErrors_.contains(socket)) return -EBADF;
    ++writes;
    int result = sizeof frame;
    if (!writeResults.empty()) {
      result = writeResults.front();
      writeResults.pop_front();
    }
    if (result == sizeof frame) written.push_back(frame);
    return result;
  }

  int read(int socket, canfd_frame& frame, can::ReceiveNotes& notes) noexcept override {
    if (!hearsErrors_.contains(socket)) return -EBADF;
    auto& waiting = hearsErrors_[socket] ? errors : frames;
    if (waiting.empty()) return -EAGAIN;
    const Read next = waiting.front();
    waiting.pop_front();
    frame = next.frame;
    notes.lost = next.lost.value_or(notes.lost);
    notes.time_ns = next.time_ns;
    return next.result;
  }

 private:
  std::map<int, bool> hearsErrors_;  ///< by open socket: whether it is the one for error frames
  int lastSocket_ = 2;
};

}  // namespace strainfinger::doubles
