#include "host/can/udp_port.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"
#include "host/base/parse_number.hpp"
#include "host/can/receive_notes.hpp"

namespace strainfinger::can {
namespace {

constexpr std::string_view kUdp = "udp";
constexpr std::uint8_t kDatagramVersion = 1;
constexpr std::size_t kHeader_bytes = 4;
constexpr int kLeastPort = 1024;
constexpr int kMostPort = 65535;
/// One of the addresses that stay within an organisation (RFC 2365); on the loopback interface it stays
/// within the machine.
constexpr const char* kGroup = "239.255.67.65";

/// As far as the system allows (net.core.rmem_max), and Linux takes twice the number: a second of a full bus
/// of 9,000 frames a second, each of which takes 768 bytes (Linux 6.1).
constexpr int kReceiveBuffer_bytes = 4 << 20;

/// What one call looks at before it returns, so that a flood can't hold it.
constexpr int kMostDatagrams = 64;

std::uint16_t portOf(std::string_view name) {
  if (name == kUdp) return UdpPort::kDefaultPort;
  const std::string_view digits = isUdpName(name) ? name.substr(kUdp.size() + 1) : "";
  const auto port = parseNumber<int>(digits);
  if (port && *port >= kLeastPort && *port <= kMostPort) return static_cast<std::uint16_t>(*port);
  throw Failure(ExitCode::kUsage, fmt::format("{} is no bus: udp, or udp:PORT with a port from {} to {}",
                                              excerpt(name), kLeastPort, kMostPort));
}

sockaddr_in addressOf(const char* host, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, host, &address.sin_addr);
  return address;
}

in_addr loopbackAddress() { return addressOf("127.0.0.1", 0).sin_addr; }

/// Throws Failure when the call that gave `result` failed.
int require(int result, const char* what) {
  if (result >= 0) return result;
  throw Failure(ExitCode::kNoInterface,
                fmt::format("cannot open a bus on UDP: {}: {}; it needs IPv4 on the loopback interface: "
                            "`ip address show lo`",
                            what, std::strerror(errno)));
}

template <typename Value>
void setUdpOption(int socket, int level, int name, const Value& value, const char* what) {
  require(::setsockopt(socket, level, name, &value, sizeof value), what);
}

void bindUdp(int socket, const sockaddr_in& address, const char* what) {
  require(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), what);
}

std::uint16_t portOfSocket(int socket) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  require(::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size), "getsockname");
  return ntohs(address.sin_port);
}

/// Lets the kernel leave out what this port sent itself and what its filter doesn't want, both of which it
/// counts as lost. The program's offsets count from the UDP header, whose first two bytes are the sender's
/// port.
void attachFilter(int socket, std::uint16_t own, BusFilter filter) {
  constexpr std::uint32_t kUdpHeader_bytes = 8, kIdOffset_bytes = kUdpHeader_bytes + 1, kWhole = 0xFFFF;
  std::array program{
      sock_filter BPF_STMT(BPF_LD | BPF_H | BPF_ABS, 0),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, own, 3, 0),
      sock_filter BPF_STMT(BPF_LD | BPF_H | BPF_ABS, kIdOffset_bytes),
      sock_filter BPF_STMT(BPF_ALU | BPF_AND | BPF_K, filter.mask),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, std::uint32_t{filter.id} & filter.mask, 1, 0),
      sock_filter BPF_STMT(BPF_RET | BPF_K, 0),
      sock_filter BPF_STMT(BPF_RET | BPF_K, kWhole),
  };
  const sock_fprog attached{static_cast<unsigned short>(program.size()), program.data()};
  setUdpOption(socket, SOL_SOCKET, SO_ATTACH_FILTER, attached, "SO_ATTACH_FILTER");
}

int newUdpSocket() {
  return require(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0), "socket");
}

}  // namespace

bool isUdpName(std::string_view name) { return name.substr(0, name.find(':')) == kUdp; }

std::vector<std::uint8_t> toDatagram(const CanFrame& frame) {
  std::vector<std::uint8_t> datagram(kHeader_bytes + frame.length);
  datagram[0] = kDatagramVersion;
  datagram[1] = static_cast<std::uint8_t>(frame.id >> 8);
  datagram[2] = static_cast<std::uint8_t>(frame.id);
  datagram[3] = frame.length;
  std::copy_n(frame.data.begin(), frame.length, datagram.begin() + kHeader_bytes);
  return datagram;
}

std::optional<CanFrame> fromDatagram(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kHeader_bytes || datagram[0] != kDatagramVersion) return std::nullopt;
  CanFrame frame{static_cast<std::uint16_t>(datagram[1] << 8 | datagram[2]), datagram[3], {}};
  const auto data = datagram.subspan(kHeader_bytes);
  if (!isValid(frame) || data.size() != frame.length) return std::nullopt;
  std::ranges::copy(data, frame.data.begin());
  return frame;
}

UdpPort::UdpPort(std::string name, BusFilter filter) : name_(std::move(name)), port_(portOf(name_)) {
  try {
    open(filter);
  } catch (...) {
    close();
    throw;
  }
}

UdpPort::~UdpPort() { close(); }

void UdpPort::open(BusFilter filter) {
  constexpr int kOn = 1;
  constexpr std::uint8_t kWithinMachine = 0;
  speaks_ = newUdpSocket();
  bindUdp(speaks_, addressOf("127.0.0.1", 0), "binding to 127.0.0.1");
  setUdpOption(speaks_, IPPROTO_IP, IP_MULTICAST_IF, loopbackAddress(), "IP_MULTICAST_IF");
  setUdpOption(speaks_, IPPROTO_IP, IP_MULTICAST_TTL, kWithinMachine, "IP_MULTICAST_TTL");
  ownPort_ = portOfSocket(speaks_);
  hears_ = newUdpSocket();
  hearsAll_ = filter.mask == 0;
  if (!hearsAll_) attachFilter(hears_, ownPort_, filter);
  setUdpOption(hears_, SOL_SOCKET, SO_REUSEADDR, kOn, "SO_REUSEADDR");
  setUdpOption(hears_, SOL_SOCKET, SO_RCVBUF, kReceiveBuffer_bytes, "SO_RCVBUF");
  setUdpOption(hears_, SOL_SOCKET, SO_RXQ_OVFL, kOn, "SO_RXQ_OVFL");
  setUdpOption(hears_, SOL_SOCKET, SO_TIMESTAMPNS, kOn, "SO_TIMESTAMPNS");
  bindUdp(hears_, addressOf(kGroup, port_), "binding to its port");
  const ip_mreq group{addressOf(kGroup, 0).sin_addr, loopbackAddress()};
  setUdpOption(hears_, IPPROTO_IP, IP_ADD_MEMBERSHIP, group, "IP_ADD_MEMBERSHIP");
}

void UdpPort::close() noexcept {
  if (hears_ >= 0) ::close(std::exchange(hears_, -1));
  if (speaks_ >= 0) ::close(std::exchange(speaks_, -1));
}

bool UdpPort::send(const CanFrame& frame) noexcept {
  if (!isValid(frame)) return false;
  const auto datagram = toDatagram(frame);
  const sockaddr_in group = addressOf(kGroup, port_);
  const auto sent = ::sendto(speaks_, datagram.data(), datagram.size(), 0,
                             reinterpret_cast<const sockaddr*>(&group), sizeof group);
  return sent == static_cast<ssize_t>(datagram.size());
}

std::optional<TimedFrame> UdpPort::receiveTimed() noexcept {
  // One byte more than a frame needs, to tell what is too long.
  std::array<std::uint8_t, kHeader_bytes + CanFrame{}.data.size() + 1> datagram;
  for (int read = 0; read < kMostDatagrams; ++read) {
    ReceiveNotes notes{missed_};
    const auto size = receiveWithNotes(hears_, datagram.data(), datagram.size(), notes);
    if (size == -EINTR) continue;
    if (size < 0) return std::nullopt;
    if (notes.senderPort == ownPort_) continue;
    if (hearsAll_) missed_ = notes.lost;
    if (const auto frame = fromDatagram(std::span(datagram).first(static_cast<std::size_t>(size))))
      return TimedFrame{notes.time_ns, *frame};
    ++malformed_;
  }
  return std::nullopt;
}

hal::CanStatus UdpPort::status() noexcept { return {.state = hal::CanState::kActive, .missed = missed_}; }

BusHints UdpPort::hints() const {
  return {
      .whenBlocked = "the loopback interface has no IPv4 or is down; `ip address show lo` shows it",
      .whenSilent = fmt::format(
          "does it run (`strainfinger run --can {} -c FINGER.toml`; can.node in that config is its number)?",
          name_)};
}

bool UdpPort::waitReadable(std::chrono::milliseconds timeout) noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + timeout;
  pollfd waiting{hears_, POLLIN, 0};
  while (::poll(&waiting, 1, static_cast<int>(timeout.count())) > 0) {
    if (!passOverOwn()) return true;
    timeout =
        std::chrono::ceil<std::chrono::milliseconds>(std::max(end - Clock::now(), Clock::duration::zero()));
  }
  return false;
}

bool UdpPort::passOverOwn() noexcept {
  sockaddr_in sender{};
  socklen_t size = sizeof sender;
  std::uint8_t first = 0;
  const auto peeked =
      ::recvfrom(hears_, &first, sizeof first, MSG_PEEK, reinterpret_cast<sockaddr*>(&sender), &size);
  if (peeked < 0 || ntohs(sender.sin_port) != ownPort_) return false;
  return ::recv(hears_, &first, sizeof first, 0) >= 0;
}

}  // namespace strainfinger::can
