// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <limits>

#include "saccade/io/clouds/internal/ply_header.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/value_io.hpp"

namespace saccade {
namespace {

/// Appends values to a row in the format of the file.
class RowWriter {
 public:
  explicit RowWriter(PlyFormat format)
      : ascii_{format == PlyFormat::ascii},
        swapped_{(format == PlyFormat::binary_little_endian) != (std::endian::native == std::endian::little)} {}

  void add(ColumnType type, const std::byte* values, std::size_t count) {
    const std::size_t width = bytes_of(type);
    if (ascii_) {
      for (std::size_t i = 0; i < count; ++i) {
        if (!row_.empty()) row_ += ' ';
        append_text(values + i * width, type, row_);
      }
      return;
    }
    const std::size_t begin = row_.size();
    row_.append(reinterpret_cast<const char*>(values), count * width);
    if (swapped_) swap_bytes(reinterpret_cast<std::byte*>(row_.data() + begin), count * width, width);
  }
  [[nodiscard]] Status finish(AtomicFile& out) {
    if (ascii_) row_ += '\n';
    const Status written = out.write(row_);
    row_.clear();
    return written;
  }

 private:
  bool ascii_;
  bool swapped_;
  std::string row_;
};

Status check_element(const PlyElement& element) {
  SACCADE_CHECK(element.table.validate());
  for (const Column& column : element.table.columns) {
    if (column.count != 1 || column.type == ColumnType::i64 || column.type == ColumnType::u64) {
      return Error{Errc::unsupported, "PLY holds one number of at most 32 bits or a float per property", column.name};
    }
  }
  for (const PlyList& list : element.lists) {
    const bool fits = list.starts.size() == element.table.rows + 1 && !list.starts.empty() &&
                      list.starts.front() == 0 &&
                      list.starts.back() * bytes_of(list.values.type) == list.values.bytes.size();
    if (!fits) return Error{Errc::size_mismatch, "a list's values are not as many as its rows say", list.name};
  }
  const auto in_range = [&](int i) {
    return i >= 0 ? static_cast<std::size_t>(i) < element.table.columns.size()
                  : static_cast<std::size_t>(-1 - i) < element.lists.size();
  };
  for (const int index : element.order) {
    if (!in_range(index)) return Error{Errc::invalid_argument, "the order names a property that is not there", {}};
  }
  return {};
}

Status add_list(RowWriter& writer, const PlyList& list, std::size_t row) {
  if (list.starts[row + 1] < list.starts[row]) {
    return Error{Errc::invalid_argument, "a list's starts must not decrease", list.name};
  }
  const std::size_t length = list.starts[row + 1] - list.starts[row];
  Column count{{}, list.count_type, 1, std::vector<std::byte>(bytes_of(list.count_type))};
  count.set_value(0, static_cast<double>(length));
  if (count.value(0) != static_cast<double>(length)) {
    return Error{Errc::unsupported, "a list is too long for the type of its count", list.name};
  }
  writer.add(list.count_type, count.bytes.data(), 1);
  writer.add(list.values.type, list.values.bytes.data() + list.starts[row] * bytes_of(list.values.type), length);
  return {};
}

Status write_element(AtomicFile& out, const PlyElement& element, PlyFormat format) {
  RowWriter writer{format};
  const std::vector<int> order = property_order(element);
  for (std::size_t row = 0; row < element.table.rows; ++row) {
    for (const int index : order) {
      if (index < 0) {
        SACCADE_CHECK(add_list(writer, element.lists[static_cast<std::size_t>(-1 - index)], row));
      } else {
        const Column& column = element.table.columns[static_cast<std::size_t>(index)];
        writer.add(column.type, column.bytes.data() + row * column.row_bytes(), 1);
      }
    }
    SACCADE_CHECK(writer.finish(out));
  }
  return {};
}

/// Returns coordinate k of each vector.
std::vector<float> coordinates(const std::vector<Eigen::Vector3f>& vectors, int k) {
  std::vector<float> out(vectors.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = vectors[i][k];
  return out;
}

void add_vectors(ColumnTable& table, const std::vector<Eigen::Vector3f>& vectors,
                 const std::array<const char*, 3>& names) {
  for (int k = 0; k < 3; ++k) {
    table.add<float>(names[static_cast<std::size_t>(k)], std::span<const float>{coordinates(vectors, k)});
  }
}

void add_colors(ColumnTable& table, const std::vector<Rgb8>& colors) {
  constexpr std::array<const char*, 3> kNames{"red", "green", "blue"};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<std::uint8_t> channel(colors.size());
    for (std::size_t i = 0; i < colors.size(); ++i) channel[i] = colors[i][k];
    table.add<std::uint8_t>(kNames[k], std::span<const std::uint8_t>{channel});
  }
}

Status check_mesh(const TriangleMesh& mesh) {
  const auto fail = [](std::string what) { return Error{Errc::invalid_argument, std::move(what), "mesh"}; };
  const std::size_t vertices = mesh.vertices.size();
  if (!mesh.normals.empty() && mesh.normals.size() != vertices) return fail("it needs one normal per vertex");
  if (!mesh.colors.empty() && mesh.colors.size() != vertices) return fail("it needs one colour per vertex");
  if (vertices > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) return fail("too many vertices");
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= vertices) return fail("a triangle names a vertex that is not there");
    }
  }
  return {};
}

PlyElement face_element(const TriangleMesh& mesh) {
  PlyElement faces;
  faces.name = "face";
  faces.table.rows = mesh.triangles.size();
  PlyList list{"vertex_indices", ColumnType::u8, {"vertex_indices", ColumnType::i32, 1, {}}, {}};
  const auto bytes = std::as_bytes(std::span{mesh.triangles});
  list.values.bytes.assign(bytes.begin(), bytes.end());
  list.starts.resize(mesh.triangles.size() + 1);
  for (std::size_t i = 0; i < list.starts.size(); ++i) list.starts[i] = 3 * i;
  faces.lists.push_back(std::move(list));
  return faces;
}

}  // namespace

Status write_ply(const std::filesystem::path& path, const PlyFile& file, PlyFormat format) {
  for (const PlyElement& element : file.elements) SACCADE_CHECK(check_element(element));
  for (const std::string& comment : file.comments) {
    if (comment.find_first_of("\r\n") != std::string::npos) {
      return Error{Errc::invalid_argument, "a comment must be one line", path.string()};
    }
  }
  SACCADE_TRY(AtomicFile out, AtomicFile::create(path));
  SACCADE_CHECK(out.write(ply_header_text(file, format)));
  for (const PlyElement& element : file.elements) SACCADE_CHECK(write_element(out, element, format));
  return out.commit();
}

Status write_ply(const std::filesystem::path& path, const ColumnTable& vertices, PlyFormat format) {
  return write_ply(path, PlyFile{{}, {PlyElement{"vertex", vertices, {}, {}}}}, format);
}

Status write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, PlyFormat format,
                  std::span<const std::int32_t> labels) {
  SACCADE_CHECK(check_mesh(mesh));
  if (!labels.empty() && labels.size() != mesh.vertices.size()) {
    return Error{Errc::invalid_argument, "there must be as many labels as vertices", path.string()};
  }
  PlyElement vertices;
  vertices.name = "vertex";
  add_vectors(vertices.table, mesh.vertices, {"x", "y", "z"});
  if (!mesh.normals.empty()) add_vectors(vertices.table, mesh.normals, {"nx", "ny", "nz"});
  if (!mesh.colors.empty()) add_colors(vertices.table, mesh.colors);
  if (!labels.empty()) vertices.table.add("label", labels);
  return write_ply(path, PlyFile{{"made by Saccade; metres"}, {std::move(vertices), face_element(mesh)}}, format);
}

}  // namespace saccade
