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

TEST(OpenBus, AMistypedUdpIsNamed) {
  const auto meant = [](const std::string& name) { return refusalOf(name, ExitCode::kNoInterface); };
  STRCMP_EQUAL("upd:30010 is no bus: did you mean udp:30010?", meant("upd:30010").c_str());
  STRCMP_EQUAL("udp30010 is no bus: did you mean udp:30010?", meant("udp30010").c_str());
  STRCMP_EQUAL("UDP is no bus: did you mean udp?", meant("UDP").c_str());
  STRCMP_EQUAL("ud:30010 is no bus: did you mean udp:30010?", meant("ud:30010").c_str());
  for (const char* name : {"nousb0", "usb9", "vcan99", "can99:1", "udpx:y"})
    CHECK(meant(name).find("did you mean") == std::string::npos);
}

TEST(OpenBus, LoopbackIsNoBusForSeveralPrograms) {
  STRCMP_CONTAINS("use udp on both sides", refusalOf("loopback", ExitCode::kUsage).c_str());
}

TEST(OpenBus, ANameThatIsNoneIsRefused) {
  STRCMP_CONTAINS("udp:1 is no bus", refusalOf("udp:1", ExitCode::kUsage).c_str());
}
