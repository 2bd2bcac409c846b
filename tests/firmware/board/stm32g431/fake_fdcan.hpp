#pragma once
// FDCAN1 and a bus with another node, as registers: what RM0440 chapter 44 says of them.

#include <deque>
#include <vector>

#include "common/can_frame.hpp"
#include "firmware/board/stm32g431/registers/clocks.hpp"
#include "firmware/board/stm32g431/registers/fdcan.hpp"
#include "tests/firmware/board/stm32g431/fake_registers.hpp"

namespace strainfinger::doubles {

/// The bus is fast: what may go out does so at once, unless the bus is busy.
class FakeFdcan {
 public:
  FakeRegisters registers;
  bool busy = false;           ///< others have the bus, or nobody acknowledges
  bool answers = true;         ///< init follows what is written to it
  std::deque<CanFrame> heard;  ///< what went out, in order

  FakeFdcan() {
    addRegisters();
    registers.onWrite<Cccr>(
        [this](std::uint32_t before, std::uint32_t written) { return control(before, written); });
    registers.onRead<Cccr>([this](std::uint32_t stored) { return synchronised(stored); });
    registers.onWrite<Fdcan::Txbar>(
        [this](std::uint32_t, std::uint32_t buffers) { return request(buffers); });
    registers.onWrite<Fdcan::Txbcr>([this](std::uint32_t, std::uint32_t buffers) { return cancel(buffers); });
    registers.onRead<Fdcan::Txfqs>([this](std::uint32_t) { return queueStatus(); });
    registers.onRead<Fdcan::Rxf0s>([this](std::uint32_t) { return fifoStatus(); });
    registers.onWrite<Fdcan::Rxf0a>(
        [this](std::uint32_t, std::uint32_t index) { return acknowledge(index); });
    registers.onWrite<Fdcan::Ir>([](std::uint32_t before, std::uint32_t ones) { return before & ~ones; });
    protect<Fdcan::Nbtp>();
    protect<Fdcan::Dbtp>();
    protect<Fdcan::Rxgfc>();
    protect<Fdcan::Txbc>();
  }

  /// A buffer's frame is on the wire: it can't be cancelled any more, only fail.
  void beginTransmission() { onWire_ = nextBuffer(); }
  void endTransmission(bool acknowledged) {
    const std::uint32_t buffer = 1U << onWire_;
    if (acknowledged) finish(onWire_);
    if (!acknowledged && (cancelled_ & buffer) != 0) registers.word<Fdcan::Txbrp>() &= ~buffer;
    if ((cancelled_ & buffer) != 0) registers.word<Fdcan::Txbcf>() |= buffer;
    cancelled_ &= ~buffer;
    onWire_ = kNone;
  }

  /// The bus is free again.
  void free() {
    busy = false;
    sendAll();
  }

  /// Another node sends; the head and control words may carry more than a data frame has. False: not
  /// received.
  bool deliver(const CanFrame& frame, std::uint32_t headFlags = 0, std::uint32_t controlFlags = 0) {
    if (!isOnBus() || !isAccepted(frame.id, headFlags)) return false;
    if (level_ == MessageRam::elements) {
      registers.setField(Fdcan::Ir::fifo0Lost, 1);
      return false;
    }
    const std::uint32_t element = MessageRam::fifo0((get_ + level_) % MessageRam::elements);
    registers.at(element) = Element0::standardId(frame.id).value | headFlags;
    registers.at(element + 4) = Element1::length(frame.length).value | controlFlags;
    for (std::uint32_t i = 0; i < 8; ++i) setByte(element + 8 + i, frame.data[i]);
    ++level_;
    return true;
  }

  void goBusOff() {
    registers.setField(Fdcan::Psr::busOff, 1);
    registers.setField(Cccr::init, 1);
    wanted_ = 1;
  }
  /// 129 times 11 recessive bits have passed; nothing happens while init is set.
  void recessiveBitsPass() {
    if (registers.field(Cccr::init) != 0) return;
    registers.setField(Fdcan::Psr::busOff, 0);
    registers.word<Fdcan::Ecr>() = 0;
  }

  std::uint32_t pending() { return registers.word<Fdcan::Txbrp>(); }
  bool isOnBus() { return registers.field(Cccr::init) == 0 && registers.field(Fdcan::Psr::busOff) == 0; }

 private:
  using Fdcan = stm32g431::Fdcan;
  using Cccr = Fdcan::Cccr;
  using MessageRam = stm32g431::MessageRam;
  using Element0 = stm32g431::Element0;
  using Element1 = stm32g431::Element1;
  using StandardFilter = stm32g431::StandardFilter;
  static constexpr std::uint32_t kNone = MessageRam::elements;

  void addRegisters() {
    registers.add<Fdcan::Dbtp>(0x0A33);
    registers.add<Cccr>(Cccr::init(1).value);
    registers.add<Fdcan::Nbtp>(0x0600'0A03);
    registers.add<Fdcan::Ecr>();
    registers.add<Fdcan::Psr>(0x0707);
    registers.add<Fdcan::Ir>();
    registers.add<Fdcan::Rxgfc>();
    registers.add<Fdcan::Rxf0s>();
    registers.add<Fdcan::Rxf0a>();
    registers.add<Fdcan::Txbc>();
    registers.add<Fdcan::Txfqs>();
    registers.add<Fdcan::Txbrp>();
    registers.add<Fdcan::Txbar>();
    registers.add<Fdcan::Txbcr>();
    registers.add<Fdcan::Txbto>();
    registers.add<Fdcan::Txbcf>();
    registers.addRange(MessageRam::base, 0x350, 0xDEAD'BEEF);  // not cleared by reset
  }

  template <typename Reg>
  void protect() {
    registers.onWrite<Reg>([this](std::uint32_t before, std::uint32_t written) {
      if (isConfigurable()) return written;
      FakeRegisters::violate("written while it is protected", Reg::address);
      return before;
    });
  }

  bool isConfigurable() {
    return registers.field(Cccr::init) != 0 && registers.field(Cccr::configurable) != 0;
  }

  /// CCE holds only while init does, and clears the buffers and the FIFO; init shows a few reads later.
  std::uint32_t control(std::uint32_t before, std::uint32_t written) {
    const bool mayConfigure = Cccr::init.in(before) != 0 && Cccr::init.in(written) != 0;
    const auto require = [](bool isAllowed, const char* what) {
      FakeRegisters::require(isAllowed, what, Cccr::address);
    };
    require(Cccr::configurable.in(written) == 0 || mayConfigure, "CCE set outside of INIT");
    require(((before ^ written) & (st::FDCAN_CCCR_FDOE | st::FDCAN_CCCR_BRSE)) == 0 || isConfigurable(),
            "CAN FD switched while it is protected");
    wanted_ = Cccr::init.in(written);
    readsLeft_ = 3;
    if (Cccr::configurable.in(written) != 0 && mayConfigure && Cccr::configurable.in(before) == 0) clear();
    const std::uint32_t configurable = mayConfigure ? written & Cccr::configurable.mask : 0;
    return (written & ~(Cccr::init.mask | Cccr::configurable.mask)) | (before & Cccr::init.mask) |
           configurable;
  }

  std::uint32_t synchronised(std::uint32_t stored) {
    if (!answers || wanted_ == Cccr::init.in(stored) || readsLeft_-- > 0) return stored;
    return (stored & ~Cccr::init.mask) | Cccr::init(wanted_).value;
  }

  void clear() {
    registers.word<Fdcan::Txbrp>() = 0;
    registers.word<Fdcan::Txbto>() = 0;
    registers.word<Fdcan::Txbcf>() = 0;
    level_ = 0;
    get_ = 0;
    onWire_ = kNone;
    cancelled_ = 0;
  }

  std::uint32_t request(std::uint32_t buffers) {
    FakeRegisters::require((pending() & buffers) == 0, "a buffer requested that still waits",
                           Fdcan::Txbar::address);
    registers.word<Fdcan::Txbrp>() |= buffers;
    registers.word<Fdcan::Txbto>() &= ~buffers;
    registers.word<Fdcan::Txbcf>() &= ~buffers;
    sendAll();
    return 0;
  }

  std::uint32_t cancel(std::uint32_t buffers) {
    const std::uint32_t now = buffers & pending() & ~(1U << onWire_);
    cancelled_ |= buffers & pending() & 1U << onWire_;
    registers.word<Fdcan::Txbrp>() &= ~now;
    registers.word<Fdcan::Txbcf>() |= now;
    return 0;
  }

  /// The buffer with the lowest identifier; in a queue the order of requests doesn't matter.
  std::uint32_t nextBuffer() {
    std::uint32_t best = kNone;
    for (std::uint32_t buffer = 0; buffer < MessageRam::elements; ++buffer)
      if ((pending() >> buffer & 1) != 0 && (best == kNone || idIn(buffer) < idIn(best))) best = buffer;
    return best;
  }

  std::uint32_t idIn(std::uint32_t buffer) {
    return Element0::standardId.in(registers.at(MessageRam::tx(buffer)));
  }

  void sendAll() {
    while (!busy && isOnBus() && pending() != 0) finish(nextBuffer());
  }

  void finish(std::uint32_t buffer) {
    const std::uint32_t element = MessageRam::tx(buffer);
    CanFrame frame{.id = static_cast<std::uint16_t>(idIn(buffer)),
                   .length = static_cast<std::uint8_t>(Element1::length.in(registers.at(element + 4)))};
    for (std::uint32_t i = 0; i < frame.length; ++i) frame.data[i] = byteAt(element + 8 + i);
    heard.push_back(frame);
    registers.word<Fdcan::Txbrp>() &= ~(1U << buffer);
    registers.word<Fdcan::Txbto>() |= 1U << buffer;
  }

  std::uint32_t queueStatus() {
    std::uint32_t put = 0;
    while (put < MessageRam::elements && (pending() >> put & 1) != 0) ++put;
    return put == MessageRam::elements ? Fdcan::Txfqs::full(1).value : Fdcan::Txfqs::putIndex(put).value;
  }

  std::uint32_t fifoStatus() const {
    return (Fdcan::Rxf0s::level(level_) | Fdcan::Rxf0s::getIndex(get_)).value;
  }

  std::uint32_t acknowledge(std::uint32_t index) {
    CHECK_TRUE(level_ > 0 && index == get_);
    get_ = (get_ + 1) % MessageRam::elements;
    --level_;
    return index;
  }

  bool isAccepted(std::uint16_t id, std::uint32_t headFlags) {
    using Rxgfc = Fdcan::Rxgfc;
    const bool remote = (headFlags & Element0::remote.mask) != 0;
    if ((headFlags & Element0::extended.mask) != 0)
      return registers.field(Rxgfc::otherExtended) < 2 &&
             !(remote && registers.field(Rxgfc::rejectExtendedRemote));
    if (remote && registers.field(Rxgfc::rejectStandardRemote) != 0) return false;
    for (std::uint32_t filter = 0; filter < registers.field(Rxgfc::standardCount); ++filter) {
      const std::uint32_t word = registers.at(MessageRam::filter(filter));
      LONGS_EQUAL(1, StandardFilter::type.in(word));
      LONGS_EQUAL(1, StandardFilter::action.in(word));
      if (StandardFilter::id1.in(word) == id || StandardFilter::id2.in(word) == id) return true;
    }
    return registers.field(Rxgfc::otherStandard) < 2;
  }

  void setByte(std::uint32_t address, std::uint8_t byte) {
    std::uint32_t& word = registers.at(address & ~3U);
    const unsigned shift = 8 * (address & 3);
    word = (word & ~(0xFFU << shift)) | static_cast<std::uint32_t>(byte) << shift;
  }
  std::uint8_t byteAt(std::uint32_t address) {
    return static_cast<std::uint8_t>(registers.at(address & ~3U) >> (8 * (address & 3)));
  }

  std::uint32_t level_ = 0;
  std::uint32_t get_ = 0;
  std::uint32_t onWire_ = kNone;
  std::uint32_t cancelled_ = 0;
  std::uint32_t wanted_ = 1;
  int readsLeft_ = 0;
};

}  // namespace strainfinger::doubles
