#include "firmware/board/stm32g431/pinout.hpp"

#include <CppUTest/TestHarness.h>

#include <fstream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "firmware/board/stm32g431/flash_layout.hpp"
#include "firmware/board/stm32g431/send_rules.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;

TEST_GROUP(Pinout) {
  /// Channels of ADC1 and ADC2 (0: none) by pin, DS12589, table of pin definitions.
  const std::map<std::string, std::pair<int, int>> datasheet{
      {"PA0", {1, 1}},  {"PA1", {2, 2}},    {"PA2", {3, 0}},   {"PA3", {4, 0}},  {"PA4", {0, 17}},
      {"PA5", {0, 13}}, {"PA6", {0, 3}},    {"PA7", {0, 4}},   {"PB0", {15, 0}}, {"PB1", {12, 0}},
      {"PB2", {0, 12}}, {"PB11", {14, 14}}, {"PB12", {11, 0}}, {"PB14", {5, 0}}, {"PB15", {0, 15}},
      {"PC0", {6, 6}},  {"PC1", {7, 7}},    {"PC2", {8, 8}},   {"PC3", {9, 9}},  {"PC4", {0, 5}},
      {"PC5", {0, 11}}, {"PF0", {10, 0}},   {"PF1", {0, 10}}};

  static std::string nameOf(Pin pin) {
    return std::string(1, 'P')
        .append(1, static_cast<char>('A' + static_cast<int>(pin.port)))
        .append(std::to_string(pin.number));
  }
  static const Input& gauge(std::size_t index) {
    return (index % 2 == 0 ? kEvenGauges : kOddGauges)[index / 2];
  }
};

TEST(Pinout, EveryGaugeHasItsPinAndTheChannelOfThatPin) {
  std::set<std::string> pins;
  for (std::size_t i = 0; i < kGauges; ++i) {
    const std::string name = nameOf(gauge(i).pin);
    const auto [adc1, adc2] = datasheet.at(name);
    LONGS_EQUAL_TEXT(i % 2 == 0 ? adc1 : adc2, gauge(i).channel, name.c_str());
    CHECK_TRUE_TEXT(pins.insert(name).second, name.c_str());
  }
}

TEST(Pinout, LeavesThePinsOfTheNucleoBoardAlone) {
  const std::set<std::string> nucleo{"PA2",  "PA3", "PA5", "PA13", "PA14",
                                     "PC13", "PF0", "PF1", "PA11", "PA12"};
  for (std::size_t i = 0; i < kGauges; ++i) CHECK_FALSE(nucleo.contains(nameOf(gauge(i).pin)));
  STRCMP_EQUAL("PA11", nameOf(kCanRx).c_str());
  STRCMP_EQUAL("PA12", nameOf(kCanTx).c_str());
}

TEST(Pinout, TheReadmesTableIsTheSame) {
  std::vector<std::string> expected;
  for (std::size_t i = 0; i < kGauges; ++i)
    expected.push_back(std::string("| gauge ")
                           .append(std::to_string(i))
                           .append(" | ")
                           .append(nameOf(gauge(i).pin))
                           .append(i % 2 == 0 ? " | ADC1 | " : " | ADC2 | ")
                           .append(std::to_string(gauge(i).channel))
                           .append(" |"));
  std::ifstream readme(STRAINFINGER_ROOT "/firmware/board/stm32g431/README.md");
  std::vector<std::string> found;
  for (std::string line; std::getline(readme, line);)
    if (line.starts_with("| gauge ")) found.push_back(line);
  CHECK_TRUE(expected == found);
}

TEST_GROUP(SendRules) {};

TEST(SendRules, TouchesAndHeartbeatsGiveWayToNewerOnes) {
  for (const int id : {0x181, 0x201, 0x2BF, 0x301, 0x381, 0x701})
    CHECK_TRUE(sendRule(static_cast<std::uint16_t>(id)).newestWins);
  for (const int id : {0x481, 0x581, 0x180}) CHECK_FALSE(sendRule(static_cast<std::uint16_t>(id)).newestWins);
}

TEST(SendRules, OnlyTouchesHaveBuffersOfTheirOwn) {
  for (std::uint16_t id = 0; id <= kMaxCanId; ++id) {
    bool touch = false;
    for (const int function : {0x180, 0x200, 0x280, 0x300, 0x380})
      touch = touch || (id >= function + 1 && id <= function + 63);
    CHECK_EQUAL(touch, !sendRule(id).background);
  }
}

TEST(SendRules, ListensToItsOwnRequestsOnly) {
  CHECK_TRUE((identifiersFor(5) == std::array<std::uint16_t, 1>{0x605}));
}

TEST_GROUP(FlashLayout) {};

TEST(FlashLayout, TablesAndConfigurationAreBehindTheImage) {
  LONGS_EQUAL(0x0801'8000, kTablePages.address());
  LONGS_EQUAL(0x0801'E000, kConfigurationPages.address());
  LONGS_EQUAL(96 * 1024, kImagePages.bytes());
  LONGS_EQUAL(4, kConfigurationPages.count);  // as many as StoredSettingsTest lets a year wear out
}
