#include "host/cli/raw_stream.hpp"

#include "host/base/failure.hpp"
#include "host/can/frame_catalogue.hpp"
#include "tests/host/can/fake_bus_port.hpp"

#include <vector>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::cli;

TEST_GROUP(RawStream) {
  static constexpr std::uint8_t kNode = 5;
  can::FakeBusPort bus;
  std::vector<unsigned> rates_hz;  ///< asked for

  /// The finger obeys; its answer to a rate of `lost_hz` is lost.
  void obey(unsigned lost_hz) {
    bus.onSend = [this, lost_hz](const CanFrame& frame) {
      const auto request = readSingleFrame<RequestFrame>(frame, kNode);
      if (request->command == Command::kRaw) {
        rates_hz.push_back(request->argument);
        if (request->argument == lost_hz) return;
      }
      bus.hear(responseTo(request->command, CommandStatus::kDone), kNode);
    };
  }
};

TEST(RawStream, IsEndedWithIt) {
  obey(1);
  { const RawStream stream(bus, kNode, 100, system::StopSignal()); }
  CHECK_TRUE((std::vector<unsigned>{100, 0}) == rates_hz);
}

TEST(RawStream, IsEndedWhereTheAnswerWasLost) {
  obey(100);
  CHECK_THROWS(Failure, RawStream(bus, kNode, 100, system::StopSignal()));
  CHECK_TRUE((std::vector<unsigned>{100, 0}) == rates_hz);
}
