// SPDX-License-Identifier: Apache-2.0
#pragma once
// Text read token by token: LineScanner, TokenScanner, FieldScanner (one line of a table), numbers, number_lines; and
// text from elsewhere made fit for one line of a message.

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

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

inline constexpr std::string_view kBlanks{" \t"};

/// The separator that stands for any number of blanks and tabs.
inline constexpr char kBlankSeparator{' '};

[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  text.remove_prefix(begin);
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// Some programs put three bytes in front that say that it is UTF-8.
[[nodiscard]] inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark{"\xEF\xBB\xBF"};
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

/// A line that says nothing, or one that starts with # or //.
[[nodiscard]] inline bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text.empty() || text.front() == '#' || text.starts_with("//");
}

/// Returns a line without its comment mark.
[[nodiscard]] inline std::string_view comment_text(std::string_view line) {
  return line.substr(std::min(line.find_first_not_of(" \t#/"), line.size()));
}

/// Returns ; where the line has one, otherwise a comma where it has one, otherwise a blank.
[[nodiscard]] inline char separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  return line.find(',') != std::string_view::npos ? ',' : kBlankSeparator;
}

/// Scanner of a line's fields. Fields between commas or semicolons may be empty; nothing follows the last one. Borrows
/// the line.
class FieldScanner {
 public:
  FieldScanner(std::string_view line, char separator) : rest_{line}, separator_{separator} {}
  [[nodiscard]] std::optional<std::string_view> next() {
    std::size_t begin{0};
    while (begin < rest_.size() && (rest_[begin] == ' ' || rest_[begin] == '\t')) ++begin;
    rest_.remove_prefix(begin);
    if (rest_.empty()) return std::nullopt;
    std::size_t end{0};
    while (end < rest_.size() && !ends_field(rest_[end])) ++end;
    const std::string_view field = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return separator_ == kBlankSeparator ? field : trimmed(field);
  }

 private:
  [[nodiscard]] bool ends_field(char c) const {
    return c == separator_ || (separator_ == kBlankSeparator && c == '\t');
  }

  std::string_view rest_;
  char separator_;
};

[[nodiscard]] inline std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  FieldScanner scanner{line, separator};
  while (const auto field = scanner.next()) fields.push_back(*field);
  return fields;
}

/// Numbers of one line, separated by blanks or commas.
struct NumberLine {
  std::size_t line{0};  ///< from 1
  std::vector<double> values;
};

/// Reads the remaining lines that are neither blank nor comments ('#' to the end of the line). Answers corrupt_data
/// with the line for a word that is not a number.
[[nodiscard]] Result<std::vector<NumberLine>> number_lines(LineScanner& lines);
[[nodiscard]] Result<std::vector<NumberLine>> number_lines(std::string_view text);

/// Returns corrupt_data at a line.
[[nodiscard]] Error bad_line(std::size_t line, std::string what);

/// Returns the first max_bytes of arbitrary text in readable form: control characters become blanks, bytes that are not
/// UTF-8 become '?', and "..." marks a cut. Always valid UTF-8.
[[nodiscard]] std::string readable(std::string_view text, std::size_t max_bytes);

/// Returns the last lines of a text, at most three, joined by " | ", each made readable; empty for an empty text.
[[nodiscard]] std::string last_lines(std::string_view text);

}  // namespace saccade
