#include "host/can/open_bus.hpp"

#include "host/base/failure.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(OpenBus) {
  static std::string refusalOf(const std::string& name, ExitCode code) {
    try {
      can::openBus(name);
    } catch (const Failure& failure) {
      CHECK_TRUE(failure.code() == code);
      return failure.what();
    }
    FAIL("opened");
    return {};
  }
};

TEST(OpenBus, UdpIsABusWithoutAnInterface) {
  const auto port = can::openBus("udp:29999");
  STRCMP_EQUAL("udp:29999", port->name().c_str());
  CHECK_TRUE(port->descriptor() >= 0);
}

TEST(OpenBus, AnyOtherNameIsAnInterfaces) {
  STRCMP_CONTAINS("nocan7", refusalOf("nocan7", ExitCode::kNoInterface).c_str());
}

TEST(OpenBus, LoopbackIsNoBusForSeveralPrograms) {
  STRCMP_CONTAINS("use udp on both sides", refusalOf("loopback", ExitCode::kUsage).c_str());
}

TEST(OpenBus, ANameThatIsNoneIsRefused) {
  STRCMP_CONTAINS("udp:1 is no bus", refusalOf("udp:1", ExitCode::kUsage).c_str());
}
