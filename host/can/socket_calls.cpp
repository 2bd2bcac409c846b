#include "host/can/socket_calls.hpp"

#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace strainfinger::can {
namespace {

template <typename Result>
int orErrno(Result result) {
  return result < 0 ? -errno : static_cast<int>(result);
}

ifreq requestFor(const std::string& interface) {
  ifreq request{};
  std::copy_n(interface.data(), std::min<std::size_t>(interface.size(), IFNAMSIZ - 1), request.ifr_name);
  return request;
}

class LinuxSocketCalls final : public SocketCalls {
 public:
  int open() noexcept override {
    return orErrno(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  }

  int close(int socket) noexcept override { return orErrno(::close(socket)); }

  int setOption(int socket, int level, int name, const void* value, socklen_t size) noexcept override {
    return orErrno(::setsockopt(socket, level, name, value, size));
  }

  int interfaceIndex(int socket, const std::string& interface) noexcept override {
    ifreq request = requestFor(interface);
    const int result = orErrno(::ioctl(socket, SIOCGIFINDEX, &request));
    return result < 0 ? result : request.ifr_ifindex;
  }

  int interfaceFlags(int socket, const std::string& interface) noexcept override {
    ifreq request = requestFor(interface);
    const int result = orErrno(::ioctl(socket, SIOCGIFFLAGS, &request));
    return result < 0 ? result : static_cast<std::uint16_t>(request.ifr_flags);
  }

  int bind(int socket, int interfaceIndex) noexcept override {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = interfaceIndex;
    return orErrno(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  }

  int write(int socket, const can_frame& frame) noexcept override {
    return orErrno(::write(socket, &frame, sizeof frame));
  }

  int read(int socket, canfd_frame& frame, ReceiveNotes& notes) noexcept override {
    return receiveWithNotes(socket, &frame, sizeof frame, notes);
  }

  int poll(int socket, int timeout_ms) noexcept override {
    pollfd waiting{socket, POLLIN, 0};
    return orErrno(::poll(&waiting, 1, timeout_ms));
  }
};

}  // namespace

SocketCalls& linuxSocketCalls() {
  static LinuxSocketCalls calls;
  return calls;
}

}  // namespace strainfinger::can
