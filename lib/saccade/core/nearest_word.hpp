// SPDX-License-Identifier: Apache-2.0
#pragma once
// nearest_word, did_you_mean: the known word that a mistyped one most likely stands for.

#include <span>
#include <string>
#include <string_view>

namespace saccade {

/// Returns the known word with the fewest typing errors (a letter added, left out, replaced, or swapped with its
/// neighbour); the first of equally near ones. Empty where none is near: more than one error for each three letters.
[[nodiscard]] std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known);

/// Returns "; did you mean WORD?" with the nearest word, or nothing where none is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> known);

}  // namespace saccade
