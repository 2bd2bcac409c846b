#pragma once
// What people are told beside the data, on stderr.

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace strainfinger {

/// What a terminal would obey, or not show, as \xHH: all control characters but line ends and tabs, and what
/// is no UTF-8. Those of Latin-1's upper half are C2 80 to C2 9F in UTF-8.
std::string printable(std::string_view text);

/// Writes the text, as printable() has it, to stderr. Where that takes nothing (closed, a full disk) the job
/// goes on all the same: the exit status still tells.
void tell(std::string_view text) noexcept;

/// The same of a text with values in it.
template <typename First, typename... More>
void tell(fmt::format_string<First, More...> text, First&& first, More&&... more) {
  tell(fmt::format(text, std::forward<First>(first), std::forward<More>(more)...));
}

}  // namespace strainfinger
