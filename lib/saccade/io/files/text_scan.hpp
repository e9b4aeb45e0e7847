// SPDX-License-Identifier: Apache-2.0
#pragma once
// LineScanner and TokenScanner walk borrowed text; parse_number and parse_integer read one token; in_quotes shows it.

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

namespace saccade {

/// Goes through the lines of a text; "\n" and "\r\n" both end a line. Borrows the text.
class LineScanner {
 public:
  explicit LineScanner(std::string_view text) : text_{text} {}
  /// nullopt at the end.
  [[nodiscard]] std::optional<std::string_view> next() {
    if (offset_ >= text_.size()) return std::nullopt;
    const std::size_t end = std::min(text_.find('\n', offset_), text_.size());
    std::string_view line = text_.substr(offset_, end - offset_);
    offset_ = end + 1;
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }
  /// Number of the line delivered last, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }
  /// Byte after the line delivered last.
  [[nodiscard]] std::size_t offset() const { return std::min(offset_, text_.size()); }

 private:
  std::string_view text_;
  std::size_t offset_{0};
  std::size_t line_{0};
};

/// Goes through the tokens of a text, separated by any of `separators`. Borrows both.
class TokenScanner {
 public:
  explicit TokenScanner(std::string_view text, std::string_view separators = " \t\r\n,")
      : rest_{text}, separators_{separators} {}
  [[nodiscard]] std::optional<std::string_view> next() {
    const std::size_t begin = rest_.find_first_not_of(separators_);
    if (begin == std::string_view::npos) return std::nullopt;
    const std::size_t end = std::min(rest_.find_first_of(separators_, begin), rest_.size());
    const std::string_view token = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return token;
  }

 private:
  std::string_view rest_;
  std::string_view separators_;
};

/// The whole token as a number ("nan" and "inf" included), or nullopt.
template <std::floating_point T = double>
[[nodiscard]] std::optional<T> parse_number(std::string_view token) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  T value{};
  const auto [end, status] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size()) return std::nullopt;
  if (status == std::errc::result_out_of_range) {  // too small is 0, too large is infinity
    const std::string copy{token};
    return sizeof(T) == sizeof(float) ? static_cast<T>(std::strtof(copy.c_str(), nullptr))
                                      : static_cast<T>(std::strtod(copy.c_str(), nullptr));
  }
  if (status != std::errc{}) return std::nullopt;
  return value;
}

/// The whole token as a decimal integer that fits T, or nullopt.
template <class T>
[[nodiscard]] std::optional<T> parse_integer(std::string_view token) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  T value{};
  const auto [end, status] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (status != std::errc{} || end != token.data() + token.size()) return std::nullopt;
  return value;
}

/// The token in quotes for a message, cut to 40 characters.
[[nodiscard]] inline std::string in_quotes(std::string_view token) {
  constexpr std::size_t kShown{40};
  std::string text{'\''};
  text.append(token.substr(0, kShown)).push_back('\'');
  return text;
}

}  // namespace saccade
