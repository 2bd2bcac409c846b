#pragma once
// What the kernel says of what it gives to a socket.

#include <cstddef>
#include <cstdint>

namespace strainfinger::can {

struct ReceiveNotes {
  std::uint32_t lost = 0;        ///< by this socket's queue so far; left alone where the kernel doesn't say
  std::int64_t time_ns = 0;      ///< since 1970, when it arrived; now where the kernel doesn't say
  std::uint16_t senderPort = 0;  ///< of a UDP socket: whose datagram it is
};

/// recvmsg() of a socket with SO_RXQ_OVFL and SO_TIMESTAMPNS: its result, or -errno.
int receiveWithNotes(int socket, void* data, std::size_t size, ReceiveNotes& notes) noexcept;

}  // namespace strainfinger::can
