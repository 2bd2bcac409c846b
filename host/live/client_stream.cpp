#include "host/live/client_stream.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace strainfinger::live {
namespace {

using Clock = std::chrono::steady_clock;

bool waitFor(int socket, short events, Clock::time_point end) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    pollfd waiting{socket, events, 0};
    const int count = ::poll(&waiting, 1, static_cast<int>(std::max<long>(left.count(), 0)));
    if (count >= 0 || errno != EINTR) return count > 0;
  }
}

bool isGone(int socket) {
  char next = 0;
  const ssize_t count = ::recv(socket, &next, 1, MSG_PEEK | MSG_DONTWAIT);
  return count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
}

}  // namespace

ClientStream::ClientStream(int socket, const Limit& limit)
    : socket_(socket), limit_(limit), end_(Clock::now() + limit.request) {}

bool ClientStream::is_readable() const { return begin_ < filled_ || waitFor(socket_, POLLIN, end_); }

bool ClientStream::is_writable() const {
  return waitFor(socket_, POLLOUT, Clock::now() + limit_.write) && !isGone(socket_);
}

ssize_t ClientStream::read(char* to, std::size_t size) {
  if (begin_ == filled_)
    if (const ssize_t count = fill(); count <= 0) return count;
  const std::size_t count = std::min(size, filled_ - begin_);
  std::copy_n(buffer_.data() + begin_, count, to);
  begin_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t ClientStream::fill() {
  const std::size_t room = std::min(buffer_.size(), limit_.request_bytes - received_bytes_);
  if (room == 0 || Clock::now() >= end_ || !waitFor(socket_, POLLIN, end_)) return -1;
  const ssize_t count = ::recv(socket_, buffer_.data(), room, MSG_DONTWAIT);
  if (count <= 0) return count;
  begin_ = 0;
  filled_ = static_cast<std::size_t>(count);
  received_bytes_ += filled_;
  return count;
}

ssize_t ClientStream::write(const char* from, std::size_t size) {
  if (!is_writable()) return -1;
  const ssize_t count = ::send(socket_, from, size, MSG_DONTWAIT | MSG_NOSIGNAL);
  return count < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : count;
}

}  // namespace strainfinger::live
