#include "host/can/socketcan_port.hpp"

#include <fmt/format.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include "host/base/excerpt.hpp"
#include "host/base/failure.hpp"

namespace strainfinger::can {
namespace {

using hal::CanState;

/// What one call looks at before it returns, so that a flood can't hold it. Read once in BusPort::kGather, it
/// is more than a bus has.
constexpr int kMaxReads = 256;

/// Below the kernel's minimum, which it takes in its place: 4,608 bytes, six or seven frames of 768
/// (Linux 6.1).
constexpr int kSendBuffer_bytes = 0;

constexpr int kOn = 1, kOff = 0;

/// Standard data frames, of these identifiers.
constexpr can_filter kernelFilter(BusFilter filter) {
  return {.can_id = filter.id, .can_mask = filter.mask | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

/// Frames of all formats.
constexpr can_filter kEverything{};

constexpr can_err_mask_t kStateAndCounters =
    CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CNT;

int bindTo(SocketCalls& calls, int socket, const std::string& interface) {
  const int index = calls.interfaceIndex(socket, interface);
  if (index < 0) return index;
  const int result = calls.bind(socket, index);
  return result == -ENODEV ? -EMEDIUMTYPE : result;  // there, but not CAN
}

int setUp(SocketCalls& calls, int socket, std::span<const can_filter> filters, can_err_mask_t errors) {
  const auto filterSize = static_cast<socklen_t>(filters.size_bytes());
  int result = calls.setOption(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), filterSize);
  if (result >= 0) result = calls.setOption(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
  if (result >= 0) result = calls.setOption(socket, SOL_SOCKET, SO_RXQ_OVFL, &kOn, sizeof kOn);
  if (result >= 0) result = calls.setOption(socket, SOL_SOCKET, SO_TIMESTAMPNS, &kOn, sizeof kOn);
  if (result >= 0)
    result = calls.setOption(socket, SOL_SOCKET, SO_SNDBUF, &kSendBuffer_bytes, sizeof kSendBuffer_bytes);
  return result;
}

/// A socket bound to the interface, or -errno.
int openSocket(SocketCalls& calls, const std::string& interface, std::span<const can_filter> filters,
               can_err_mask_t errors) {
  const int socket = calls.open();
  if (socket < 0) return socket;
  int result = setUp(calls, socket, filters, errors);
  if (result >= 0) result = bindTo(calls, socket, interface);
  if (result >= 0) return socket;
  calls.close(socket);
  return result;
}

std::string creationCommand(const std::string& interface, int bitrate) {
  const std::string bringUp = bringUpCommand(interface, bitrate);
  if (interface.starts_with("vcan"))
    return fmt::format("make it with `sudo ip link add dev {} type vcan && {}`", interface, bringUp);
  if (interface.starts_with("slcan"))
    return fmt::format("make it with `sudo slcand -o -c -s8 -S 115200 /dev/ttyACM0 {} && {}`", interface,
                       bringUp);
  return fmt::format("plug the adapter in, then `{}`; `ip -br link` lists the interfaces there are", bringUp);
}

/// Why opening failed (-errno) and what to do about it.
Failure openingFailure(const std::string& interface, int bitrate, int error) {
  const auto failure = [](const std::string& text) { return Failure(ExitCode::kNoInterface, text); };
  switch (-error) {
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return failure(fmt::format(
          "cannot open {}: this kernel has no CAN sockets; `sudo modprobe can_raw` loads them where the "
          "kernel was built with CAN, and --can udp is a bus that needs none",
          interface));
    case ENODEV:
      return failure(fmt::format("no CAN interface {}: {}", interface, creationCommand(interface, bitrate)));
    case ENETDOWN:
      return failure(fmt::format("CAN interface {} is down: bring it up with `{}`", interface,
                                 bringUpCommand(interface, bitrate)));
    case EMEDIUMTYPE:
      return failure(fmt::format(
          "{} is not a CAN interface: `ip -br link show type can` lists those there are (`type vcan`: "
          "the virtual ones)",
          interface));
    case EPERM:
    case EACCES:
      return failure(
          fmt::format("cannot open {}: no permission for CAN sockets; run it with sudo", interface));
    default:
      return failure(fmt::format("cannot open {}: {}", interface, std::strerror(-error)));
  }
}

CanState controllerState(std::uint8_t flags, CanState before) {
  if (flags & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) return CanState::kPassive;
  if (flags & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) return CanState::kWarning;
  return flags & CAN_ERR_CRTL_ACTIVE ? CanState::kActive : before;
}

CanState stateAfter(const canfd_frame& error, CanState before) {
  if (error.can_id & CAN_ERR_BUSOFF) return CanState::kBusOff;
  if (error.can_id & CAN_ERR_RESTARTED) return CanState::kActive;
  return error.can_id & CAN_ERR_CRTL ? controllerState(error.data[1], before) : before;
}

can_frame toKernel(const CanFrame& frame) {
  can_frame raw{};
  raw.can_id = frame.id;
  raw.len = frame.length;
  std::copy_n(frame.data.begin(), frame.length, raw.data);
  return raw;
}

/// The frame, if it is one that the firmware can have.
std::optional<CanFrame> fromKernel(int size, const canfd_frame& raw) {
  CanFrame frame;
  if (size != CAN_MTU || (raw.can_id & ~CAN_SFF_MASK) != 0 || raw.len > frame.data.size())
    return std::nullopt;
  frame.id = static_cast<std::uint16_t>(raw.can_id);
  frame.length = raw.len;
  std::copy_n(raw.data, raw.len, frame.data.begin());
  return frame;
}

/// The frame, if it is of another format.
std::optional<OtherFrame> otherFromKernel(int size, const canfd_frame& raw, std::int64_t time_ns) {
  OtherFrame other{.time_ns = time_ns, .isRemote = (raw.can_id & CAN_RTR_FLAG) != 0, .frame = {}};
  LoggedFrame& frame = other.frame;
  frame.fd = size == CANFD_MTU;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.id = raw.can_id & CAN_EFF_MASK;
  frame.length = raw.len;
  frame.fdFlags = frame.fd ? raw.flags & 0xF : 0;
  const bool isWhole = frame.fd ? raw.len <= CANFD_MAX_DLEN : size == CAN_MTU && raw.len <= CAN_MAX_DLEN;
  const bool isOther = frame.fd || frame.extended || other.isRemote;
  if (!isWhole || !isOther || (raw.can_id & CAN_ERR_FLAG) || (!frame.extended && frame.id > CAN_SFF_MASK))
    return std::nullopt;
  if (!other.isRemote) std::copy_n(raw.data, raw.len, frame.data.begin());
  return other;
}

}  // namespace

std::string bringUpCommand(const std::string& interface, int bitrate) {
  if (interface.starts_with("vcan") || interface.starts_with("slcan"))
    return fmt::format("sudo ip link set {} up", interface);
  return fmt::format("sudo ip link set {} up type can bitrate {} restart-ms 100", interface, bitrate);
}

SocketCanPort::SocketCanPort(std::string interface, int bitrate, BusFilter filter, SocketCalls& calls)
    : interface_(std::move(interface)), filter_(filter), calls_(calls) {
  if (interface_.empty() || interface_.size() >= IFNAMSIZ)
    throw Failure(ExitCode::kNoInterface, fmt::format("no CAN interface '{}': a name has 1 to {} characters",
                                                      excerpt(interface_), IFNAMSIZ - 1));
  const int error = open();
  if (error < 0) throw openingFailure(interface_, bitrate, error);
  if (status_.state != CanState::kDown) return;
  close();
  throw openingFailure(interface_, bitrate, -ENETDOWN);
}

SocketCanPort::~SocketCanPort() { close(); }

bool SocketCanPort::send(const CanFrame& frame) noexcept {
  refresh();
  const bool open = status_.state != CanState::kDown && status_.state != CanState::kBusOff;
  int written = -EAGAIN;
  if (open && isValid(frame)) {
    const can_frame raw = toKernel(frame);
    do {
      written = calls_.write(frames_, raw);
    } while (written == -EINTR);
  }
  const bool taken = written == sizeof(can_frame);
  if (!taken) ++refused_;
  return taken;
}

std::optional<TimedFrame> SocketCanPort::receiveTimed() noexcept {
  if (frames_ < 0) refresh();
  for (int reads = 0; reads < kMaxReads; ++reads) {
    canfd_frame raw{};
    ReceiveNotes notes{lostInQueue_};
    const int size = calls_.read(frames_, raw, notes);
    if (size == -EINTR) continue;
    if (size < 0) {
      if (size != -EAGAIN) refresh();
      return std::nullopt;
    }
    lostInQueue_ = notes.lost;
    if (const auto frame = fromKernel(size, raw)) return TimedFrame{notes.time_ns, *frame};
    if (!giveOther(size, raw, notes.time_ns)) ++lostElsewhere_;
  }
  return std::nullopt;
}

bool SocketCanPort::giveOther(int size, const canfd_frame& raw, std::int64_t time_ns) noexcept {
  if (!tap_) return false;
  const auto other = otherFromKernel(size, raw, time_ns);
  if (other) tap_(*other);
  return other.has_value();
}

void SocketCanPort::hearOthers(OtherTap tap) noexcept {
  tap_ = std::move(tap);
  if (frames_ >= 0) setFilter();
}

/// Beyond what a new socket hears. Without FD the kernel has no such frames: nothing is lost by its refusal.
void SocketCanPort::setFilter() noexcept {
  const bool hearsOthers = tap_ && filter_.mask == 0;
  const can_filter wanted = hearsOthers ? kEverything : kernelFilter(filter_);
  calls_.setOption(frames_, SOL_CAN_RAW, CAN_RAW_FILTER, &wanted, sizeof wanted);
  calls_.setOption(frames_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, hearsOthers ? &kOn : &kOff, sizeof kOn);
}

hal::CanStatus SocketCanPort::status() noexcept {
  refresh();
  status_.missed = lostInQueue_ + lostElsewhere_;
  return status_;
}

BusHints SocketCanPort::hints() const {
  return {.whenBlocked = fmt::format("it is down, bus-off, nobody acknowledges or its queue is full; `ip "
                                     "-details -statistics link show {}` shows which",
                                     interface_),
          .whenSilent = "is it on the bus, with this bit rate and node number?"};
}

bool SocketCanPort::waitReadable(std::chrono::milliseconds timeout) noexcept {
  return calls_.poll(frames_, static_cast<int>(timeout.count())) > 0;
}

int SocketCanPort::open() noexcept {
  const can_filter wanted = kernelFilter(filter_);
  frames_ = openSocket(calls_, interface_, {&wanted, 1}, 0);
  if (frames_ < 0) return std::exchange(frames_, -1);
  errors_ = openSocket(calls_, interface_, {}, kStateAndCounters);
  if (errors_ < 0) {
    calls_.close(std::exchange(frames_, -1));
    return std::exchange(errors_, -1);
  }
  if (tap_) setFilter();
  noteFlags();
  return 0;
}

void SocketCanPort::close() noexcept {
  if (frames_ >= 0) calls_.close(std::exchange(frames_, -1));
  if (errors_ >= 0) calls_.close(std::exchange(errors_, -1));
  lostElsewhere_ += std::exchange(lostInQueue_, 0);
  noteDown();
}

/// Brings `status_` up to date, and the port back to life where it can be.
void SocketCanPort::refresh() noexcept {
  if (frames_ < 0 && open() < 0) return;
  readErrorFrames();
  if (frames_ >= 0 && status_.state == CanState::kDown) noteFlags();
}

void SocketCanPort::readErrorFrames() noexcept {
  ReceiveNotes notes;
  for (int reads = 0; reads < kMaxReads; ++reads) {
    canfd_frame frame{};
    const int size = calls_.read(errors_, frame, notes);
    if (size == CAN_MTU && frame.len == CAN_ERR_DLC) noteErrorFrame(frame);
    if (size == -ENETDOWN) noteDown();
    if (size == -EAGAIN) return;
    if (size < 0 && size != -ENETDOWN && size != -EINTR) return close();
  }
}

void SocketCanPort::noteErrorFrame(const canfd_frame& frame) noexcept {
  if (frame.can_id & CAN_ERR_TX_TIMEOUT) ++status_.dropped;
  if ((frame.can_id & CAN_ERR_CRTL) && (frame.data[1] & CAN_ERR_CRTL_RX_OVERFLOW)) ++lostElsewhere_;
  if (status_.state == CanState::kDown) return;  // said before the interface went down
  if (frame.can_id & CAN_ERR_BUSOFF) ++status_.busOffs;
  status_.state = stateAfter(frame, status_.state);
  if (frame.can_id & CAN_ERR_CNT) {
    status_.txErrors = frame.data[6];
    status_.rxErrors = frame.data[7];
  }
}

void SocketCanPort::noteDown() noexcept {
  if (status_.state != CanState::kDown) ++status_.busOffs;
  status_.state = CanState::kDown;
  status_.txErrors.reset();
  status_.rxErrors.reset();
}

/// The state when nothing else is known: after opening, and until the interface is up again.
void SocketCanPort::noteFlags() noexcept {
  const int flags = calls_.interfaceFlags(frames_, interface_);
  const bool up = flags >= 0 && (flags & IFF_UP);
  const bool carrier = up && (flags & IFF_RUNNING);
  status_.state = carrier ? CanState::kActive : up ? CanState::kBusOff : CanState::kDown;
}

}  // namespace strainfinger::can
