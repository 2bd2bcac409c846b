#include "tests/architecture/rooms.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::architecture;

TEST_GROUP(Rooms) {
  const std::filesystem::path root = STRAINFINGER_ROOT;
  const std::vector<std::string> folders{"common", "hal", "firmware", "host"};

  Rooms roomsOfTheProject() {
    Rooms rooms;
    for (const std::string& folder : folders) addRooms(rooms, folder, contentOf(root / folder / "README.md"));
    return rooms;
  }

  static Rooms example() {
    Rooms rooms;
    addRooms(rooms, "common", "Depends on: nothing.\n");
    addRooms(rooms, "hal", "Depends on: `common`.\n");
    addRooms(rooms, "host",
             "| folder | holds | may include (besides `common`, `host/base`) |\n|--|--|--|\n"
             "| `base/` | `Failure` | |\n| `can/` | ports of `host/tables` | `hal` |\n| `run/` | | `can` |\n"
             "| `cli/` | | all |\n");
    return rooms;
  }

  static std::size_t violations(const std::string& path, const std::string& included) {
    return forbiddenIncludes(example(), path, "#pragma once\n#include \"" + included + "\"\n").size();
  }

  static std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text.append("\n").append(line);
    return text;
  }
};

TEST(Rooms, EveryIncludeIsOneThatTheReadmesAllow) {
  const Rooms rooms = roomsOfTheProject();
  std::string found;
  for (const std::string& folder : folders) {
    const auto sources = sourcesUnder(root, folder);
    CHECK_TRUE_TEXT(sources.size() > 1, folder.c_str());
    for (const std::string& path : sources)
      found += joined(forbiddenIncludes(rooms, path, contentOf(root / path)));
  }
  STRCMP_EQUAL("", found.c_str());
}

TEST(Rooms, TheReadmesTellOfEveryFolderThatIsATarget) {
  const Rooms rooms = roomsOfTheProject();
  for (const std::string room :
       {"common", "hal", "firmware/core", "firmware/app", "host/base", "host/can", "host/shape", "host/cli"})
    CHECK_TRUE_TEXT(rooms.contains(room), room.c_str());
  CHECK_TRUE(rooms.at("host/can").contains("hal"));
  CHECK_TRUE(rooms.at("common").empty());
}

TEST(Rooms, TheFirmwaresCoreHasNoFloatingPointHeapOrExceptions) {
  const auto sources = sourcesUnder(root, "firmware/core");
  CHECK_TRUE(sources.size() > 1);
  std::string found;
  for (const std::string& path : sources) found += joined(forbiddenWords(path, contentOf(root / path)));
  STRCMP_EQUAL("", found.c_str());
}

TEST(Rooms, AnAllowedIncludePasses) {
  LONGS_EQUAL(0, violations("hal/clock.hpp", "common/fixed.hpp"));
  LONGS_EQUAL(0, violations("hal/clock.hpp", "hal/can_port.hpp"));
  LONGS_EQUAL(0, violations("host/can/port.cpp", "host/base/failure.hpp"));
  LONGS_EQUAL(0, violations("host/can/port.cpp", "hal/can_port.hpp"));
  LONGS_EQUAL(0, violations("host/run/run.cpp", "host/can/port.hpp"));
  LONGS_EQUAL(0, violations("host/cli/run.cpp", "host/run/run.hpp"));
}

TEST(Rooms, AForbiddenIncludeIsFound) {
  LONGS_EQUAL(1, violations("common/fixed.hpp", "hal/clock.hpp"));
  LONGS_EQUAL(1, violations("hal/clock.hpp", "host/base/failure.hpp"));
  LONGS_EQUAL(1, violations("host/can/port.cpp", "host/run/run.hpp"));
  LONGS_EQUAL(1, violations("host/run/run.cpp", "hal/clock.hpp"));
  LONGS_EQUAL(1, violations("host/can/port.cpp", "port.hpp"));
  LONGS_EQUAL(1, violations("host/can/port.cpp", "tests/doubles/fake_clock.hpp"));
  LONGS_EQUAL(1, violations("host/elsewhere/port.cpp", "host/elsewhere/port.hpp"));
}

TEST(Rooms, AForbiddenIncludeIsToldWithItsPlace) {
  const auto found =
      forbiddenIncludes(example(), "hal/clock.hpp", "\n#  include \"host/can/port.hpp\" // why\n");
  STRCMP_EQUAL("\nhal/clock.hpp:2: hal may not include host/can/port.hpp", joined(found).c_str());
}

TEST(Rooms, ForbiddenWordsAreFound) {
  for (const std::string line :
       {"double x;", "auto f = static_cast<float>(1);", "int* p = new int;", "throw 1;",
        "std::vector<int> v;", "#include <vector>", "std::string s;", "try {", "free(p);"})
    STRCMP_EQUAL(line.c_str(), forbiddenWords("f", line).size() == 1 ? line.c_str() : "not found");
}

TEST(Rooms, ForbiddenWordsAreToldWithTheirPlace) {
  STRCMP_EQUAL("\nfirmware/core/a.cpp:3: double",
               joined(forbiddenWords("firmware/core/a.cpp", "/* a\n b */\ndouble x;")).c_str());
}

TEST(Rooms, WordsThatOnlyLookForbiddenPass) {
  for (const std::string line :
       {"// a double", "/* new\nfloat */ int x;", "int renewed, doubled, newest;", "T() = delete;",
        "auto t = \"throw \\\" new\";", "std::array<int, 2> a;", "#include <cstdint>"})
    STRCMP_EQUAL("", joined(forbiddenWords("f", line)).c_str());
}
