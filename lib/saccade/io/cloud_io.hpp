// SPDX-License-Identifier: Apache-2.0
#pragma once
// CloudFile: a point cloud with every field of the file that it came from, PCD or PLY; labels in and out.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/pcd_io.hpp"
#include "saccade/io/ply_io.hpp"
#include "saccade/segment/point_cloud.hpp"

namespace saccade {

inline constexpr std::string_view kLabelField{"label"};

struct CloudFile {
  std::variant<PcdFile, PlyFile> file;

  /// One row per point: a PCD's fields, or the scalar properties of a PLY's element "vertex".
  [[nodiscard]] const ColumnTable& fields() const;
  [[nodiscard]] ColumnTable& fields();
};

/// PCD or PLY, told apart by their first bytes. corrupt_data for anything else, and for a PLY without vertices; errors
/// as of read_pcd and read_ply. O(file).
[[nodiscard]] Result<CloudFile> read_cloud(const std::filesystem::path& path);
/// Atomic. PLY for a name that ends in .ply, else binary PCD. Binary keeps every bit of every field; a PLY written as
/// PLY keeps its faces, lists and comments, too. unsupported for a field that a PLY cannot hold,
/// or a list of points that a PCD cannot.
[[nodiscard]] Status write_cloud(const std::filesystem::path& path, const CloudFile& cloud);

/// Positions from x, y, z; normals from normal_x … or nx …; colours from rgb or rgba (packed, as PCL does) or red,
/// green, blue, where there are any.
/// @return corrupt_data without x, y and z.
[[nodiscard]] Result<PointCloud> cloud_from_fields(const ColumnTable& fields);

/// Labels of a field: 0, negative and kUnlabelled itself become kUnlabelled.
/// @return not_found without the field; corrupt_data for values that are no whole numbers.
[[nodiscard]] Result<std::vector<std::uint32_t>> labels_from_fields(const ColumnTable& fields,
                                                                    std::string_view field = kLabelField);
/// Adds the field label (uint32): label + 1, and 0 for kUnlabelled. A field of that name is kept under another one:
/// label_input, or label_input2 and so on where that is taken.
/// @return the name that the earlier field has now; empty if there was none. Expects one label per row.
std::string add_labels(CloudFile& cloud, std::span<const std::uint32_t> labels);

}  // namespace saccade
