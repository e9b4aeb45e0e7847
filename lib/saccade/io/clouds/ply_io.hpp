// SPDX-License-Identifier: Apache-2.0
#pragma once
// PLY: elements of named columns and lists, ascii and binary, either byte order; meshes.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/files/column_table.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

/// List property: for each row of its element a varying number of values.
struct PlyList {
  std::string name;
  ColumnType count_type{ColumnType::u8};  ///< as in the file
  Column values;                          ///< values of all rows; its name is the list's
  std::vector<std::size_t> starts;        ///< first value of each row, then the end: rows + 1 entries
};

struct PlyElement {
  std::string name;
  ColumnTable table;  ///< scalar properties; table.rows counts the element's rows even without properties
  std::vector<PlyList> lists;
  /// Order of the properties in the file: index into table.columns, or −1 − index into lists.
  std::vector<int> order;
};

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };
inline constexpr auto kPlyFormatNames =
    make_names<PlyFormat>({{PlyFormat::ascii, "ascii"},
                           {PlyFormat::binary_little_endian, "binary_little_endian"},
                           {PlyFormat::binary_big_endian, "binary_big_endian"}});

struct PlyFile {
  std::vector<std::string> comments;
  std::vector<PlyElement> elements;
  PlyFormat format{PlyFormat::binary_little_endian};  ///< format that it was read in
  /// Returns the element, or nullptr.
  [[nodiscard]] const PlyElement* find(std::string_view name) const;
};

/// Reads any PLY and keeps every property. Answers corrupt_data with the line or byte for a bad header, a number that
/// does not fit, negative counts and truncated data; unsupported for a version other than 1.0. Memory is bounded by the
/// size of the file. O(file).
[[nodiscard]] Result<PlyFile> parse_ply(std::span<const std::byte> file);
[[nodiscard]] Result<PlyFile> read_ply(const std::filesystem::path& path);
/// Writes atomically, with properties in the order of `order`, or columns before lists where it is empty.
[[nodiscard]] Status write_ply(const std::filesystem::path& path, const PlyFile& file,
                               PlyFormat format = PlyFormat::binary_little_endian);
/// Writes a cloud: one element "vertex".
[[nodiscard]] Status write_ply(const std::filesystem::path& path, const ColumnTable& vertices,
                               PlyFormat format = PlyFormat::binary_little_endian);

/// Writes vertices (float x y z, nx ny nz and uchar red green blue where present) and faces (list uchar int
/// vertex_indices), as MeshLab and CloudCompare read them. Labels, one per vertex, become the property int label.
/// Answers invalid_argument for indices out of range or inconsistent numbers of normals, colours or labels.
[[nodiscard]] Status write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                                PlyFormat format = PlyFormat::binary_little_endian,
                                std::span<const std::int32_t> labels = {});
/// Converts to a mesh. Faces of more than three corners are split into triangles. Answers corrupt_data without x y z,
/// for indices out of range, and for faces of over 1,000 corners that are not convex.
[[nodiscard]] Result<TriangleMesh> mesh_from_ply(const PlyFile& file);
[[nodiscard]] Result<TriangleMesh> read_mesh(const std::filesystem::path& path);

}  // namespace saccade
