#pragma once
// FDCAN1 and its message memory: RM0440 chapter 44.

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::stm32g431 {

/// RM0440 section 44.4.
struct Fdcan {
  static constexpr std::uint32_t base = 0x4000'6400;

  struct Dbtp : Register<base + 0x0C> {  ///< data phase of CAN FD; all lengths less 1
    static constexpr Field<Dbtp, 0, 4> jump{};
    static constexpr Field<Dbtp, 4, 4> segment2{};
    static constexpr Field<Dbtp, 8, 5> segment1{};
    static constexpr Field<Dbtp, 16, 5> prescaler{};
  };
  struct Cccr : Register<base + 0x18> {
    static constexpr Field<Cccr, 0> init{};          ///< off the bus; set by hardware at bus-off
    static constexpr Field<Cccr, 1> configurable{};  ///< CCE: only together with init; clears the TX buffers
    static constexpr Field<Cccr, 8> fd{};
    static constexpr Field<Cccr, 9> bitRateSwitch{};
  };
  struct Nbtp : Register<base + 0x1C> {  ///< all lengths less 1
    static constexpr Field<Nbtp, 0, 7> segment2{};
    static constexpr Field<Nbtp, 8, 8> segment1{};
    static constexpr Field<Nbtp, 16, 9> prescaler{};
    static constexpr Field<Nbtp, 25, 7> jump{};
  };
  struct Ecr : Register<base + 0x40> {
    static constexpr Field<Ecr, 0, 8> txErrors{};
    static constexpr Field<Ecr, 8, 7> rxErrors{};
    static constexpr Field<Ecr, 15> rxPassive{};  ///< rxErrors has gone over 127
  };
  struct Psr : Register<base + 0x44> {
    static constexpr Field<Psr, 5> passive{};
    static constexpr Field<Psr, 6> warning{};
    static constexpr Field<Psr, 7> busOff{};
  };
  struct Ir : Register<base + 0x50> {
    static constexpr Field<Ir, 2> fifo0Lost{};  ///< RF0L; cleared by writing 1
  };
  struct Rxgfc : Register<base + 0x80> {
    static constexpr Field<Rxgfc, 0> rejectExtendedRemote{};
    static constexpr Field<Rxgfc, 1> rejectStandardRemote{};
    static constexpr Field<Rxgfc, 2, 2> otherExtended{};   ///< frames that no filter takes: Others
    static constexpr Field<Rxgfc, 4, 2> otherStandard{};   ///< the same
    static constexpr Field<Rxgfc, 16, 5> standardCount{};  ///< filters in use
  };
  enum Others : std::uint32_t { kToFifo0 = 0, kReject = 2 };
  struct Rxf0s : Register<base + 0x90> {
    static constexpr Field<Rxf0s, 0, 4> level{};
    static constexpr Field<Rxf0s, 8, 2> getIndex{};
  };
  struct Rxf0a : Register<base + 0x94> {
    static constexpr Field<Rxf0a, 0, 3> index{};
  };
  struct Txbc : Register<base + 0xC0> {
    static constexpr Field<Txbc, 24> queue{};  ///< lowest identifier first, instead of order of requests
  };
  struct Txfqs : Register<base + 0xC4> {
    static constexpr Field<Txfqs, 16, 2> putIndex{};
    static constexpr Field<Txfqs, 21> full{};
  };
  /// One bit a TX buffer each.
  struct Txbrp : Register<base + 0xC8> {};  ///< waiting or being sent
  struct Txbar : Register<base + 0xCC> {};  ///< write 1: send
  struct Txbcr : Register<base + 0xD0> {};  ///< write 1: don't, if it has not begun
  struct Txbto : Register<base + 0xD4> {};  ///< sent; cleared by the next request
  struct Txbcf : Register<base + 0xD8> {};  ///< cancelled, or done anyhow; cleared by the next request
};

/// FDCAN1's part of the message memory, RM0440 section 44.3.3. Words only.
struct MessageRam {
  static constexpr std::uint32_t base = 0x4000'A400;
  static constexpr std::uint32_t elementBytes = 18 * 4;
  static constexpr std::uint32_t elements = 3;  ///< of each FIFO and of the TX buffers
  static constexpr std::uint32_t standardFilters = 28;

  static constexpr std::uint32_t filter(std::uint32_t index) { return base + 4 * index; }
  static constexpr std::uint32_t fifo0(std::uint32_t index) { return base + 0xB0 + elementBytes * index; }
  static constexpr std::uint32_t tx(std::uint32_t index) { return base + 0x278 + elementBytes * index; }
};

/// Words of the message memory: fields of a register without an address of its own.
struct Element0 : Register<0> {  ///< first word of a frame
  static constexpr Field<Element0, 18, 11> standardId{};
  static constexpr Field<Element0, 29> remote{};
  static constexpr Field<Element0, 30> extended{};
};
struct Element1 : Register<4> {  ///< second word of a frame; data follow, lowest byte first
  static constexpr Field<Element1, 16, 4> length{};
  static constexpr Field<Element1, 21> fd{};
};
struct StandardFilter : Register<0> {
  static constexpr Field<StandardFilter, 0, 11> id2{};
  static constexpr Field<StandardFilter, 16, 11> id1{};
  static constexpr Field<StandardFilter, 27, 3> action{};
  static constexpr Field<StandardFilter, 30, 2> type{};
  static constexpr std::uint32_t kToFifo0 = 1;
  static constexpr std::uint32_t kEither = 1;  ///< id1 or id2
};

}  // namespace strainfinger::stm32g431
