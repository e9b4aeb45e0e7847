// SPDX-License-Identifier: Apache-2.0
#pragma once
// The simplest loops that use up one thing that a machine has: bandwidth, arithmetic, look-ups.

#include <cstddef>
#include <cstdint>
#include <span>

namespace saccade::bench {

/// A result, so that the work is done, and how much work it was.
struct Work {
  float value{0.0F};
  std::size_t operations{0};
};

/// Reads every value once.
[[nodiscard]] Work sum_of(std::span<const float> values);
/// Multiplications and additions on independent numbers in registers, each rounded by itself as in the library.
[[nodiscard]] Work multiply_and_add(std::size_t rounds);
/// Looks up places of a table all over it, none of which depends on what was found before. `table` has a power of two
/// of entries.
[[nodiscard]] Work look_up(std::span<const std::int32_t> table, std::size_t rounds);

}  // namespace saccade::bench
