#pragma once
// What a fuzz target reads its bytes with.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace strainfinger::fuzz {

/// Numbers from the front of the bytes, low byte first; zeros behind their end, so that every input is one.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool isAtEnd() const { return bytes_.empty(); }

  template <typename Value>
  Value any() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value{};
    const std::size_t size = bytes_.size() < sizeof value ? bytes_.size() : sizeof value;
    if (size > 0) std::memcpy(&value, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
    return value;
  }
  /// least .. most.
  template <typename Integer = int>
  Integer within(Integer least, std::type_identity_t<Integer> most) {
    const auto ways = static_cast<std::uint64_t>(std::int64_t{most} - least) + 1;
    const std::uint64_t number = ways <= 256     ? any<std::uint8_t>()
                                 : ways <= 65536 ? any<std::uint16_t>()
                                                 : any<std::uint32_t>();
    return static_cast<Integer>(least + static_cast<std::int64_t>(number % ways));
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace strainfinger::fuzz
