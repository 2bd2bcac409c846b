#pragma once
// A CAN port that is a serial line to somebody who has a CAN controller, or to Linux's slcan driver.

#include <array>
#include <concepts>
#include <cstdint>

#include "firmware/app/slcan.hpp"
#include "hal/can_port.hpp"

namespace strainfinger::firmware {

/// A serial line: put() takes a byte or says "not now", get() gives one if there is one. Neither waits.
// clang-format off
template <typename T>
concept SerialLine = requires(T line, std::uint8_t byte) {
  { line.put(byte) } noexcept -> std::same_as<bool>;
  { line.get() } noexcept -> std::same_as<std::optional<std::uint8_t>>;
};
// clang-format on

/// hal::CanPort over SLCAN. The port is down until the host opens it, unless it was open
/// before a restart that the host knows nothing of. Everything is done by whoever calls:
/// the line is moved on by every call, and by poll() when there is nothing else to do. Nothing is read from
/// the line while a frame or an answer waits, so that nothing is lost either way.
template <SerialLine Line>
class SlcanPort {
 public:
  explicit constexpr SlcanPort(Line& line, bool open = false) : line_(line), open_(open) {
    if (open) queue("\r");  // ends the line that the restart cut off
  }

  bool send(const CanFrame& frame) noexcept {
    poll();
    if (!isValid(frame) || !canSend() || room() < SlcanText::kLongest) return false;
    queue(slcanFrame(frame).view());
    poll();
    return true;
  }

  std::optional<CanFrame> receive() noexcept {
    poll();
    const auto frame = arrived_;
    arrived_.reset();
    return frame;
  }

  hal::CanStatus status() const noexcept {
    if (!open_) return {};
    return bus_;
  }

  /// The bus behind the line is now like this: told to the host, and send() acts on it.
  void setBus(const hal::CanStatus& bus) noexcept {
    const bool leaves = bus.state == hal::CanState::kBusOff && bus_.state != bus.state;
    const std::uint32_t busOffs = bus_.busOffs + (leaves ? 1 : 0);
    bus_ = bus;
    bus_.busOffs = busOffs;
    if (open_ && room() >= SlcanText::kLongest) queue(slcanState(bus).view());
  }

  /// Writes what the line takes, reads what it has.
  void poll() noexcept {
    flush();
    while (!arrived_ && room() >= SlcanText::kLongest) {
      const auto byte = line_.get();
      if (!byte) break;
      if (const auto line = reader_.take(static_cast<char>(*byte))) obey(slcanCommand(*line));
    }
    flush();
  }

  /// A frame waits for receive().
  bool hasArrived() const noexcept { return arrived_.has_value(); }

  /// Everything taken has gone out.
  bool idle() const noexcept { return used_ == 0; }

 private:
  static constexpr std::size_t kCapacity = 256;  ///< ten frames

  bool canSend() const {
    return open_ && bus_.state != hal::CanState::kBusOff && bus_.state != hal::CanState::kDown;
  }
  std::size_t room() const { return kCapacity - used_; }

  void queue(std::string_view text) {
    for (const char character : text) {
      waiting_[(first_ + used_) % kCapacity] = static_cast<std::uint8_t>(character);
      ++used_;
    }
  }

  void flush() {
    for (; used_ != 0 && line_.put(waiting_[first_]); --used_) first_ = (first_ + 1) % kCapacity;
  }

  void obey(const SlcanCommand& command) {
    using Kind = SlcanCommand::Kind;
    const bool deaf = command.kind == Kind::kFrame && !canSend();
    if (command.kind == Kind::kOpen) open_ = true;
    if (command.kind == Kind::kClose) open_ = false;
    if (command.kind == Kind::kFrame && !deaf) arrived_ = command.frame;
    queue(slcanAnswer(deaf ? Kind::kUnknown : command.kind));
  }

  Line& line_;
  SlcanReader reader_;
  hal::CanStatus bus_{.state = hal::CanState::kActive, .txErrors = 0, .rxErrors = 0};
  std::optional<CanFrame> arrived_;
  std::array<std::uint8_t, kCapacity> waiting_{};
  std::size_t first_ = 0;
  std::size_t used_ = 0;
  bool open_;
};

}  // namespace strainfinger::firmware
