// No register or field is left out of those that RegistersTest.cpp compares.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "tests/firmware/board/stm32g431/register_comparisons.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::stm32g431;

namespace {

/// Names of all registers and fields that registers/*.hpp define, as kRegisters should have them.
std::vector<std::string> definedNames(const std::string& text) {
  static const std::regex kDefinition(
      R"(\n(struct) (\w+)|\n  struct (\w+) : Register<|Field<\w+, [^>]*>\s*(\w+)\{\})");
  std::vector<std::string> names;
  std::string peripheral, nested;
  for (std::sregex_iterator match(text.begin(), text.end(), kDefinition), end; match != end; ++match) {
    if ((*match)[1].matched) {
      peripheral = (*match)[2].str() + "::";
      nested.clear();
    } else if ((*match)[3].matched) {
      nested = (*match)[3].str() + "::";
      names.push_back(peripheral + nested + "address");
    } else {
      names.push_back(peripheral + nested + (*match)[4].str() + ".mask");
    }
  }
  return names;
}

/// A name of a template for each of its instances.
std::vector<std::string> instancesOf(const std::string& name) {
  std::vector<std::string> names;
  const std::string rest = name.substr(name.find(':'));
  if (name.starts_with("Adc::")) return {"Adc1" + rest, "Adc2" + rest};
  if (name.starts_with("Timer::")) return {"Tim1" + rest, "Tim2" + rest, "Tim3" + rest};
  return {name};
}

}  // namespace

TEST_GROUP(RegisterList) {};

TEST(RegisterList, AllAreCompared) {
  const std::filesystem::path folder = STRAINFINGER_ROOT "/firmware/board/stm32g431/registers";
  std::size_t defined = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    std::ifstream stream(file.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (const std::string& name : definedNames(text))
      for (const std::string& instance : instancesOf(name)) {
        ++defined;
        CHECK_TRUE_TEXT(std::ranges::count(kRegisters, instance, &Comparison::name) == 1, instance.c_str());
      }
  }
  CHECK_TRUE(defined >= 236);
}
