// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/nearest_word.hpp"

#include <algorithm>
#include <vector>

namespace saccade {
namespace {

constexpr std::size_t kLettersPerError{3};
constexpr std::size_t kLongestWord{64};

/// Counts the typing errors between two words: the optimal string alignment distance.
std::size_t typing_errors(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above.back();
}

}  // namespace

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known) {
  std::string_view nearest;
  if (word.empty() || word.size() > kLongestWord) return nearest;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / kLettersPerError) + 1;
  for (const std::string_view candidate : known) {
    if (candidate.size() > kLongestWord || candidate.empty()) continue;
    const std::size_t errors = typing_errors(word, candidate);
    if (errors >= fewest || errors >= candidate.size()) continue;
    fewest = errors;
    nearest = candidate;
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view nearest = nearest_word(word, known);
  return nearest.empty() ? std::string{} : "; did you mean " + std::string{nearest} + "?";
}

}  // namespace saccade
