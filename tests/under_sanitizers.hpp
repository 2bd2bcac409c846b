#pragma once
// What the sanitized copy of a test leaves to the plain one: the sanitizers take ten times as long and see
// after an eighth of the cases what they would see after all.

namespace strainfinger {

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// Random cases that a test draws, of so many in the plain copy.
constexpr int randomCases(int plain) { return kSanitized ? (plain + 7) / 8 : plain; }

}  // namespace strainfinger
