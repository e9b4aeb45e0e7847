// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>

#include "saccade/io/clouds/internal/ply_header.hpp"
#include "saccade/io/clouds/internal/split_polygon.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/files/value_io.hpp"

namespace saccade {
namespace {

/// Returns the smallest number of bytes that a row takes in a file.
std::size_t least_row_bytes(const PlyElement& element, PlyFormat format) {
  if (format == PlyFormat::ascii) return element.order.size();  // a digit each; blanks are not counted
  std::size_t bytes = element.table.row_bytes();
  for (const PlyList& list : element.lists) bytes += bytes_of(list.count_type);
  return bytes;
}

/// Reader of consecutive binary values.
class BinaryValues {
 public:
  BinaryValues(std::string_view body, std::size_t file_offset, bool swapped)
      : body_{body}, file_offset_{file_offset}, swapped_{swapped} {}

  [[nodiscard]] bool append(ColumnType type, std::size_t count, std::vector<std::byte>& out) {
    const std::size_t width = bytes_of(type);
    if (count > (body_.size() - at_) / width) return false;
    const std::size_t begin = out.size();
    const auto bytes = as_byte_span(body_.substr(at_, count * width));
    out.insert(out.end(), bytes.begin(), bytes.end());
    if (swapped_) swap_bytes(out.data() + begin, count * width, width);
    at_ += count * width;
    return true;
  }
  [[nodiscard]] std::size_t left() const { return body_.size() - at_; }
  [[nodiscard]] std::string where() const { return "byte " + std::to_string(file_offset_ + at_); }

 private:
  std::string_view body_;
  std::size_t file_offset_;
  bool swapped_;
  std::size_t at_{0};
};

/// Reader of values from text.
class AsciiValues {
 public:
  AsciiValues(std::string_view body, std::size_t first_line) : body_{body}, first_line_{first_line}, tokens_{body} {}

  [[nodiscard]] bool append(ColumnType type, std::size_t count, std::vector<std::byte>& out) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto token = tokens_.next();
      at_ = token ? static_cast<std::size_t>(token->data() - body_.data()) : body_.size();
      if (!token || !append_token(*token, type, out)) return false;
    }
    return true;
  }
  [[nodiscard]] std::size_t left() const { return body_.size() - at_; }
  [[nodiscard]] std::string where() const {
    const auto end = body_.begin() + static_cast<std::ptrdiff_t>(at_);
    return "line " + std::to_string(first_line_ + static_cast<std::size_t>(std::count(body_.begin(), end, '\n')));
  }

 private:
  std::string_view body_;
  std::size_t first_line_;
  TokenScanner tokens_;
  std::size_t at_{0};
};

template <class Values>
Error truncated(const Values& values, const PlyElement& element, std::size_t row) {
  return {Errc::corrupt_data,
          "the values of " + element.name + " " + std::to_string(row) + " are missing or not of their type",
          values.where()};
}

template <class Values>
Status read_list(Values& values, PlyElement& element, PlyList& list, std::size_t row) {
  Column count{{}, list.count_type, 1, {}};
  if (!values.append(list.count_type, 1, count.bytes)) return truncated(values, element, row);
  const double length = count.value(0);
  if (length < 0.0) return Error{Errc::corrupt_data, "a list with a negative count", values.where()};
  if (!values.append(list.values.type, static_cast<std::size_t>(length), list.values.bytes)) {
    return truncated(values, element, row);
  }
  list.starts.push_back(list.values.bytes.size() / bytes_of(list.values.type));
  return {};
}

template <class Values>
Status read_element(Values& values, PlyElement& element, std::size_t least_bytes) {
  const std::size_t rows = element.table.rows;
  if (least_bytes > 0 && rows > values.left() / least_bytes) {
    return Error{Errc::corrupt_data,
                 "the file ends before " + std::to_string(rows) + " rows of " + in_quotes(element.name),
                 values.where()};
  }
  for (Column& column : element.table.columns) column.bytes.reserve(rows * column.row_bytes());
  for (PlyList& list : element.lists) list.starts.assign(1, 0);
  if (element.order.empty() && rows > 0) {
    return Error{Errc::corrupt_data, in_quotes(element.name) + " has rows but no properties", values.where()};
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (const int index : element.order) {
      if (index < 0) {
        SACCADE_CHECK(read_list(values, element, element.lists[static_cast<std::size_t>(-1 - index)], row));
      } else {
        Column& column = element.table.columns[static_cast<std::size_t>(index)];
        if (!values.append(column.type, 1, column.bytes)) return truncated(values, element, row);
      }
    }
  }
  return {};
}

template <class Values>
Result<PlyFile> read_elements(Values values, PlyHeader header) {
  for (PlyElement& element : header.file.elements) {
    SACCADE_CHECK(read_element(values, element, least_row_bytes(element, header.file.format)));
  }
  return std::move(header.file);
}

/// Returns three columns as floats, if the element has them all.
std::vector<Eigen::Vector3f> vectors(const ColumnTable& table, std::string_view x, std::string_view y,
                                     std::string_view z) {
  const Column* cx = table.find(x);
  const Column* cy = table.find(y);
  const Column* cz = table.find(z);
  if (cx == nullptr || cy == nullptr || cz == nullptr) return {};
  std::vector<Eigen::Vector3f> out(table.rows);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = Eigen::Vector3d{cx->value(i), cy->value(i), cz->value(i)}.cast<float>();
  }
  return out;
}

std::vector<Rgb8> colors_of(const ColumnTable& table) {
  const Column* red = table.find("red");
  const Column* green = table.find("green");
  const Column* blue = table.find("blue");
  const auto usable = [](const Column* c) { return c != nullptr && c->type == ColumnType::u8; };
  if (!usable(red) || !usable(green) || !usable(blue)) return {};
  std::vector<Rgb8> out(table.rows);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = {static_cast<std::uint8_t>(red->bytes[i]), static_cast<std::uint8_t>(green->bytes[i]),
              static_cast<std::uint8_t>(blue->bytes[i])};
  }
  return out;
}

const PlyList* face_list(const PlyElement& faces) {
  for (const PlyList& list : faces.lists) {
    if (list.name == "vertex_indices" || list.name == "vertex_index") return &list;
  }
  return nullptr;
}

Status add_faces(const PlyList& list, TriangleMesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (std::size_t face = 0; face + 1 < list.starts.size(); ++face) {
    corners.clear();
    for (std::size_t i = list.starts[face]; i < list.starts[face + 1]; ++i) {
      const double corner = list.values.value(i);
      if (!(corner >= 0.0) || corner >= static_cast<double>(mesh.vertices.size())) {
        return Error{Errc::corrupt_data, "face " + std::to_string(face) + " names a vertex that is not there", {}};
      }
      corners.push_back(static_cast<std::uint32_t>(corner));
    }
    if (!split_polygon(mesh.vertices, corners, mesh.triangles)) {
      return Error{Errc::corrupt_data,
                   "face " + std::to_string(face) + " has " + std::to_string(corners.size()) +
                       " corners and is not convex; split it into triangles",
                   {}};
    }
  }
  return {};
}

}  // namespace

const PlyElement* PlyFile::find(std::string_view name) const {
  const auto found = std::find_if(elements.begin(), elements.end(), [&](const auto& e) { return e.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

Result<PlyFile> parse_ply(std::span<const std::byte> file) {
  const std::string_view text = as_text(file);
  SACCADE_TRY(PlyHeader header, parse_ply_header(text));
  const std::string_view body = text.substr(header.body_offset);
  if (header.file.format == PlyFormat::ascii) {
    const AsciiValues values{body, header.body_line};
    return read_elements(values, std::move(header));
  }
  const bool little = header.file.format == PlyFormat::binary_little_endian;
  const bool swapped = little != (std::endian::native == std::endian::little);
  const BinaryValues values{body, header.body_offset, swapped};
  return read_elements(values, std::move(header));
}

Result<PlyFile> read_ply(const std::filesystem::path& path) {
  SACCADE_TRY(const auto bytes, read_file(path));
  return in_file(parse_ply(bytes), path);
}

Result<TriangleMesh> mesh_from_ply(const PlyFile& file) {
  const PlyElement* vertices = file.find("vertex");
  if (vertices == nullptr) return Error{Errc::corrupt_data, "holds no vertices", {}};
  TriangleMesh mesh;
  mesh.vertices = vectors(vertices->table, "x", "y", "z");
  if (mesh.vertices.size() != vertices->table.rows) return Error{Errc::corrupt_data, "its vertices lack x, y, z", {}};
  mesh.normals = vectors(vertices->table, "nx", "ny", "nz");
  mesh.colors = colors_of(vertices->table);
  const PlyElement* faces = file.find("face");
  const PlyList* list = faces != nullptr ? face_list(*faces) : nullptr;
  if (list != nullptr) SACCADE_CHECK(add_faces(*list, mesh));
  return mesh;
}

Result<TriangleMesh> read_mesh(const std::filesystem::path& path) {
  SACCADE_TRY(const PlyFile file, read_ply(path));
  return in_file(mesh_from_ply(file), path);
}

}  // namespace saccade
