#include "host/can/receive_notes.hpp"

#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <ctime>

#include "host/base/utc_text.hpp"

namespace strainfinger::can {
namespace {

void readNote(cmsghdr& note, ReceiveNotes& notes) {
  if (note.cmsg_level != SOL_SOCKET) return;
  if (note.cmsg_type == SO_RXQ_OVFL) std::memcpy(&notes.lost, CMSG_DATA(&note), sizeof notes.lost);
  if (note.cmsg_type != SCM_TIMESTAMPNS) return;
  std::timespec time{};
  std::memcpy(&time, CMSG_DATA(&note), sizeof time);
  notes.time_ns = time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

}  // namespace

int receiveWithNotes(int socket, void* data, std::size_t size, ReceiveNotes& notes) noexcept {
  iovec part{data, size};
  alignas(cmsghdr) std::byte control[CMSG_SPACE(sizeof notes.lost) + CMSG_SPACE(sizeof(std::timespec))];
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  sockaddr_in sender{};
  message.msg_name = &sender;
  message.msg_namelen = sizeof sender;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const auto read = ::recvmsg(socket, &message, 0);
  if (read < 0) return -errno;
  notes.time_ns = 0;
  for (cmsghdr* note = CMSG_FIRSTHDR(&message); note != nullptr; note = CMSG_NXTHDR(&message, note))
    readNote(*note, notes);
  notes.senderPort = sender.sin_family == AF_INET ? ntohs(sender.sin_port) : std::uint16_t{0};
  if (notes.time_ns == 0) notes.time_ns = now_ns();
  return static_cast<int>(read);
}

}  // namespace strainfinger::can
