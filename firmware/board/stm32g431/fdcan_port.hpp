#pragma once
// hal::CanPort on FDCAN1: RM0440 chapter 44. Nothing here waits for the bus, and no interrupt is used.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/board/stm32g431/bit_timing.hpp"
#include "firmware/board/stm32g431/registers/clocks.hpp"
#include "firmware/board/stm32g431/registers/fdcan.hpp"
#include "hal/can_port.hpp"
#include "hal/clock.hpp"

namespace strainfinger::stm32g431 {

/// How frames of an identifier share the three TX buffers.
struct SendRule {
  /// A frame replaces one of the same identifier that still waits; otherwise it is refused meanwhile.
  bool newestWins = false;
  /// All such identifiers together have one buffer, so that they never stand in the way of the others. One
  /// that has waited there for kOldest_us makes room for another.
  bool background = false;
};

struct FdcanSettings {
  BitTiming timing;
  /// With it, CAN FD frames of others pass unhurt (and unread); without it they are taken for errors.
  std::optional<BitTiming> dataTiming{};
  /// Identifiers to receive, at most 2 * MessageRam::standardFilters; none: all.
  std::span<const std::uint16_t> listensTo{};
};

/// Contract: hal/can_port.hpp. A frame that made room for another counts as dropped.
///
/// Of each identifier at most one frame is in the controller; between identifiers the lowest goes first.
/// poll() is to be called at least every three shortest frame times that listensTo lets through (send and
/// receive call it too), else frames are lost and counted in `missed`; one request at a time is safe.
///
/// Bus-off: what waits is dropped, and the controller goes back on the bus (129 * 11 recessive bits) at once;
/// if that ends in bus-off again before a frame got through, after 10, 100, then every 1000 ms.
template <RegisterBus Bus, hal::Clock Clock, SendRule (*kRuleOf)(std::uint16_t id)>
class FdcanPort {
 public:
  /// Without it a frame that nobody acknowledges, which never ends in bus-off, would go out minutes later.
  static constexpr std::uint32_t kOldest_us = 400'000;

  FdcanPort(Bus bus, const Clock& clock) : bus_(bus), clock_(clock) {}

  /// RM0440 section 44.3.2, software initialization. False: the controller doesn't answer.
  [[nodiscard]] bool start(const FdcanSettings& settings) noexcept {
    enableClock(bus_, Rcc::Apb1Enr1::fdcan(1));
    modify(bus_, Cccr::init(1));
    if (!waitFor(bus_, Cccr::init, 1, kSyncPolls)) return false;
    configure(settings);
    started_ = goOnBus();
    return started_;
  }

  bool send(const CanFrame& frame) noexcept {
    if (!isValid(frame) || !started_) return false;
    poll();
    if (isOffBus() || !makeRoomFor(frame.id) || get(bus_, Fdcan::Txfqs::full) != 0) return false;
    load(get(bus_, Fdcan::Txfqs::putIndex), frame);
    return true;
  }

  std::optional<CanFrame> receive() noexcept {
    poll();
    if (received_ == 0) return std::nullopt;
    const CanFrame frame = ring_[oldest_];
    oldest_ = (oldest_ + 1) % ring_.size();
    --received_;
    return frame;
  }

  hal::CanStatus status() noexcept {
    poll();
    if (!started_) return {};
    const std::uint32_t errors = bus_.read(Fdcan::Ecr::address);
    const bool rxPassive = Fdcan::Ecr::rxPassive.in(errors) != 0;
    return {.state = state(),
            .txErrors = static_cast<std::uint8_t>(Fdcan::Ecr::txErrors.in(errors)),
            .rxErrors = static_cast<std::uint8_t>(rxPassive ? 128 : Fdcan::Ecr::rxErrors.in(errors)),
            .dropped = dropped_,
            .missed = missed_,
            .busOffs = busOffs_};
  }

  /// Takes what has arrived out of the controller, notes what has been sent, sees to bus-off.
  void poll() noexcept {
    if (!started_) return;
    takeReceived();
    retire();
    recover();
  }

 private:
  using Cccr = Fdcan::Cccr;
  static constexpr std::uint8_t kBuffers = MessageRam::elements;
  static constexpr std::uint16_t kNobody = 0xFFFF;
  /// init shows after two cycles of the slower of both clocks; 24 MHz is 8 of the processor's. Plenty.
  static constexpr std::uint32_t kSyncPolls = 1000;
  /// A cancellation shows within a few cycles, unless the frame is on its way.
  static constexpr std::uint32_t kCancelPolls = 16;
  static constexpr std::array<std::uint32_t, 4> kBackOff_us{0, 10'000, 100'000, 1'000'000};

  void configure(const FdcanSettings& settings) noexcept {
    modify(bus_, Cccr::configurable(1));
    const bool fd = settings.dataTiming.has_value();
    modify(bus_, Cccr::fd(fd) | Cccr::bitRateSwitch(fd));
    const BitTiming& timing = settings.timing;
    write(bus_, Fdcan::Nbtp::prescaler(timing.prescaler - 1U) | Fdcan::Nbtp::segment1(timing.segment1 - 1U) |
                    Fdcan::Nbtp::segment2(timing.segment2 - 1U) | Fdcan::Nbtp::jump(timing.jump - 1U));
    if (fd) configureData(*settings.dataTiming);
    write(bus_, Fdcan::Txbc::queue(1));
    setFilters(settings.listensTo);
  }

  void configureData(const BitTiming& timing) noexcept {
    write(bus_, Fdcan::Dbtp::prescaler(timing.prescaler - 1U) | Fdcan::Dbtp::segment1(timing.segment1 - 1U) |
                    Fdcan::Dbtp::segment2(timing.segment2 - 1U) | Fdcan::Dbtp::jump(timing.jump - 1U));
  }

  /// Two identifiers a filter; an odd last one is there twice.
  void setFilters(std::span<const std::uint16_t> ids) noexcept {
    std::uint32_t filters = 0;
    for (std::size_t i = 0; i < ids.size() && filters < MessageRam::standardFilters; i += 2, ++filters) {
      const std::uint16_t second = ids[std::min(i + 1, ids.size() - 1)];
      bus_.write(MessageRam::filter(filters), (StandardFilter::type(StandardFilter::kEither) |
                                               StandardFilter::action(StandardFilter::kToFifo0) |
                                               StandardFilter::id1(ids[i]) | StandardFilter::id2(second))
                                                  .value);
    }
    using Rxgfc = Fdcan::Rxgfc;
    write(bus_, Rxgfc::rejectExtendedRemote(1) | Rxgfc::rejectStandardRemote(1) |
                    Rxgfc::otherExtended(Fdcan::kReject) |
                    Rxgfc::otherStandard(ids.empty() ? Fdcan::kToFifo0 : Fdcan::kReject) |
                    Rxgfc::standardCount(filters));
  }

  bool goOnBus() noexcept {
    modify(bus_, Cccr::init(0) | Cccr::configurable(0));
    return waitFor(bus_, Cccr::init, 0, kSyncPolls);
  }

  bool isOffBus() noexcept { return get(bus_, Cccr::init) != 0 || get(bus_, Fdcan::Psr::busOff) != 0; }

  hal::CanState state() noexcept {
    const std::uint32_t status = bus_.read(Fdcan::Psr::address);
    if (Fdcan::Psr::busOff.in(status) != 0) return hal::CanState::kBusOff;
    if (Fdcan::Psr::passive.in(status) != 0) return hal::CanState::kPassive;
    return Fdcan::Psr::warning.in(status) != 0 ? hal::CanState::kWarning : hal::CanState::kActive;
  }

  /// False: the frame has to wait for one of the same identifier, or for another in the background. One that
  /// replaces another is as old as that, lest what is said again and again has the background for itself.
  bool makeRoomFor(std::uint16_t id) noexcept {
    const SendRule rule = kRuleOf(id);
    for (std::uint8_t buffer = 0; buffer < kBuffers; ++buffer) {
      const std::uint16_t other = waiting_[buffer];
      if (other == id) return rule.newestWins && cancel(buffer);
      if (other == kNobody || !rule.background || !kRuleOf(other).background) continue;
      if (clock_.now_us() - since_us_ < kOldest_us || !cancel(buffer)) return false;
    }
    if (rule.background) since_us_ = clock_.now_us();
    return true;
  }

  /// False: it is on the wire and can't be taken back.
  bool cancel(std::uint8_t buffer) noexcept {
    bus_.write(Fdcan::Txbcr::address, 1U << buffer);
    for (std::uint32_t polls = kCancelPolls; polls > 0 && waiting_[buffer] != kNobody; --polls) retire();
    return waiting_[buffer] == kNobody;
  }

  void load(std::uint32_t buffer, const CanFrame& frame) noexcept {
    const std::uint32_t element = MessageRam::tx(buffer);
    bus_.write(element, Element0::standardId(frame.id).value);
    bus_.write(element + 4, Element1::length(frame.length).value);
    for (std::uint32_t i = 0; i < 8; i += 4) {
      const auto byte = [&](std::uint32_t at) { return std::uint32_t{frame.data[i + at]} << 8 * at; };
      bus_.write(element + 8 + i, byte(0) | byte(1) | byte(2) | byte(3));
    }
    waiting_[buffer] = frame.id;
    bus_.write(Fdcan::Txbar::address, 1U << buffer);
  }

  /// Frees the buffers whose frames are sent or cancelled.
  void retire() noexcept {
    const std::uint32_t pending = bus_.read(Fdcan::Txbrp::address);
    const std::uint32_t sent = bus_.read(Fdcan::Txbto::address);
    for (std::uint8_t buffer = 0; buffer < kBuffers; ++buffer) {
      if (waiting_[buffer] == kNobody || (pending >> buffer & 1) != 0) continue;
      waiting_[buffer] = kNobody;
      if ((sent >> buffer & 1) != 0)
        attempt_ = 0;
      else
        ++dropped_;
    }
  }

  void takeReceived() noexcept {
    for (std::uint32_t level = get(bus_, Fdcan::Rxf0s::level); level > 0; --level) {
      const std::uint32_t index = get(bus_, Fdcan::Rxf0s::getIndex);
      take(MessageRam::fifo0(index));
      write(bus_, Fdcan::Rxf0a::index(index));
    }
    if (get(bus_, Fdcan::Ir::fifo0Lost) == 0) return;
    ++missed_;  // one at least: the controller doesn't count
    write(bus_, Fdcan::Ir::fifo0Lost(1));
  }

  void take(std::uint32_t element) noexcept {
    const std::uint32_t head = bus_.read(element);
    const std::uint32_t control = bus_.read(element + 4);
    if ((head & (Element0::extended.mask | Element0::remote.mask)) != 0 || Element1::fd.in(control) != 0)
      return;
    CanFrame frame{.id = static_cast<std::uint16_t>(Element0::standardId.in(head))};
    const std::uint32_t length = Element1::length.in(control);
    frame.length = static_cast<std::uint8_t>(length < 8 ? length : 8);  // 9 .. 15 mean 8 in a classic frame
    for (std::uint32_t i = 0; i < frame.length; ++i)
      frame.data[i] = static_cast<std::uint8_t>(bus_.read(element + 8 + (i & 4)) >> (8 * (i & 3)));
    if (received_ == ring_.size()) {
      ++missed_;
      return;
    }
    ring_[(oldest_ + received_) % ring_.size()] = frame;
    ++received_;
  }

  /// The controller has left the bus by itself when init is set.
  void recover() noexcept {
    if (get(bus_, Cccr::init) == 0) return;
    const std::uint32_t now_us = clock_.now_us();
    if (!isWaiting_) {
      isWaiting_ = true;
      leftAt_us_ = now_us;
      ++busOffs_;
      modify(bus_, Cccr::configurable(1));  // clears the TX buffers: nothing stale goes out afterwards
      retire();
    }
    if (now_us - leftAt_us_ < kBackOff_us[attempt_]) return;
    if (attempt_ + 1U < kBackOff_us.size()) ++attempt_;
    isWaiting_ = !goOnBus();
  }

  [[no_unique_address]] Bus bus_;
  const Clock& clock_;
  std::array<std::uint16_t, kBuffers> waiting_{kNobody, kNobody, kNobody};  ///< identifiers in the TX buffers
  std::array<CanFrame, 8> ring_{};
  std::size_t oldest_ = 0;
  std::size_t received_ = 0;
  std::uint32_t dropped_ = 0;
  std::uint32_t missed_ = 0;
  std::uint32_t busOffs_ = 0;
  std::uint32_t leftAt_us_ = 0;
  std::uint32_t since_us_ = 0;  ///< the background has been in use
  std::uint8_t attempt_ = 0;    ///< to go back on the bus, since a frame was sent
  bool isWaiting_ = false;      ///< off the bus, for the back-off to pass
  bool started_ = false;
};

}  // namespace strainfinger::stm32g431
