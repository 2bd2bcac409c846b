#pragma once
// The contract of hal::CanPort as tests, for any backend:
//
//   struct MyBench {
//     MyPort& port();                                   // under test, on a bus with another node
//     bool otherSends(const CanFrame& frame);           // the other node does
//     std::optional<CanFrame> otherHears();             // next frame the other node hears; waits a while for
//     one std::optional<CanFrame> portHears();              // next frame of port(); waits a while for one
//     void block();                                     // from here on the port can't send: busy, down,
//     bus-off void unblock();
//   };
//   CAN_PORT_CONTRACT(MyPort, MyBench)

#include <CppUTest/TestHarness.h>

#include <array>
#include <chrono>
#include <vector>

#include "hal/can_port.hpp"

namespace strainfinger::contract {

template <typename Bench>
class CanPortContract {
 public:
  void othersHearWhatIsSentInOrder() {
    for (const CanFrame& frame : variedFrames()) {
      CHECK_TRUE(bench_.port().send(frame));
      CHECK_TRUE(bench_.otherHears() == frame);
    }
    for (const CanFrame& frame : burst()) CHECK_TRUE(bench_.port().send(frame));
    for (const CanFrame& frame : burst()) CHECK_TRUE(bench_.otherHears() == frame);
  }

  void framesOfOthersAreReceivedInOrderOfArrival() {
    for (const CanFrame& frame : variedFrames()) {
      CHECK_TRUE(bench_.otherSends(frame));
      CHECK_TRUE(bench_.portHears() == frame);
    }
    for (const CanFrame& frame : burst()) CHECK_TRUE(bench_.otherSends(frame));
    for (const CanFrame& frame : burst()) CHECK_TRUE(bench_.portHears() == frame);
  }

  void itsOwnFramesAreNotReceived() {
    CHECK_TRUE(bench_.port().send(kOne));
    CHECK_TRUE(bench_.otherSends(kOther));
    CHECK_TRUE(bench_.portHears() == kOther);
    CHECK_FALSE(bench_.port().receive().has_value());
  }

  void nothingNewIsNothing() {
    CHECK_FALSE(bench_.port().receive().has_value());
    CHECK_TRUE(bench_.otherSends(kOther));
    CHECK_TRUE(bench_.portHears() == kOther);
    CHECK_FALSE(bench_.port().receive().has_value());
  }

  void dataBeyondTheLengthArriveAsZero() {
    CHECK_TRUE(bench_.otherSends({.id = 0x123, .length = 2, .data = {1, 2, 3, 4, 5, 6, 7, 8}}));
    CHECK_TRUE(bench_.portHears() == (CanFrame{.id = 0x123, .length = 2, .data = {1, 2}}));
  }

  void whatIsRefusedIsNeverHeard() {
    bench_.block();
    CHECK_FALSE(bench_.port().send(kOne));
    bench_.unblock();
    CHECK_TRUE(sendSoon(kOther));
    CHECK_TRUE(bench_.otherHears() == kOther);
  }

  void refusingTakesNoTime() {
    bench_.block();
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 100; ++i) bench_.port().send(kOne);
    // A blocked write would take as long as the block: for ever. 100 refusals take under 1 ms; the rest is
    // for a busy machine.
    CHECK_TRUE(std::chrono::steady_clock::now() - start < std::chrono::seconds(2));
  }

  void aFrameNoBusCanCarryIsRefused() {
    CHECK_FALSE(bench_.port().send({.id = kMaxCanId + 1, .length = 0}));
    CHECK_FALSE(bench_.port().send({.id = 0xFFFF, .length = 0}));
    CHECK_FALSE(bench_.port().send({.id = 1, .length = 9}));
    CHECK_FALSE(bench_.port().send({.id = 1, .length = 255}));
    CHECK_TRUE(bench_.port().send(kOne));
    CHECK_TRUE(bench_.otherHears() == kOne);
  }

  void aWorkingBusIsActiveAndLosesNothing() {
    CHECK_TRUE(bench_.port().send(kOne));
    const hal::CanStatus status = bench_.port().status();
    CHECK_TRUE(status.state == hal::CanState::kActive);
    LONGS_EQUAL(0, status.dropped);
    LONGS_EQUAL(0, status.missed);
  }

 private:
  static constexpr CanFrame kOne{.id = 0x181, .length = 3, .data = {0xAA, 0x00, 0x55}};
  static constexpr CanFrame kOther{.id = 0x7FF, .length = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}};

  /// Every identifier with every length somewhere, data all different.
  static std::vector<CanFrame> variedFrames() {
    std::vector<CanFrame> frames;
    for (int id = 0; id <= kMaxCanId; ++id) {
      CanFrame frame{.id = static_cast<std::uint16_t>(id), .length = static_cast<std::uint8_t>(id % 9)};
      for (int i = 0; i < frame.length; ++i)
        frame.data[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(id + 37 * i);
      frames.push_back(frame);
    }
    return frames;
  }

  /// Few enough to wait unread on any bus, the higher identifier first: order is that of sending.
  static std::array<CanFrame, 5> burst() {
    return {{{.id = 0x700},
             {.id = 0x100, .length = 1, .data = {1}},
             {.id = 0x100, .length = 1, .data = {2}},
             {.id = 0x100, .length = 1, .data = {1}},
             {.id = 0}}};
  }

  /// A port that has just been unblocked may say "not now" once more.
  bool sendSoon(const CanFrame& frame) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    while (std::chrono::steady_clock::now() < end)
      if (bench_.port().send(frame)) return true;
    return false;
  }

  Bench bench_;
};

}  // namespace strainfinger::contract

#define CAN_PORT_CONTRACT(Backend, Bench)                                                                  \
  TEST_GROUP(CanPort_##Backend) {                                                                          \
    strainfinger::contract::CanPortContract<Bench> contract;                                               \
  };                                                                                                       \
  TEST(CanPort_##Backend, OthersHearWhatIsSentInOrder) { contract.othersHearWhatIsSentInOrder(); }         \
  TEST(CanPort_##Backend, FramesOfOthersAreReceivedInOrderOfArrival) {                                     \
    contract.framesOfOthersAreReceivedInOrderOfArrival();                                                  \
  }                                                                                                        \
  TEST(CanPort_##Backend, ItsOwnFramesAreNotReceived) { contract.itsOwnFramesAreNotReceived(); }           \
  TEST(CanPort_##Backend, NothingNewIsNothing) { contract.nothingNewIsNothing(); }                         \
  TEST(CanPort_##Backend, DataBeyondTheLengthArriveAsZero) { contract.dataBeyondTheLengthArriveAsZero(); } \
  TEST(CanPort_##Backend, WhatIsRefusedIsNeverHeard) { contract.whatIsRefusedIsNeverHeard(); }             \
  TEST(CanPort_##Backend, RefusingTakesNoTime) { contract.refusingTakesNoTime(); }                         \
  TEST(CanPort_##Backend, AFrameNoBusCanCarryIsRefused) { contract.aFrameNoBusCanCarryIsRefused(); }       \
  TEST(CanPort_##Backend, AWorkingBusIsActiveAndLosesNothing) {                                            \
    contract.aWorkingBusIsActiveAndLosesNothing();                                                         \
  }
