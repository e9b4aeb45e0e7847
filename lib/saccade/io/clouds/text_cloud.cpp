// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/text_cloud.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "saccade/io/clouds/internal/text_column.hpp"
#include "saccade/io/clouds/internal/unnamed_columns.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

constexpr std::size_t kMaxColumns{1024};
constexpr std::array<std::string_view, 10> kFloating{"x",  "y",        "z",        "nx",       "ny",
                                                     "nz", "normal_x", "normal_y", "normal_z", "intensity"};
constexpr std::array<std::string_view, 9> kOtherKnown{"r", "g", "b", "red", "green", "blue", "rgb", "rgba", "label"};

template <std::size_t N>
bool is_among(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string lower_case(std::string_view text) {
  std::string lower{text};
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

/// Returns a name that other formats can hold too: without quotes and blanks; known names in lower case.
std::string column_name(std::string_view field, std::size_t column) {
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
  std::string name{trimmed(field)};
  for (char& c : name) c = static_cast<unsigned char>(c) <= ' ' ? '_' : c;
  const std::string lower = lower_case(name);
  if (is_among(kFloating, lower) || is_among(kOtherKnown, lower)) return lower;
  return name.empty() ? "value" + std::to_string(column) : name;
}

std::vector<std::string> column_names(std::string_view line) {
  std::vector<std::string> names;
  FieldScanner fields{line, separator_of(line)};
  while (const auto field = fields.next()) names.push_back(column_name(*field, names.size()));
  return names;
}

bool have_positions(const std::vector<std::string>& names) {
  const auto has = [&](std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  return has("x") && has("y") && has("z");
}

/// Returns a number's text with its decimal comma, if it has one, as a point. A second comma stays: the text is then
/// not a number.
std::string_view with_point(std::string_view token, std::string& buffer) {
  const std::size_t comma = token.find(',');
  if (comma == std::string_view::npos) return token;
  buffer = token;
  buffer[comma] = '.';
  return buffer;
}

bool are_numbers(std::string_view line, char separator, bool decimal_comma = false) {
  FieldScanner fields{line, separator};
  std::string buffer;
  while (const auto field = fields.next()) {
    if (!parse_number(decimal_comma ? with_point(*field, buffer) : *field)) return false;
  }
  return true;
}

/// Returns what separates the numbers of a row, possibly with decimal commas; nullopt where it holds anything else.
/// `header`: the separator of the names above it.
std::optional<char> separator_of_row(std::string_view line, std::optional<char> header = {}) {
  const char own = header.value_or(separator_of(line));
  if (are_numbers(line, own)) return own;
  const char other = own == ',' ? kBlankSeparator : own;
  if (line.find('.') == std::string_view::npos && are_numbers(line, other, true)) return other;
  return std::nullopt;
}

/// Tells whether commas probably stand for points between commas: "0,024, 0,901, -0,036", or "0,024,0,901,0,036",
/// where digits follow a comma that no number begins with.
bool has_commas_of_both_kinds(std::string_view line) {
  if (line.find('.') != std::string_view::npos) return false;
  bool alternating{true};
  std::size_t commas{0};
  for (std::size_t i = line.find(','); i < line.size(); i = line.find(',', i + 1), ++commas) {
    const std::string_view rest = line.substr(i + 1);
    if (rest.size() > 1 && rest[0] == '0' && rest[1] >= '0' && rest[1] <= '9') return true;
    const bool blank = !rest.empty() && kBlanks.find(rest[0]) != std::string_view::npos;
    alternating = alternating && blank == (commas % 2 == 1);
  }
  return alternating && commas % 2 == 1 && commas > 4;  // three numbers or more
}

/// Returns the number of points, when the line holds nothing else.
std::optional<std::size_t> point_count(std::string_view line) { return parse_integer<std::size_t>(trimmed(line)); }

bool within(const TextColumn& column, double most) {
  const auto range = column.whole_range();
  return range && range->first >= 0.0 && range->second <= most;
}

class TextCloudParser {
 public:
  explicit TextCloudParser(std::string_view text) : text_{text}, lines_{text_} {}

  [[nodiscard]] Result<TextCloud> parse() {
    while (const auto line = lines_.next()) {
      if (is_comment(*line)) {
        if (columns_.empty() && names_.empty()) note_comment(*line);
        continue;
      }
      SACCADE_CHECK(columns_.empty() ? first_lines(*line) : row(*line));
    }
    if (columns_.empty()) return Error{Errc::corrupt_data, "the file holds no points", {}};
    if (count_ && *count_ != rows_) {
      return fail("the file says that it holds " + std::to_string(*count_) + " points, but it holds " +
                  std::to_string(rows_));
    }
    return finish();
  }

 private:
  [[nodiscard]] Error fail(std::string what) const { return bad_line(lines_.line(), std::move(what)); }

  /// Notes the names in a comment; the number of columns is known later.
  void note_comment(std::string_view line) {
    std::vector<std::string> names = column_names(comment_text(line));
    if (!have_positions(names)) return;
    comment_names_ = std::move(names);
    comment_line_ = lines_.line();
  }

  [[nodiscard]] Status first_lines(std::string_view line) {
    if (names_.empty() && !count_ && (count_ = point_count(line))) return {};
    const auto separator = separator_of_row(line, names_.empty() ? std::nullopt : std::optional{cloud_.separator});
    if (names_.empty() && !separator) {
      cloud_.separator = separator_of(line);
      names_ = column_names(line);
      cloud_.header_line = lines_.line();
      if (!have_positions(names_))
        return fail("no point cloud in text: neither a row of numbers nor names of columns with x, y and z");
      return {};
    }
    if (separator) cloud_.separator = *separator;
    if (cloud_.separator == ',' && has_commas_of_both_kinds(line)) {
      return fail(
          "decimal commas between commas cannot be told from columns; separate the columns by semicolons or "
          "blanks, or write points");
    }
    const std::size_t columns = fields_of(line, cloud_.separator).size();
    if (columns < 3) return fail("a point has at least three numbers, but here are " + std::to_string(columns));
    if (columns > kMaxColumns) {
      return Error{Errc::unsupported, "more than " + std::to_string(kMaxColumns) + " columns",
                   "line " + std::to_string(lines_.line())};
    }
    if (names_.empty() && comment_names_.size() == columns) {
      names_ = std::move(comment_names_);
      cloud_.header_line = comment_line_;
    }
    cloud_.first_row_line = lines_.line();
    columns_.resize(columns);
    const std::size_t expected = (text_.size() - lines_.offset()) / (line.size() + 1) + 1;
    for (TextColumn& column : columns_) column.reserve(expected);
    return row(line);
  }

  [[nodiscard]] Status row(std::string_view line) {
    FieldScanner fields{line, cloud_.separator};
    std::size_t read{0};
    while (const auto field = fields.next()) {
      if (read < columns_.size() && !append(columns_[read], *field)) {
        return fail(field->empty() ? "a number is missing" : in_quotes(*field) + " is not a number");
      }
      ++read;
    }
    if (read != columns_.size() || (!names_.empty() && read != names_.size())) {
      const std::size_t expected = names_.empty() ? columns_.size() : names_.size();
      return fail("this row has " + std::to_string(read) + " numbers where " + std::to_string(expected) +
                  " are expected");
    }
    ++rows_;
    return {};
  }

  /// Appends a number, with a decimal comma where commas do not separate and no number before had a point.
  [[nodiscard]] bool append(TextColumn& column, std::string_view field) {
    if (cloud_.decimal_comma && field.find('.') != std::string_view::npos) return false;
    if (column.append(field)) return true;
    if (cloud_.separator == ',' || field.find(',') == std::string_view::npos) return false;
    const auto is_whole = [](const TextColumn& each) { return each.is_spelled_whole(); };
    if (!cloud_.decimal_comma && !std::all_of(columns_.begin(), columns_.end(), is_whole)) return false;
    cloud_.decimal_comma = true;
    return column.append(with_point(field, buffer_));
  }

  [[nodiscard]] std::vector<std::string> default_names() const {
    constexpr double kMost{255.0};
    const std::size_t n = columns_.size();
    if (n != 6 && n != 7) return unnamed_columns(n, Triple::none);
    if (std::all_of(columns_.end() - 3, columns_.end(), [](const TextColumn& c) { return within(c, kMost); })) {
      return unnamed_columns(n, Triple::colors_255);
    }
    return unnamed_columns(
        n, meaning_of(rows_, [&](std::size_t row, std::size_t k) { return columns_[n - 3 + k].value(row); }));
  }

  /// Returns one type for the three channels of a colour; nullopt where they are not integers of 8 or 16 bits.
  [[nodiscard]] std::optional<ColumnType> color_type(const std::array<std::size_t, 3>& channels) const {
    constexpr std::array<std::pair<ColumnType, double>, 2> kTypes{
        {{ColumnType::u8, 255.0}, {ColumnType::u16, 65535.0}}};
    const auto all = [&](auto holds) {
      return std::all_of(channels.begin(), channels.end(), [&](std::size_t i) { return holds(columns_[i]); });
    };
    // 0.0 and 1.0 may be shares of 1.
    if (all([](const TextColumn& column) { return !column.is_spelled_whole() && within(column, 1.0); })) return {};
    for (const auto& [type, most] : kTypes) {
      if (all([most = most](const TextColumn& column) { return within(column, most); })) return type;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<ColumnType> types() const {
    std::vector<ColumnType> types;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      types.push_back(columns_[i].type(is_among(kFloating, names_[i])));
    }
    constexpr std::array<std::array<std::string_view, 3>, 2> kColors{{{"r", "g", "b"}, {"red", "green", "blue"}}};
    for (const auto& names : kColors) {
      std::array<std::size_t, 3> channels{};
      for (std::size_t k = 0; k < 3; ++k) {
        channels[k] = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), names[k]) - names_.begin());
      }
      if (std::find(channels.begin(), channels.end(), names_.size()) != channels.end()) continue;
      const auto is_whole = [&](std::size_t channel) { return columns_[channel].is_spelled_whole(); };
      const bool shares = !std::all_of(channels.begin(), channels.end(), is_whole);
      const auto type = color_type(channels);
      for (const std::size_t channel : channels) {
        if (type || shares) types[channel] = type.value_or(columns_[channel].type(true));
      }
    }
    return types;
  }

  [[nodiscard]] TextCloud finish() {
    if (names_.empty()) names_ = default_names();
    const std::vector<ColumnType> kept_as = types();
    cloud_.table.rows = rows_;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      cloud_.table.columns.push_back(std::move(columns_[i]).release(std::move(names_[i]), kept_as[i]));
    }
    return std::move(cloud_);
  }

  std::string_view text_;
  LineScanner lines_;
  TextCloud cloud_;
  std::optional<std::size_t> count_;
  std::vector<std::string> names_;
  std::vector<std::string> comment_names_;
  std::size_t comment_line_{0};
  std::vector<TextColumn> columns_;
  std::size_t rows_{0};
  std::string buffer_;  ///< text of a number that had a decimal comma
};

}  // namespace

bool has_text_cloud_suffix(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 7> kSuffixes{".xyz", ".txt", ".csv", ".pts", ".asc", ".xyzn", ".xyzrgb"};
  return is_among(kSuffixes, lower_case(path.extension().string()));
}

bool looks_like_text_cloud(std::string_view head) {
  LineScanner lines{without_byte_order_mark(head)};
  bool counted{false};
  while (const auto line = lines.next()) {
    if (is_comment(*line)) continue;
    if (!counted && point_count(*line)) {
      counted = true;
      continue;
    }
    if (const auto separator = separator_of_row(*line)) return fields_of(*line, *separator).size() >= 3;
    return have_positions(column_names(*line));
  }
  return counted;
}

Result<TextCloud> parse_text_cloud(std::vector<std::byte> file) {
  SACCADE_TRY(TextCloud cloud, TextCloudParser{without_byte_order_mark(as_text(file))}.parse());
  cloud.file = std::move(file);
  return cloud;
}

}  // namespace saccade
