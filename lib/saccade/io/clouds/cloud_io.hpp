// SPDX-License-Identifier: Apache-2.0
#pragma once
// CloudFile: a point cloud with every field of the file that it came from: PCD, PLY, text or KITTI; labels as a field.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/result.hpp"
#include "saccade/io/clouds/pcd_io.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/clouds/text_cloud.hpp"

namespace saccade {

inline constexpr std::string_view kLabelField{"label"};
/// Of surfels.
inline constexpr std::string_view kRadiusField{"radius"};
/// What a field label of the input is called beside a new one.
inline constexpr std::string_view kEarlierLabelField{"label_input"};

struct CloudFile {
  std::variant<PcdFile, PlyFile, TextCloud> file;  ///< a scan of KITTI is a PCD in the sensor's frame

  /// One row per point: a PCD's fields, the columns of a text, or the scalar properties of a PLY's element "vertex".
  [[nodiscard]] const ColumnTable& fields() const;
  [[nodiscard]] ColumnTable& fields();
};

/// PCD or PLY, told apart by their first bytes; else text where the suffix is .xyz, .txt, .csv or .pts, and a scan of
/// KITTI where it is .bin. corrupt_data for anything else, and for a PLY without vertices; errors as of parse_pcd,
/// parse_ply, parse_text_cloud and parse_kitti_scan. O(file).
[[nodiscard]] Result<CloudFile> read_cloud(const std::filesystem::path& path);
/// The clouds in a folder, by their suffix (.pcd, .ply, .xyz, .txt, .csv, .pts, .bin, in letters of either case), in
/// the order of their names; hidden files are left out, and texts that begin as no cloud does.
/// @return not_found when the folder is not there or holds none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> list_clouds(const std::filesystem::path& folder);
/// Atomic. PLY for a name that ends in .ply, text for one that ends in .xyz, .txt, .csv or .pts, else binary PCD.
/// Binary keeps every bit of every field; a PLY written as PLY keeps its faces, lists and comments, too. unsupported
/// for a field that a PLY cannot hold, or a list of points that a PCD or a text cannot.
[[nodiscard]] Status write_cloud(const std::filesystem::path& path, const CloudFile& cloud);

/// Positions from x, y, z; normals from normal_x … or nx …; colours from rgb or rgba (packed, as PCL does), red, green,
/// blue, or r, g, b, radii from radius, where there are any.
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
/// The same with the numbers as they are.
std::string add_label_field(CloudFile& cloud, std::span<const std::uint32_t> numbers);
/// Adds a field of f32. A field of that name is kept as NAME_input, or NAME_input2 and so on; the rest as add_labels.
std::string add_number_field(CloudFile& cloud, std::string_view name, std::span<const float> numbers);

}  // namespace saccade
