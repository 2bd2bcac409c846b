// The power goes at every operation of the flash memory while settings or tables are written; then the board
// starts.

#include <algorithm>
#include <cstring>
#include <memory>

#include "firmware/app/finger.hpp"
#include "firmware/app/whole_tables.hpp"
#include "firmware/board/stm32g431/flash_layout.hpp"
#include "firmware/board/stm32g431/flash_store.hpp"
#include "firmware/board/stm32g431/flashed_tables.hpp"
#include "host/config/finger_config.hpp"
#include "host/tables/table_builder.hpp"
#include "tests/firmware/board/stm32g431/fake_flash.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::stm32g431;
using doubles::EccAddress;
using doubles::Torn;
using firmware::StoredSettings;

namespace {

using Store = FlashStore<doubles::FakeBus>;

constexpr std::array kAddresses{EccAddress::kRight, EccAddress::kWrong, EccAddress::kStale};
/// Only what is unreadable is told an address of.
constexpr std::span<const EccAddress> addressesToTry(Torn torn) {
  return std::span(kAddresses).first(torn == Torn::kUnreadable ? kAddresses.size() : 1);
}
constexpr std::array kTorn{Torn::kUntouched, Torn::kUnreadable, Torn::kDone};

/// What a start finds in the flash, in the order of main.cpp.
struct Found {
  firmware::FingerSettings settings;
  std::unique_ptr<TableImage> tables;  ///< nullptr: none that the finger works with
  bool hasCrashed = false;
};

/// The flash pages behind the image, and the board that starts from them.
class Board {
 public:
  doubles::FakeFlash flash{kTablePages.first, kTablePages.count + kConfigurationPages.count};

  Board() {
    flash.nonMaskable = [this] { hasCrashed_ |= !survivesNmi(bus_, errors_); };
  }

  /// As if these bytes of the tables, begin .. end - 1, had been written.
  void put(const TableImage& image, std::size_t begin, std::size_t end) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&image);
    for (std::size_t offset = begin; offset < end; offset += 4)
      std::memcpy(&flash.wordAt(offset), bytes + offset, 4);
  }

  Store store(const PageRange& pages) { return Store(bus_, errors_, pages.first, pages.count); }

  Found start(const TableImage& linked) {
    flash.reset();
    errors_.isExpected = false;
    hasCrashed_ = false;
    Found found;
    Store configuration = store(kConfigurationPages);
    found.settings = firmware::startedWith(firmware::FingerSettings{.node = 63, .contactRate_hz = 20},
                                           firmware::SettingsStore(configuration).found());
    TableImage flashed;
    const TableImage* const tables = readableTables(bus_, errors_, [&] {
      readTablePages(flashed);
      return firmware::ifWhole(firmware::tablesOf(flashed, linked));
    });
    if (tables != nullptr) found.tables = std::make_unique<TableImage>(*tables);
    found.hasCrashed = hasCrashed_;
    return found;
  }

 private:
  /// As the processor reads them: word by word, from the memory or its cache.
  void readTablePages(TableImage& image) {
    auto* const bytes = reinterpret_cast<unsigned char*>(&image);
    for (std::uint32_t offset = 0; offset < sizeof image; offset += 4) {
      const std::uint32_t word = bus_.read(kTablePages.address() + offset);
      std::memcpy(bytes + offset, &word, 4);
    }
  }

  doubles::FakeBus bus_{flash.registers};
  EccErrors errors_;
  bool hasCrashed_ = false;
};

}  // namespace

TEST_GROUP(PowerCut) {
  static constexpr StoredSettings kOld{5, 100}, kNew{6, 200};
  TableImage linked = tables::buildTableImage(config::FingerConfig{});
  int starts = 0;

  static void save(Board & board, const StoredSettings& settings) {
    Store store = board.store(kConfigurationPages);
    firmware::EraseBudget budget;
    static_cast<void>(firmware::SettingsStore(store).save(settings, budget, 0));
  }

  /// As a programmer does it: all pages erased, then written from the first on.
  static constexpr int kErases = kTablePages.count, kUnit_bytes = 8;
  static constexpr int kOperations = kErases + static_cast<int>(sizeof(TableImage)) / kUnit_bytes;
  static hal::StoreResult flashOnly(int operation, Board& board, const TableImage& image) {
    Store store = board.store(kTablePages);
    if (operation < kErases) return store.erase(static_cast<std::size_t>(operation));
    const auto offset = static_cast<std::size_t>(operation - kErases) * kUnit_bytes;
    return store.write(offset, std::as_bytes(std::span(&image, 1)).subspan(offset, kUnit_bytes));
  }
  /// As if the operations before this one had been done: to do them all for each cut would take the square.
  static void putHalfFlashed(int operation, Board& board, const TableImage& old, const TableImage& image) {
    const auto erased = static_cast<std::size_t>(std::min(operation, kErases)) * kFlashPageBytes;
    const auto written = static_cast<std::size_t>(std::max(operation - kErases, 0)) * kUnit_bytes;
    board.put(old, std::min(erased, sizeof old), sizeof old);
    board.put(image, 0, written);
  }

  static bool has(const Found& found, const StoredSettings& settings) {
    return found.settings.node == settings.node && found.settings.contactRate_hz == settings.contactRate_hz;
  }
  static bool has(const Found& found, const TableImage& image) {
    return found.tables && found.tables->crc32 == image.crc32;
  }
  Found start(Board & board) {
    ++starts;
    Found found = board.start(linked);
    CHECK_FALSE(found.hasCrashed);
    return found;
  }

  Found cutWhileFlashing(const TableImage& old, int operation, Torn torn, EccAddress address) {
    Board board;
    putHalfFlashed(operation, board, old, linked);
    board.flash.eccAddress = address;
    board.flash.cutPowerAfter(0, torn);
    static_cast<void>(flashOnly(operation, board, linked));
    LONGS_EQUAL(1, board.flash.operations());
    return start(board);
  }

  void cutWhileSaving(int saves, int operation, Torn torn, EccAddress address) {
    Board board;
    for (int i = 0; i < saves; ++i) save(board, i % 2 == saves % 2 ? kNew : kOld);  // the last is the old one
    board.flash.eccAddress = address;
    board.flash.cutPowerAfter(operation, torn);
    save(board, kNew);
    const Found found = start(board);
    const bool isOld = saves == 0 ? found.settings.node == 63 : has(found, kOld);
    CHECK_TRUE(isOld || has(found, kNew));
    const bool isTorn = torn == Torn::kUnreadable || (torn == Torn::kDone && operation == 1);
    if (isOld && isTorn) CHECK_TRUE(found.settings.standingFaults.has(FingerFault::kConfiguration));
    if (operation == 2 && torn == Torn::kDone) CHECK_TRUE(has(found, kNew));
    save(board, kNew);
    CHECK_TRUE(has(start(board), kNew));
  }
};

// An erase and two double words.
TEST(PowerCut, WhileSettingsAreSavedTheBoardComesUpWithTheOldOrTheNewAndSaysWhatItLost) {
  for (const EccAddress address : kAddresses)
    for (const Torn torn : kTorn)
      for (int saves = 0; saves <= 11; ++saves)
        for (int operation = 0; operation < 3; ++operation) cutWhileSaving(saves, operation, torn, address);
  LONGS_EQUAL(3 * 3 * 12 * 3 * 2, starts);
}

/// What the next test jumps to is where whole flashing passes by.
TEST(PowerCut, FlashingLeavesWhatIsTakenForHalfFlashed) {
  config::FingerConfig another;
  another.gauges.radius_m = 9.5e-3;
  const TableImage old = tables::buildTableImage(another);
  Board flashed;
  flashed.put(old, 0, sizeof old);
  for (int operation = 0; operation < kOperations; ++operation) {
    CHECK_TRUE(flashOnly(operation, flashed, linked) == hal::StoreResult::kOk);
    if (operation % 100 != 0 && operation >= kErases) continue;
    Board put;
    putHalfFlashed(operation + 1, put, old, linked);
    for (std::size_t offset = 0; offset < kTablePages.bytes(); offset += 4)
      LONGS_EQUAL(put.flash.wordAt(offset), flashed.flash.wordAt(offset));
  }
}

TEST(PowerCut, WhileTablesAreWrittenTheBoardComesUpWithWholeTablesOrSaysThatItHasNone) {
  config::FingerConfig another;
  another.gauges.radius_m = 9.5e-3;
  const TableImage old = tables::buildTableImage(another);
  int refused = 0;
  for (const Torn torn : kTorn)
    for (const EccAddress address : addressesToTry(torn))
      for (int operation = 0; operation < kOperations; ++operation) {
        // Words are all written alike.
        constexpr int kEvery = kSanitized ? 8 : 1;
        if (operation >= kErases && operation < kOperations - 1 && operation % kEvery != 0) continue;
        const Found found = cutWhileFlashing(old, operation, torn, address);
        CHECK_TRUE(!found.tables || has(found, linked) || has(found, old));
        if (operation == kOperations - 1 && torn == Torn::kDone) CHECK_TRUE(has(found, linked));
        refused += !found.tables;
      }
  UT_PRINT(StringFromFormat("%d starts, %d without tables", starts, refused).asCharString());
}

TEST(PowerCut, AWordOfTheTablesThatFailsWhileTheyAreInUseIsACrashAndThenNoTables) {
  Board board;
  board.put(linked, 0, sizeof linked);
  CHECK_TRUE(start(board).tables != nullptr);
  board.flash.damage(0);
  POINTERS_EQUAL(nullptr, start(board).tables.get());
}
