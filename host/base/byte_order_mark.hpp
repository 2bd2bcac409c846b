#pragma once

#include <string_view>

namespace strainfinger {

/// UTF-8's, as spreadsheets and editors begin their files.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace strainfinger
