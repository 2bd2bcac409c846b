#include "host/can/tapped_port.hpp"

#include "tests/doubles/fake_can_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(TappedPort) {
  doubles::FakeCanPort port;
  can::TappedPort<doubles::FakeCanPort> tapped{port};
};

TEST(TappedPort, KeepsWhatWasSentUntilItIsFetched) {
  const CanFrame one{0x181, 1, {1}}, two{0x281, 1, {2}};
  CHECK_TRUE(tapped.send(one) && tapped.send(two));
  CHECK_TRUE(tapped.fetchSent() == (std::vector{one, two}));
  CHECK_TRUE(tapped.fetchSent().empty());
}

TEST(TappedPort, DoesNotKeepWhatWasRefused) {
  port.busy = true;
  CHECK_FALSE(tapped.send({0x181, 1, {1}}));
  CHECK_TRUE(tapped.fetchSent().empty());
}
