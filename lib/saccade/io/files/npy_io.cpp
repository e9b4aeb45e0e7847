// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/npy_io.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/little_endian.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/files/value_io.hpp"

namespace saccade {
namespace {

constexpr std::string_view kNpyMagic{"\x93NUMPY"};
constexpr std::size_t kMaxNpyColumns{1024};

Error unsupported(std::string what) { return {Errc::unsupported, std::move(what), {}}; }

/// Name of a field and NumPy's name of its type; the field of an array without fields has no name.
struct NamedType {
  std::string_view name;
  std::string_view type;
};

/// Content of the header: a Python dict of three entries.
class NpyDict {
 public:
  NpyDict(std::string_view text, std::size_t file_offset) : text_{text}, file_offset_{file_offset} {}

  [[nodiscard]] Status parse() {
    SACCADE_CHECK(expect('{'));
    while (!accept('}')) {
      SACCADE_TRY(const std::string_view key, quoted());
      SACCADE_CHECK(expect(':'));
      SACCADE_CHECK(entry(key));
      if (!accept(',')) {
        SACCADE_CHECK(expect('}'));
        break;
      }
    }
    if (fields_.empty() || !shape_) return fail("the header lacks the type or the shape");
    return {};
  }

  [[nodiscard]] const std::vector<NamedType>& fields() const { return fields_; }
  [[nodiscard]] bool is_structured() const { return structured_; }
  [[nodiscard]] bool is_fortran_order() const { return fortran_; }
  [[nodiscard]] const std::vector<std::size_t>& shape() const { return *shape_; }

 private:
  [[nodiscard]] Error fail(std::string what) const {
    return {Errc::corrupt_data, std::move(what), "byte " + std::to_string(file_offset_ + at_)};
  }
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }
  [[nodiscard]] bool accept(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  [[nodiscard]] Status expect(char c) {
    return accept(c) ? Status{} : Status{fail(std::string{"the header lacks a '"} + c + "' here")};
  }
  [[nodiscard]] std::string_view word() {
    skip_blanks();
    const std::size_t end = std::min(text_.find_first_of(" \t\n,:(){}", at_), text_.size());
    const std::string_view found = text_.substr(at_, end - at_);
    at_ = end;
    return found;
  }

  [[nodiscard]] Result<std::string_view> quoted() {
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    const std::size_t end = quote == '\'' || quote == '"' ? text_.find(quote, at_ + 1) : std::string_view::npos;
    if (end == std::string_view::npos) return fail("the header lacks a word in quotes here");
    const std::string_view content = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return content;
  }

  [[nodiscard]] Status entry(std::string_view key) {
    if (key == "shape") return parse_shape();
    if (key == "fortran_order") {
      const std::string_view order = word();
      fortran_ = order == "True";
      return fortran_ || order == "False" ? Status{} : Status{fail("fortran_order is neither True nor False")};
    }
    if (key != "descr") return fail("the header has an entry " + in_quotes(key));
    fields_.clear();
    structured_ = accept('[');
    if (structured_) return parse_fields();
    SACCADE_TRY(const std::string_view type, quoted());
    fields_.push_back({{}, type});
    return {};
  }

  /// Parses a list of tuples (name, type).
  [[nodiscard]] Status parse_fields() {
    while (!accept(']')) {
      SACCADE_CHECK(expect('('));
      SACCADE_TRY(const std::string_view name, quoted());
      SACCADE_CHECK(expect(','));
      skip_blanks();
      if (at_ < text_.size() && text_[at_] == '[') return unsupported("an array with fields within a field");
      SACCADE_TRY(const std::string_view type, quoted());
      if (!accept(')')) return unsupported("an array with several numbers in the field " + in_quotes(name));
      fields_.push_back({name, type});
      if (!accept(',')) {
        SACCADE_CHECK(expect(']'));
        break;
      }
    }
    return {};
  }

  [[nodiscard]] Status parse_shape() {
    std::vector<std::size_t> shape;
    SACCADE_CHECK(expect('('));
    while (!accept(')')) {
      const auto edge = parse_integer<std::size_t>(word());
      if (!edge) return fail("the shape has an entry that is not a number");
      shape.push_back(*edge);
      if (!accept(',')) {
        SACCADE_CHECK(expect(')'));
        break;
      }
    }
    shape_ = std::move(shape);
    return {};
  }

  std::string_view text_;
  std::size_t file_offset_;
  std::size_t at_{0};
  std::vector<NamedType> fields_;
  bool structured_{false};
  bool fortran_{false};
  std::optional<std::vector<std::size_t>> shape_;
};

constexpr std::array<std::string_view, 10> kTypes{"i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"};
static_assert(static_cast<int>(ColumnType::i8) == 0 && static_cast<int>(ColumnType::f64) == 9);

Result<ColumnType> number_type(std::string_view name) {
  if (name.size() == 3 && std::string_view{"<|=>"}.find(name[0]) != std::string_view::npos) {
    const auto found = std::find(kTypes.begin(), kTypes.end(), name.substr(1));
    if (found != kTypes.end()) return static_cast<ColumnType>(found - kTypes.begin());
  }
  return unsupported("an array of the type " + in_quotes(name) +
                     "; integers and floats of 8 to 64 bits are read (<f4, <f8, <i4, |u1 ...): convert it with astype");
}

Result<ColumnType> whole_type(std::string_view name) {
  SACCADE_TRY(const ColumnType type, number_type(name));
  if (name[0] != '>' && type != ColumnType::f32 && type != ColumnType::f64) return type;
  return unsupported("an array of the type " + in_quotes(name) +
                     "; integers are read, least significant byte first (<i4, <u4, |u1 ...)");
}

struct NpyContent {
  NpyDict dict;
  std::span<const std::byte> numbers;
  std::size_t offset;  ///< byte of the file where the numbers begin
};

Result<NpyContent> parse_content(std::span<const std::byte> file) {
  const Error cut{Errc::corrupt_data, "the file ends within its header", "byte " + std::to_string(file.size())};
  if (!is_npy(as_text(file))) return Error{Errc::corrupt_data, "not an array of NumPy (.npy)", "byte 0"};
  ByteReader reader{file, kNpyMagic.size()};
  if (!reader.has(4)) return cut;
  const auto version = reader.value<std::uint8_t>();
  const auto minor = reader.value<std::uint8_t>();
  if ((version != 1 && version != 2) || minor != 0) {
    return unsupported("format " + std::to_string(version) + "." + std::to_string(minor) + "; 1.0 and 2.0 are read");
  }
  if (version == 2 && !reader.has(4)) return cut;
  const std::size_t length = version == 1 ? reader.value<std::uint16_t>() : reader.value<std::uint32_t>();
  if (!reader.has(length)) return cut;
  const std::size_t offset = reader.offset();
  NpyDict dict{as_text(reader.take(length)), offset};
  SACCADE_CHECK(dict.parse());
  return NpyContent{std::move(dict), file.subspan(reader.offset()), reader.offset()};
}

/// Checks that `count` items of `bytes` each follow the header.
Status check_size(const NpyContent& array, std::size_t count, std::size_t bytes) {
  if (array.numbers.size() % bytes == 0 && array.numbers.size() / bytes == count) return {};
  return Error{Errc::corrupt_data,
               "the header speaks of " + std::to_string(count) + " numbers of " + std::to_string(bytes) +
                   " bytes, but " + std::to_string(array.numbers.size()) + " bytes follow",
               "byte " + std::to_string(array.offset)};
}

/// Returns `rows` values that begin `stride` bytes apart, in the machine's byte order.
std::vector<std::byte> gathered(std::span<const std::byte> from, std::size_t rows, std::size_t stride,
                                std::size_t width, bool swapped) {
  std::vector<std::byte> bytes(rows * width);
  for (std::size_t i = 0; i < rows; ++i) std::memcpy(&bytes[i * width], &from[i * stride], width);
  if (swapped) swap_bytes(bytes.data(), bytes.size(), width);
  return bytes;
}

/// Columns of an array of records.
Result<ColumnTable> columns_of_fields(const NpyContent& array) {
  ColumnTable table;
  std::size_t record{0};
  for (const NamedType& field : array.dict.fields()) {
    SACCADE_TRY(const ColumnType type, number_type(field.type));
    table.columns.push_back({std::string{field.name}, type, 1, {}});
    record += bytes_of(type);
  }
  if (array.dict.shape().size() != 1) return unsupported("an array of records with more than one dimension");
  table.rows = array.dict.shape().front();
  SACCADE_CHECK(check_size(array, table.rows, record));
  std::size_t begin{0};
  for (std::size_t k = 0; k < table.columns.size() && table.rows > 0; ++k) {
    Column& column = table.columns[k];
    const std::size_t width = bytes_of(column.type);
    column.bytes =
        gathered(array.numbers.subspan(begin), table.rows, record, width, array.dict.fields()[k].type[0] == '>');
    begin += width;
  }
  return table;
}

}  // namespace

bool is_npy(std::string_view head) { return head.starts_with(kNpyMagic); }

bool is_npy_table(std::string_view head) {
  const auto array = parse_content(as_byte_span(head));
  return array && (array->dict.is_structured() || array->dict.shape().size() == 2);
}

std::string npy_header(std::string_view type, std::span<const std::size_t> shape) {
  std::string dict = "{'descr': '" + std::string{type} + "', 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i) dict.append(i > 0 ? ", " : "").append(std::to_string(shape[i]));
  dict += shape.size() == 1 ? ",), }" : "), }";
  constexpr std::size_t kPrefix{10};
  dict.append(63 - (kPrefix + dict.size()) % 64, ' ');
  dict += '\n';
  std::string header{kNpyMagic};
  for (const std::size_t byte : {std::size_t{1}, std::size_t{0}, dict.size() & 0xFFU, dict.size() >> 8U}) {
    header += static_cast<char>(byte);
  }
  return header + dict;
}

Result<NpyArray> parse_npy_array(std::span<const std::byte> file) {
  SACCADE_TRY(const NpyContent array, parse_content(file));
  if (array.dict.is_structured()) return unsupported("an array of several fields, not of numbers");
  return NpyArray{array.dict.fields().front().type, array.dict.shape(), array.dict.is_fortran_order(), array.numbers,
                  array.offset};
}

Result<Column> parse_npy(std::span<const std::byte> file) {
  SACCADE_TRY(const NpyContent array, parse_content(file));
  if (array.dict.is_structured()) return unsupported("an array of several fields, not of integers");
  SACCADE_TRY(const ColumnType type, whole_type(array.dict.fields().front().type));
  if (array.dict.shape().size() != 1) {
    return unsupported("an array of " + std::to_string(array.dict.shape().size()) + " dimensions; one is read");
  }
  SACCADE_CHECK(check_size(array, array.dict.shape().front(), bytes_of(type)));
  return Column{{}, type, 1, {array.numbers.begin(), array.numbers.end()}};
}

Result<ColumnTable> parse_npy_table(std::span<const std::byte> file) {
  SACCADE_TRY(const NpyContent array, parse_content(file));
  if (array.dict.is_structured()) return columns_of_fields(array);
  const std::vector<std::size_t>& shape = array.dict.shape();
  if (shape.size() != 2) {
    return unsupported("an array of " + std::to_string(shape.size()) +
                       " dimensions; a table has two, rows and columns");
  }
  const std::string_view type_name = array.dict.fields().front().type;
  SACCADE_TRY(const ColumnType type, number_type(type_name));
  if (shape[1] == 0 || shape[1] > kMaxNpyColumns) {
    return unsupported("a table of " + std::to_string(shape[1]) + " columns; 1 to " + std::to_string(kMaxNpyColumns) +
                       " are read; should it be transposed?");
  }
  const std::size_t width = bytes_of(type);
  SACCADE_CHECK(check_size(array, shape[0], shape[1] * width));
  ColumnTable table;
  table.rows = shape[0];
  const bool fortran = array.dict.is_fortran_order();
  for (std::size_t k = 0; k < shape[1]; ++k) {
    Column column{"", type, 1, {}};
    if (table.rows > 0) {
      column.bytes = gathered(array.numbers.subspan((fortran ? k * shape[0] : k) * width), shape[0],
                              fortran ? width : shape[1] * width, width, type_name[0] == '>');
    }
    table.columns.push_back(std::move(column));
  }
  return table;
}

}  // namespace saccade
