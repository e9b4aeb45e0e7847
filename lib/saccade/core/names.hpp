// SPDX-License-Identifier: Apache-2.0
#pragma once
// Names: the words for the values of an enum, written once for texts, files and options. joined, listed: words in a
// row.

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace saccade {

/// Joins the texts of items: "a, b, c".
template <class Items, class Text = std::identity>
[[nodiscard]] std::string joined(const Items& items, std::string_view between = ", ", const Text& text = {}) {
  std::string out;
  for (const auto& item : items) out.append(out.empty() ? std::string_view{} : between).append(std::invoke(text, item));
  return out;
}

/// Lists words for people: "a, b or c".
[[nodiscard]] inline std::string listed(std::span<const std::string_view> words) {
  if (words.size() < 2) return joined(words);
  return joined(words.first(words.size() - 1)).append(" or ").append(words.back());
}

/// Words for the values of a type, in the order in which they are listed. The first word of a value is its name;
/// further words are only read. Made by make_names.
template <class T, std::size_t N>
struct Names {
  std::array<T, N> values{};
  std::array<std::string_view, N> words{};

  /// Returns the name of a value, or "unknown" for a value without a name.
  [[nodiscard]] constexpr std::string_view of(const T& value) const {
    for (std::size_t i = 0; i < N; ++i) {
      if (values[i] == value) return words[i];
    }
    return "unknown";
  }

  /// Returns the value that a word stands for.
  [[nodiscard]] constexpr std::optional<T> find(std::string_view word) const {
    for (std::size_t i = 0; i < N; ++i) {
      if (words[i] == word) return values[i];
    }
    return std::nullopt;
  }

  /// Lists the words, for error messages.
  [[nodiscard]] std::string listed() const { return saccade::listed(words); }
};

/// Tells whether a value of an enum has an enumerator. The compiler spells other values as numbers.
template <auto kValue>
[[nodiscard]] consteval bool is_enumerator() {
  constexpr std::string_view kSpelled{__PRETTY_FUNCTION__};
  return kSpelled[kSpelled.find_last_of(": )", kSpelled.size() - 2) + 1] > '9';
}

/// Tells whether the table names every enumerator among the first N + 1 values of an enum.
template <class T, std::size_t N, std::size_t... kIndex>
[[nodiscard]] constexpr bool has_every(const Names<T, N>& names, std::index_sequence<kIndex...> /*values*/) {
  return ((!is_enumerator<static_cast<T>(kIndex)>() ||
           std::find(names.values.begin(), names.values.end(), static_cast<T>(kIndex)) != names.values.end()) &&
          ...);
}

/// Makes a table of words for some values. A constant table in which one word stands for two values does not compile.
template <class T, std::size_t N>
[[nodiscard]] constexpr Names<T, N> make_some_names(const std::pair<T, std::string_view> (&entries)[N]) {
  Names<T, N> names;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (names.words[k] == entries[i].second) throw "a word stands for two values";
    }
    names.values[i] = entries[i].first;
    names.words[i] = entries[i].second;
  }
  return names;
}

/// Makes a table: `inline constexpr auto kSideNames = make_names<Side>({{Side::left, "left"}, …});`. A constant table
/// does not compile when an enumerator has no word. Enumerators must count up from 0.
template <class T, std::size_t N>
[[nodiscard]] constexpr Names<T, N> make_names(const std::pair<T, std::string_view> (&entries)[N]) {
  const Names<T, N> names = make_some_names<T>(entries);
  if constexpr (std::is_enum_v<T>) {
    if (!has_every(names, std::make_index_sequence<N + 1>{})) throw "an enumerator has no word";
  }
  return names;
}

}  // namespace saccade
