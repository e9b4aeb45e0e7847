// SPDX-License-Identifier: Apache-2.0
#pragma once
// scaled_cases: how many random cases a property test runs; fewer under sanitizers, which cost a factor of 3 to 15.

namespace saccade::test {

#if defined(__has_feature)  // clang; g++ has macros
#if __has_feature(address_sanitizer)
#define SACCADE_TEST_SANITIZES_ADDRESSES
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define SACCADE_TEST_SANITIZES_ADDRESSES
#endif

#if defined(__SANITIZE_THREAD__)
constexpr int kEffortDivisor{12};
#elif defined(SACCADE_TEST_SANITIZES_ADDRESSES)
constexpr int kEffortDivisor{8};
#else
constexpr int kEffortDivisor{1};
#endif

constexpr bool kSanitized{kEffortDivisor > 1};

/// At least one case; the tests assert that this many ran.
[[nodiscard]] constexpr int scaled_cases(int cases) { return cases / kEffortDivisor > 0 ? cases / kEffortDivisor : 1; }

}  // namespace saccade::test
