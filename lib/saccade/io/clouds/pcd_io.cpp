// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/pcd_io.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>

#include "saccade/io/clouds/internal/lzf.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/files/value_io.hpp"

namespace saccade {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD is read and written in the byte order of x86 and ARM");

constexpr std::size_t kMaxEdge{std::numeric_limits<std::uint32_t>::max()};

std::optional<ColumnType> column_type(std::string_view type, std::size_t size) {
  const bool power = size == 1 || size == 2 || size == 4 || size == 8;
  if (!power || type.size() != 1) return std::nullopt;
  const int log = size == 1 ? 0 : (size == 2 ? 1 : (size == 4 ? 2 : 3));
  if (type == "I") return static_cast<ColumnType>(2 * log);
  if (type == "U") return static_cast<ColumnType>(2 * log + 1);
  if (type == "F" && size >= 4) return size == 4 ? ColumnType::f32 : ColumnType::f64;
  return std::nullopt;
}

char type_letter(ColumnType type) {
  if (type == ColumnType::f32 || type == ColumnType::f64) return 'F';
  return static_cast<int>(type) % 2 == 0 ? 'I' : 'U';
}

struct Header {
  PcdFile file;  ///< columns without values
  std::size_t body_offset{0};
  std::size_t body_line{1};
};

class PcdHeaderParser {
 public:
  explicit PcdHeaderParser(std::string_view text) : lines_{text} {}

  [[nodiscard]] Result<Header> parse() {
    while (const auto line = lines_.next()) {
      std::vector<std::string_view> words;
      TokenScanner tokens{*line, " \t"};
      while (const auto token = tokens.next()) words.push_back(*token);
      if (words.empty() || words[0].front() == '#') continue;
      if (words[0] == "DATA") return finish(words);
      SACCADE_CHECK(statement(words));
    }
    return fail(fields_.empty() ? "not a PCD file" : "the header does not end");
  }

 private:
  [[nodiscard]] Error fail(std::string what) const {
    return {Errc::corrupt_data, std::move(what), "line " + std::to_string(lines_.line())};
  }

  [[nodiscard]] Status numbers(const std::vector<std::string_view>& words, std::vector<std::size_t>& out) const {
    out.clear();
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto number = parse_integer<std::size_t>(words[i]);
      if (!number || *number > kMaxEdge) return fail(in_quotes(words[i]) + " is not a number that fits here");
      out.push_back(*number);
    }
    return {};
  }
  [[nodiscard]] Status number(const std::vector<std::string_view>& words, std::optional<std::size_t>& out) const {
    std::vector<std::size_t> all;
    SACCADE_CHECK(numbers(words, all));
    if (all.size() != 1) return fail("one number expected after " + std::string{words[0]});
    out = all[0];
    return {};
  }

  [[nodiscard]] Status statement(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    if (key == "VERSION") return {};
    if (key == "FIELDS" || key == "COLUMNS") return fields_.assign(words.begin() + 1, words.end()), Status{};
    if (key == "TYPE") return types_.assign(words.begin() + 1, words.end()), Status{};
    if (key == "SIZE") return numbers(words, sizes_);
    if (key == "COUNT") return numbers(words, counts_);
    if (key == "WIDTH") return number(words, width_);
    if (key == "HEIGHT") return number(words, height_);
    if (key == "POINTS") return number(words, points_);
    if (key == "VIEWPOINT") return viewpoint(words);
    return fail((fields_.empty() ? "not a PCD file: " : "not a statement of a PCD header: ") + in_quotes(key));
  }

  [[nodiscard]] Status viewpoint(const std::vector<std::string_view>& words) {
    if (words.size() != 8) return fail("seven numbers expected after VIEWPOINT");
    for (std::size_t i = 0; i < 7; ++i) {
      const auto value = parse_number(words[i + 1]);
      if (!value) return fail(in_quotes(words[i + 1]) + " is not a number");
      header_.file.viewpoint[i] = *value;
    }
    return {};
  }

  [[nodiscard]] Result<Header> finish(const std::vector<std::string_view>& words) {
    SACCADE_CHECK(columns());
    SACCADE_CHECK(size());
    const std::string_view kind = words.size() == 2 ? words[1] : std::string_view{};
    const auto format = kPcdFormatNames.find(kind);
    if (!format) {
      return Error{Errc::unsupported, "unknown kind of data " + in_quotes(kind),
                   "line " + std::to_string(lines_.line())};
    }
    header_.file.format = *format;
    header_.body_offset = lines_.offset();
    header_.body_line = lines_.line() + 1;
    return std::move(header_);
  }

  [[nodiscard]] Status columns() {
    if (fields_.empty()) return fail("the header names no FIELDS");
    if (counts_.empty()) counts_.assign(fields_.size(), 1);
    if (types_.size() != fields_.size() || sizes_.size() != fields_.size() || counts_.size() != fields_.size()) {
      return fail("FIELDS, SIZE, TYPE and COUNT must have equally many entries");
    }
    std::size_t row_bytes = 0;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const auto type = column_type(types_[i], sizes_[i]);
      if (!type) return fail("no such type of field: " + in_quotes(types_[i]) + " of " + std::to_string(sizes_[i]));
      constexpr std::size_t kMaxRowBytes{std::size_t{1} << 20U};
      row_bytes += counts_[i] * sizes_[i];
      if (counts_[i] == 0 || row_bytes > kMaxRowBytes)
        return fail("COUNT of " + in_quotes(fields_[i]) + " is out of range");
      header_.file.table.columns.push_back({std::string{fields_[i]}, *type, counts_[i], {}});
    }
    return {};
  }

  [[nodiscard]] Status size() {
    if (!width_ && !points_) return fail("the header names no WIDTH");
    const std::size_t width = width_.value_or(points_.value_or(0));
    const std::size_t height = height_.value_or(1);
    const std::size_t points = width * height;  // each below 2^32
    if (points_ && *points_ != points) {
      return fail("WIDTH x HEIGHT is " + std::to_string(points) + ", but POINTS " + std::to_string(*points_));
    }
    header_.file.width = width;
    header_.file.height = height;
    header_.file.table.rows = points;
    return {};
  }

  LineScanner lines_;
  Header header_;
  std::vector<std::string_view> fields_;
  std::vector<std::string_view> types_;
  std::vector<std::size_t> sizes_;
  std::vector<std::size_t> counts_;
  std::optional<std::size_t> width_;
  std::optional<std::size_t> height_;
  std::optional<std::size_t> points_;
};

Error too_short(const ColumnTable& table, std::size_t offset) {
  return {Errc::corrupt_data, "the file ends before its " + std::to_string(table.rows) + " points",
          "byte " + std::to_string(offset)};
}

Status read_ascii(std::string_view body, std::size_t body_line, ColumnTable& table) {
  if (table.rows > body.size()) return too_short(table, body.size());
  LineScanner lines{body};
  std::size_t row = 0;
  while (row < table.rows) {
    const auto line = lines.next();
    const std::string where = "line " + std::to_string(body_line + lines.line() - (line ? 1 : 0));
    if (!line) {
      return Error{Errc::corrupt_data,
                   "the file ends after " + std::to_string(row) + " of " + std::to_string(table.rows) + " points",
                   where};
    }
    TokenScanner tokens{*line, " \t"};
    auto token = tokens.next();
    if (!token) continue;
    for (Column& column : table.columns) {
      for (std::size_t k = 0; k < column.count; ++k, token = tokens.next()) {
        if (!token) return Error{Errc::corrupt_data, "too few numbers in this line", where};
        if (!append_token(*token, column.type, column.bytes)) {
          return Error{Errc::corrupt_data, in_quotes(*token) + " is not a value of " + in_quotes(column.name), where};
        }
      }
    }
    if (token) return Error{Errc::corrupt_data, "too many numbers in this line", where};
    ++row;
  }
  return {};
}

/// Converts consecutive rows to columns.
void split_rows(const std::byte* rows, ColumnTable& table) {
  const std::size_t stride = table.row_bytes();
  std::size_t offset = 0;
  for (Column& column : table.columns) {
    const std::size_t width = column.row_bytes();
    column.bytes.resize(table.rows * width);
    for (std::size_t i = 0; i < table.rows; ++i) {
      std::memcpy(&column.bytes[i * width], rows + i * stride + offset, width);
    }
    offset += width;
  }
}

Status read_binary(std::span<const std::byte> body, std::size_t body_offset, ColumnTable& table) {
  if (table.rows > body.size() / table.row_bytes()) return too_short(table, body_offset + body.size());
  split_rows(body.data(), table);
  return {};
}

Status read_compressed(std::span<const std::byte> body, std::size_t body_offset, ColumnTable& table) {
  std::array<std::uint32_t, 2> sizes{};  // packed, unpacked
  if (body.size() < sizeof(sizes)) return too_short(table, body_offset + body.size());
  std::memcpy(sizes.data(), body.data(), sizeof(sizes));
  const auto packed = body.subspan(sizeof(sizes));
  const std::string where = "byte " + std::to_string(body_offset);
  if (table.rows > kMaxEdge / table.row_bytes() || table.rows * table.row_bytes() != sizes[1]) {
    return Error{Errc::corrupt_data, "the compressed data is not of the size of its points", where};
  }
  if (packed.size() < sizes[0]) return too_short(table, body_offset + body.size());
  const auto unpacked = lzf_decompress(packed.first(sizes[0]), sizes[1]);
  if (!unpacked) return Error{Errc::corrupt_data, "the compressed data is damaged", where};
  std::size_t offset = 0;
  for (Column& column : table.columns) {  // column after column
    const auto begin = unpacked->begin() + static_cast<std::ptrdiff_t>(offset);
    const std::size_t bytes = table.rows * column.row_bytes();
    column.bytes.assign(begin, begin + static_cast<std::ptrdiff_t>(bytes));
    offset += bytes;
  }
  return {};
}

std::string header_text(const PcdFile& file, PcdFormat format) {
  std::string fields{"FIELDS"};
  std::string sizes{"SIZE"};
  std::string types{"TYPE"};
  std::string counts{"COUNT"};
  for (const Column& column : file.table.columns) {
    fields.append(" ").append(column.name);
    sizes.append(" ").append(std::to_string(bytes_of(column.type)));
    types.append(" ").push_back(type_letter(column.type));
    counts.append(" ").append(std::to_string(column.count));
  }
  std::string viewpoint{"VIEWPOINT"};
  for (const double value : file.viewpoint) {
    viewpoint.push_back(' ');
    append_text(reinterpret_cast<const std::byte*>(&value), ColumnType::f64, viewpoint);
  }
  std::string text{"# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"};
  text.append(fields).append("\n").append(sizes).append("\n").append(types).append("\n").append(counts).append("\n");
  text.append("WIDTH ").append(std::to_string(file.width)).append("\nHEIGHT ").append(std::to_string(file.height));
  text.append("\n").append(viewpoint).append("\nPOINTS ").append(std::to_string(file.table.rows));
  text.append("\nDATA ").append(kPcdFormatNames.of(format)).append("\n");
  return text;
}

Status write_rows(AtomicFile& out, const ColumnTable& table, bool ascii) {
  std::string row;
  for (std::size_t i = 0; i < table.rows; ++i) {
    row.clear();
    for (const Column& column : table.columns) {
      const std::byte* values = column.bytes.data() + i * column.row_bytes();
      if (!ascii) {
        row.append(reinterpret_cast<const char*>(values), column.row_bytes());
        continue;
      }
      for (std::size_t k = 0; k < column.count; ++k) {
        if (!row.empty()) row.push_back(' ');
        append_text(values + k * bytes_of(column.type), column.type, row);
      }
    }
    if (ascii) row.push_back('\n');
    SACCADE_CHECK(out.write(row));
  }
  return {};
}

Status write_compressed(AtomicFile& out, const ColumnTable& table) {
  std::vector<std::byte> joined;
  for (const Column& column : table.columns) joined.insert(joined.end(), column.bytes.begin(), column.bytes.end());
  const std::vector<std::byte> packed = lzf_compress(joined);
  if (joined.size() > kMaxEdge || packed.size() > kMaxEdge) {
    return Error{Errc::unsupported, "compressed PCD holds at most 4 GiB; write binary", {}};
  }
  const std::array<std::uint32_t, 2> sizes{static_cast<std::uint32_t>(packed.size()),
                                           static_cast<std::uint32_t>(joined.size())};
  SACCADE_CHECK(out.write(std::as_bytes(std::span{sizes})));
  return out.write(packed);
}

}  // namespace

Result<PcdFile> parse_pcd(std::span<const std::byte> bytes) {
  SACCADE_TRY(Header header, PcdHeaderParser{as_text(bytes)}.parse());
  const auto body = bytes.subspan(header.body_offset);
  ColumnTable& table = header.file.table;
  switch (header.file.format) {
    case PcdFormat::ascii: SACCADE_CHECK(read_ascii(as_text(body), header.body_line, table)); break;
    case PcdFormat::binary: SACCADE_CHECK(read_binary(body, header.body_offset, table)); break;
    case PcdFormat::binary_compressed: SACCADE_CHECK(read_compressed(body, header.body_offset, table)); break;
  }
  return std::move(header.file);
}

Result<PcdFile> read_pcd(const std::filesystem::path& path) {
  SACCADE_TRY(const auto bytes, read_file(path));
  return in_file(parse_pcd(bytes), path);
}

Status write_pcd(const std::filesystem::path& path, const PcdFile& file, PcdFormat format) {
  SACCADE_CHECK(file.table.validate());
  if (file.table.columns.empty())
    return Error{Errc::invalid_argument, "a cloud needs at least one column", path.string()};
  if (file.width > kMaxEdge || file.height > kMaxEdge || file.width * file.height != file.table.rows) {
    return Error{Errc::size_mismatch, "width x height is not the number of points", path.string()};
  }
  SACCADE_TRY(AtomicFile out, AtomicFile::create(path));
  SACCADE_CHECK(out.write(header_text(file, format)));
  if (format == PcdFormat::binary_compressed) {
    SACCADE_CHECK(write_compressed(out, file.table));
  } else {
    SACCADE_CHECK(write_rows(out, file.table, format == PcdFormat::ascii));
  }
  return out.commit();
}

Status write_pcd(const std::filesystem::path& path, const ColumnTable& table, PcdFormat format) {
  return write_pcd(path, PcdFile{table, table.rows, 1, {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0}}, format);
}

}  // namespace saccade
