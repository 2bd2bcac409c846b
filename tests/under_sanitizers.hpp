#pragma once
// What tests leave out under the sanitizers, which take ten times as long and see
// after an eighth of the cases what they would see after all.

namespace strainfinger {

inline constexpr bool kSanitized = STRAINFINGER_SANITIZED;

/// Random cases that a test draws, of so many without sanitizers.
constexpr int randomCases(int plain) { return kSanitized ? (plain + 7) / 8 : plain; }

}  // namespace strainfinger
