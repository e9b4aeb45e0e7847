// SPDX-License-Identifier: Apache-2.0
#pragma once
// FieldScanner: the fields of one line of a table in text; comment lines and the separator of fields.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace saccade {

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

/// A line without what makes it a comment.
[[nodiscard]] inline std::string_view comment_text(std::string_view line) {
  return line.substr(std::min(line.find_first_not_of(" \t#/"), line.size()));
}

/// ; where the line has one, else a comma where it has one, else blanks.
[[nodiscard]] inline char separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  return line.find(',') != std::string_view::npos ? ',' : kBlankSeparator;
}

/// Goes through the fields of a line. Between commas or semicolons a field may be empty; nothing after the last one is
/// no field. Borrows the line.
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

}  // namespace saccade
