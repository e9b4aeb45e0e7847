// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/npy_io.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/little_endian.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

constexpr std::string_view kNpyMagic{"\x93NUMPY"};

Error unsupported(std::string what) { return {Errc::unsupported, std::move(what), {}}; }

/// What the header says: a dict of Python's of three entries.
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
    if (type_.empty() || !shape_) return fail("the header lacks the type or the shape");
    return {};
  }

  [[nodiscard]] std::string_view type() const { return type_; }
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
      const std::string_view order = word();  // makes no difference in one dimension
      return order == "True" || order == "False" ? Status{} : Status{fail("fortran_order is neither True nor False")};
    }
    if (key != "descr") return fail("the header has an entry " + in_quotes(key));
    skip_blanks();
    if (at_ < text_.size() && text_[at_] == '[') return unsupported("an array of several fields, not of whole numbers");
    SACCADE_TRY(type_, quoted());
    return {};
  }

  [[nodiscard]] Status parse_shape() {
    std::vector<std::size_t> shape;
    SACCADE_CHECK(expect('('));
    while (!accept(')')) {
      const auto edge = parse_integer<std::size_t>(word());
      if (!edge) return fail("the shape has something that is no number");
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
  std::string_view type_;
  std::optional<std::vector<std::size_t>> shape_;
};

Result<ColumnType> whole_type(std::string_view name) {
  constexpr std::array<std::string_view, 8> kNames{"i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"};
  if (name.size() == 3 && (name[0] == '<' || name[0] == '|' || name[0] == '=')) {
    const auto found = std::find(kNames.begin(), kNames.end(), name.substr(1));
    if (found != kNames.end()) return static_cast<ColumnType>(found - kNames.begin());
  }
  return unsupported("an array of the type " + in_quotes(name) +
                     "; whole numbers are read, least significant byte first (<i4, <u4, |u1 ...)");
}

}  // namespace

static_assert(static_cast<int>(ColumnType::i8) == 0 && static_cast<int>(ColumnType::u64) == 7);

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

Result<Column> parse_npy(std::span<const std::byte> file) {
  const Error cut{Errc::corrupt_data, "the file ends within its header", "byte " + std::to_string(file.size())};
  if (!as_text(file).starts_with(kNpyMagic)) return Error{Errc::corrupt_data, "not an array of NumPy (.npy)", "byte 0"};
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
  SACCADE_TRY(const ColumnType type, whole_type(dict.type()));
  if (dict.shape().size() != 1) {
    return unsupported("an array of " + std::to_string(dict.shape().size()) + " dimensions; one is read");
  }
  const std::size_t numbers = dict.shape().front();
  if (reader.left() % bytes_of(type) != 0 || reader.left() / bytes_of(type) != numbers) {
    return Error{Errc::corrupt_data,
                 "the header speaks of " + std::to_string(numbers) + " numbers of " + std::to_string(bytes_of(type)) +
                     " bytes, but " + std::to_string(reader.left()) + " bytes follow",
                 "byte " + std::to_string(reader.offset())};
  }
  const auto bytes = reader.take(reader.left());
  return Column{{}, type, 1, {bytes.begin(), bytes.end()}};
}

}  // namespace saccade
