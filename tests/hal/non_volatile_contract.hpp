#pragma once
// The contract of hal::NonVolatile as tests, for any backend:
//
//   struct MyBench {
//     MyStore& store();   // erased, two pages or more
//   };
//   NON_VOLATILE_CONTRACT(MyStore, MyBench)

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/non_volatile.hpp"

namespace strainfinger::contract {

template <typename Bench>
class NonVolatileContract {
 public:
  void erasedBytesReadAsOnes() {
    CHECK_TRUE(store().erase(0) == StoreResult::kOk);
    CHECK_TRUE(read(0, store().pageSize()) == std::vector(store().pageSize(), std::byte{0xFF}));
  }

  void whatIsWrittenIsReadBackInAnyRange() {
    CHECK_TRUE(store().write(8, pattern(24)) == StoreResult::kOk);
    CHECK_TRUE(read(8, 24) == pattern(24));
    CHECK_TRUE(read(11, 2) == std::vector({pattern(24)[3], pattern(24)[4]}));
    CHECK_TRUE(read(0, 8) == std::vector(8, std::byte{0xFF}));
    CHECK_TRUE(read(32, 8) == std::vector(8, std::byte{0xFF}));
  }

  void theWholeStoreCanBeWritten() {
    CHECK_TRUE(store().write(0, pattern(store().size())) == StoreResult::kOk);
    CHECK_TRUE(read(0, store().size()) == pattern(store().size()));
  }

  void writingOverWrittenBytesIsRefusedAndTouchesNothing() {
    CHECK_TRUE(store().write(8, pattern(8)) == StoreResult::kOk);
    CHECK_TRUE(store().write(0, std::vector(16, std::byte{0})) == StoreResult::kNotErased);
    CHECK_TRUE(read(0, 8) == std::vector(8, std::byte{0xFF}));
    CHECK_TRUE(read(8, 8) == pattern(8));
  }

  void erasingClearsItsPageOnly() {
    CHECK_TRUE(store().write(0, pattern(store().size())) == StoreResult::kOk);
    CHECK_TRUE(store().erase(1) == StoreResult::kOk);
    const std::size_t page = store().pageSize();
    const auto all = pattern(store().size());
    CHECK_TRUE(std::ranges::equal(read(0, page), std::span(all).first(page)));
    CHECK_TRUE(read(page, page) == std::vector(page, std::byte{0xFF}));
    CHECK_TRUE(store().write(page, pattern(8)) == StoreResult::kOk);
  }

  void whatLiesOutsideIsRefused() {
    std::vector bytes(16, std::byte{0});
    for (const std::size_t offset : {store().size() - 8, store().size(), SIZE_MAX - 7}) {
      CHECK_TRUE(store().write(offset, bytes) == StoreResult::kOutOfRange);
      CHECK_TRUE(store().read(offset, bytes) == StoreResult::kOutOfRange);
    }
    CHECK_TRUE(store().erase(store().size() / store().pageSize()) == StoreResult::kOutOfRange);
    CHECK_TRUE(store().erase(SIZE_MAX) == StoreResult::kOutOfRange);
    CHECK_TRUE(read(store().size() - 8, 8) == std::vector(8, std::byte{0xFF}));
  }

  void partsOfAUnitAreNotWritten() {
    CHECK_TRUE(store().write(4, pattern(8)) == StoreResult::kOutOfRange);
    CHECK_TRUE(store().write(0, pattern(7)) == StoreResult::kOutOfRange);
    CHECK_TRUE(read(0, 16) == std::vector(16, std::byte{0xFF}));
  }

 private:
  using StoreResult = hal::StoreResult;
  auto& store() { return bench_.store(); }

  std::vector<std::byte> read(std::size_t offset, std::size_t length) {
    std::vector<std::byte> bytes(length);
    CHECK_TRUE(store().read(offset, bytes) == StoreResult::kOk);
    return bytes;
  }

  static std::vector<std::byte> pattern(std::size_t length) {
    std::vector<std::byte> bytes(length);
    for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<std::byte>(i % 251);
    return bytes;
  }

  Bench bench_;
};

}  // namespace strainfinger::contract

#define NON_VOLATILE_CONTRACT(Backend, Bench)                                                      \
  TEST_GROUP(NonVolatile_##Backend) {                                                              \
    strainfinger::contract::NonVolatileContract<Bench> contract;                                   \
  };                                                                                               \
  TEST(NonVolatile_##Backend, ErasedBytesReadAsOnes) { contract.erasedBytesReadAsOnes(); }         \
  TEST(NonVolatile_##Backend, WhatIsWrittenIsReadBackInAnyRange) {                                 \
    contract.whatIsWrittenIsReadBackInAnyRange();                                                  \
  }                                                                                                \
  TEST(NonVolatile_##Backend, TheWholeStoreCanBeWritten) { contract.theWholeStoreCanBeWritten(); } \
  TEST(NonVolatile_##Backend, WritingOverWrittenBytesIsRefusedAndTouchesNothing) {                 \
    contract.writingOverWrittenBytesIsRefusedAndTouchesNothing();                                  \
  }                                                                                                \
  TEST(NonVolatile_##Backend, ErasingClearsItsPageOnly) { contract.erasingClearsItsPageOnly(); }   \
  TEST(NonVolatile_##Backend, WhatLiesOutsideIsRefused) { contract.whatLiesOutsideIsRefused(); }   \
  TEST(NonVolatile_##Backend, PartsOfAUnitAreNotWritten) { contract.partsOfAUnitAreNotWritten(); }
