#include "firmware/app/slcan_port.hpp"

#include <deque>
#include <string>
#include <utility>

#include "tests/hal/can_port_contract.hpp"

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

/// A serial line whose other end is the test.
class FakeLine {
 public:
  std::size_t room = 1000000;  ///< bytes that put() takes before the other end reads

  bool put(std::uint8_t byte) noexcept {
    if (written_.size() >= room) return false;
    written_.push_back(static_cast<char>(byte));
    return true;
  }
  std::optional<std::uint8_t> get() noexcept {
    if (toRead_.empty()) return std::nullopt;
    const auto byte = static_cast<std::uint8_t>(toRead_.front());
    toRead_.pop_front();
    return byte;
  }

  void write(std::string_view text) { toRead_.insert(toRead_.end(), text.begin(), text.end()); }
  bool hasUnread() const { return !toRead_.empty(); }
  std::string read() { return std::exchange(written_, {}); }

 private:
  std::string written_;
  std::deque<char> toRead_;
};
using Port = SlcanPort<FakeLine>;

/// The host end speaks SLCAN text, as the driver does.
class SlcanBench {
 public:
  SlcanBench() {
    line_.write("O\r");
    port_.poll();
    line_.read();
  }
  Port& port() { return port_; }
  bool otherSends(const CanFrame& frame) {
    line_.write(slcanFrame(frame).view());
    return true;
  }
  std::optional<CanFrame> otherHears() {
    port_.poll();
    for (const char character : line_.read()) pending_.push_back(character);
    while (!pending_.empty()) {
      const char character = pending_.front();
      pending_.pop_front();
      const auto line = reader_.take(character);
      if (line && slcanCommand(*line).kind == SlcanCommand::Kind::kFrame) return slcanCommand(*line).frame;
    }
    return std::nullopt;
  }
  std::optional<CanFrame> portHears() { return port_.receive(); }
  void block() { port_.setBus({.state = hal::CanState::kBusOff}); }
  void unblock() { port_.setBus({.state = hal::CanState::kActive}); }

 private:
  FakeLine line_;
  Port port_{line_};
  SlcanReader reader_;
  std::deque<char> pending_;
};

}  // namespace

static_assert(hal::CanPort<Port>);
CAN_PORT_CONTRACT(Slcan, SlcanBench)

TEST_GROUP(SlcanPort) {
  FakeLine line;
  Port port{line};
  static constexpr CanFrame kFrame{.id = 0x181, .length = 1, .data = {0x5A}};

  std::string answerTo(std::string_view text) {
    line.write(text);
    port.poll();
    return line.read();
  }
};

TEST(SlcanPort, IsDownUntilTheHostOpensIt) {
  CHECK_TRUE(port.status().state == hal::CanState::kDown);
  CHECK_FALSE(port.send(kFrame));
  STRCMP_EQUAL("\r\r", answerTo("S8\rO\r").c_str());
  CHECK_TRUE(port.status().state == hal::CanState::kActive);
  CHECK_TRUE(port.send(kFrame));
  STRCMP_EQUAL("t18115A\r", line.read().c_str());
}

TEST(SlcanPort, IsDownAgainWhenTheHostClosesIt) {
  answerTo("O\rC\r");
  CHECK_TRUE(port.status().state == hal::CanState::kDown);
  CHECK_FALSE(port.send(kFrame));
  STRCMP_EQUAL("\a", answerTo("t1000\r").c_str());
  CHECK_FALSE(port.receive().has_value());
}

TEST(SlcanPort, AFrameOfTheHostIsAcknowledged) {
  STRCMP_EQUAL("\rz\r", answerTo("O\rt60122B01\r").c_str());
  CHECK_TRUE(port.receive() == (CanFrame{0x601, 2, {0x2B, 0x01}}));
}

TEST(SlcanPort, NothingIsReadWhileAFrameWaits) {
  CHECK_FALSE(port.hasArrived());
  answerTo("O\rt1000\rt1010\r");
  CHECK_TRUE(port.hasArrived());
  CHECK_TRUE(line.hasUnread());
  CHECK_TRUE(port.receive()->id == 0x100);
  CHECK_TRUE(port.receive()->id == 0x101);
  CHECK_FALSE(port.receive().has_value());
  CHECK_FALSE(port.hasArrived());
}

TEST(SlcanPort, AHostThatDoesNotReadIsWaitedForAndNothingTakenIsLost) {
  answerTo("O\r");
  line.room = 0;
  int taken = 0;
  while (taken < 100 && port.send({0x181, 1, {static_cast<std::uint8_t>(taken)}})) ++taken;
  CHECK_TRUE(taken >= 10 && taken < 100);
  CHECK_FALSE(port.idle());
  line.room = 10000;
  port.poll();
  CHECK_TRUE(port.idle());
  LONGS_EQUAL(8 * taken, line.read().size());
}

TEST(SlcanPort, TheStateOfTheBusIsTold) {
  answerTo("O\r");
  port.setBus({.state = hal::CanState::kPassive, .txErrors = 128, .rxErrors = 0});
  port.poll();
  STRCMP_EQUAL("sp000128\r", line.read().c_str());
  CHECK_TRUE(port.status().state == hal::CanState::kPassive);
  CHECK_TRUE(port.send(kFrame));
}

TEST(SlcanPort, NothingIsSentWhileTheBusIsOff) {
  answerTo("O\r");
  port.setBus({.state = hal::CanState::kBusOff, .txErrors = 255, .rxErrors = 0});
  port.setBus({.state = hal::CanState::kBusOff, .txErrors = 255, .rxErrors = 0});
  CHECK_FALSE(port.send(kFrame));
  port.setBus({.state = hal::CanState::kActive, .txErrors = 0, .rxErrors = 0});
  LONGS_EQUAL(1, port.status().busOffs);
  CHECK_TRUE(port.send(kFrame));
  port.poll();
  STRCMP_EQUAL("sb000255\rsb000255\rsa000000\rt18115A\r", line.read().c_str());
}
