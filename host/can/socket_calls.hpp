#pragma once
// The system calls under SocketCanPort.

#include <linux/can.h>
#include <sys/socket.h>

#include <cstdint>
#include <string>

#include "host/can/receive_notes.hpp"

namespace strainfinger::can {

/// A seam, so that tests can make each call fail. Results are the calls' own; failures are -errno.
class SocketCalls {
 public:
  virtual ~SocketCalls() = default;

  virtual int open() noexcept = 0;  ///< a raw CAN socket that never blocks
  virtual int close(int socket) noexcept = 0;
  virtual int setOption(int socket, int level, int name, const void* value, socklen_t size) noexcept = 0;
  virtual int interfaceIndex(int socket, const std::string& interface) noexcept = 0;
  virtual int interfaceFlags(int socket, const std::string& interface) noexcept = 0;  ///< IFF_... bits
  virtual int bind(int socket, int interfaceIndex) noexcept = 0;
  virtual int write(int socket, const can_frame& frame) noexcept = 0;
  /// How long it is tells which it is: CAN_MTU, a can_frame, or CANFD_MTU.
  virtual int read(int socket, canfd_frame& frame, ReceiveNotes& notes) noexcept = 0;
  /// 1: something to read, or an error to fetch. 0: nothing within the time.
  virtual int poll(int socket, int timeout_ms) noexcept = 0;
};

/// Those of this kernel.
SocketCalls& linuxSocketCalls();

}  // namespace strainfinger::can
