// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/ply_header.hpp"

#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

/// PLY has no integers of 64 bits. Each type has two names; the first is written.
constexpr auto kTypeNames = make_some_names<ColumnType>({{ColumnType::i8, "char"},
                                                         {ColumnType::u8, "uchar"},
                                                         {ColumnType::i16, "short"},
                                                         {ColumnType::u16, "ushort"},
                                                         {ColumnType::i32, "int"},
                                                         {ColumnType::u32, "uint"},
                                                         {ColumnType::f32, "float"},
                                                         {ColumnType::f64, "double"},
                                                         {ColumnType::i8, "int8"},
                                                         {ColumnType::u8, "uint8"},
                                                         {ColumnType::i16, "int16"},
                                                         {ColumnType::u16, "uint16"},
                                                         {ColumnType::i32, "int32"},
                                                         {ColumnType::u32, "uint32"},
                                                         {ColumnType::f32, "float32"},
                                                         {ColumnType::f64, "float64"}});

/// The words of one header line.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  TokenScanner tokens{line, " \t"};
  while (const auto token = tokens.next()) words.push_back(*token);
  return words;
}

class PlyHeaderParser {
 public:
  explicit PlyHeaderParser(std::string_view text) : lines_{text} {}

  [[nodiscard]] Result<PlyHeader> parse() {
    const auto magic = lines_.next();
    if (!magic || words_of(*magic) != std::vector<std::string_view>{"ply"}) {
      return Error{Errc::corrupt_data, "not a PLY file", "line 1"};
    }
    while (const auto line = lines_.next()) {
      const auto words = words_of(*line);
      if (words.empty() || words[0] == "obj_info") continue;
      if (words[0] == "end_header") return finish();
      if (words[0] == "comment") {
        const std::size_t skipped = line->find("comment") + 7;
        header_.file.comments.emplace_back(line->substr(std::min(line->size(), skipped + 1)));
      } else {
        SACCADE_CHECK(statement(words));
      }
    }
    return fail("the header does not end");
  }

 private:
  [[nodiscard]] Error fail(std::string what) const {
    return {Errc::corrupt_data, std::move(what), "line " + std::to_string(lines_.line())};
  }

  [[nodiscard]] Result<PlyHeader> finish() {
    if (!has_format_) return fail("the header names no format");
    header_.body_offset = lines_.offset();
    header_.body_line = lines_.line() + 1;
    return std::move(header_);
  }

  [[nodiscard]] Status statement(const std::vector<std::string_view>& words) {
    if (words[0] == "format" && words.size() == 3) return format(words);
    if (words[0] == "element" && words.size() == 3) return element(words);
    if (words[0] == "property" && words.size() == 3) return scalar(words);
    if (words[0] == "property" && words.size() == 5 && words[1] == "list") return list(words);
    return fail("not a statement of a PLY header: " + in_quotes(words[0]));
  }

  [[nodiscard]] Status format(const std::vector<std::string_view>& words) {
    const auto known = kPlyFormatNames.find(words[1]);
    if (!known || words[2] != "1.0") {
      return Error{Errc::unsupported, "unknown format " + in_quotes(words[1]) + " " + in_quotes(words[2]),
                   "line " + std::to_string(lines_.line())};
    }
    header_.file.format = *known;
    has_format_ = true;
    return {};
  }

  [[nodiscard]] Status element(const std::vector<std::string_view>& words) {
    const auto rows = parse_integer<std::size_t>(words[2]);
    if (!rows) return fail("not a number of rows: " + in_quotes(words[2]));
    PlyElement element;
    element.name = words[1];
    element.table.rows = *rows;
    header_.file.elements.push_back(std::move(element));
    return {};
  }

  [[nodiscard]] Status scalar(const std::vector<std::string_view>& words) {
    const auto type = kTypeNames.find(words[1]);
    if (!type) return fail("unknown type " + in_quotes(words[1]));
    if (header_.file.elements.empty()) return fail("a property before any element");
    PlyElement& element = header_.file.elements.back();
    element.order.push_back(static_cast<int>(element.table.columns.size()));
    element.table.columns.push_back({std::string{words[2]}, *type, 1, {}});
    return {};
  }

  [[nodiscard]] Status list(const std::vector<std::string_view>& words) {
    const auto count_type = kTypeNames.find(words[2]);
    const auto type = kTypeNames.find(words[3]);
    if (!count_type || !type) return fail("unknown type " + in_quotes(count_type ? words[3] : words[2]));
    if (*count_type == ColumnType::f32 || *count_type == ColumnType::f64) return fail("a list with a fractional count");
    if (header_.file.elements.empty()) return fail("a property before any element");
    PlyElement& element = header_.file.elements.back();
    element.order.push_back(-1 - static_cast<int>(element.lists.size()));
    element.lists.push_back({std::string{words[4]}, *count_type, {std::string{words[4]}, *type, 1, {}}, {}});
    return {};
  }

  LineScanner lines_;
  PlyHeader header_;
  bool has_format_{false};
};

}  // namespace

Result<PlyHeader> parse_ply_header(std::string_view text) { return PlyHeaderParser{text}.parse(); }

std::vector<int> property_order(const PlyElement& element) {
  if (!element.order.empty()) return element.order;
  std::vector<int> order;
  for (std::size_t i = 0; i < element.table.columns.size(); ++i) order.push_back(static_cast<int>(i));
  for (std::size_t i = 0; i < element.lists.size(); ++i) order.push_back(-1 - static_cast<int>(i));
  return order;
}

std::string ply_header_text(const PlyFile& file, PlyFormat format) {
  std::string text{"ply\nformat "};
  text.append(kPlyFormatNames.of(format)).append(" 1.0\n");
  for (const std::string& comment : file.comments) text += "comment " + comment + "\n";
  for (const PlyElement& element : file.elements) {
    text += "element " + element.name + " " + std::to_string(element.table.rows) + "\n";
    for (const int index : property_order(element)) {
      if (index >= 0) {
        const Column& column = element.table.columns[static_cast<std::size_t>(index)];
        text.append("property ").append(kTypeNames.of(column.type)).append(" ").append(column.name).append("\n");
      } else {
        const PlyList& list = element.lists[static_cast<std::size_t>(-1 - index)];
        text.append("property list ").append(kTypeNames.of(list.count_type)).append(" ");
        text.append(kTypeNames.of(list.values.type)).append(" ").append(list.name).append("\n");
      }
    }
  }
  return text + "end_header\n";
}

}  // namespace saccade
