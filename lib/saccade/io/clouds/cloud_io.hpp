// SPDX-License-Identifier: Apache-2.0
#pragma once
// CloudFile: a point cloud with every field of its file: PCD, PLY, LAS, NumPy, text or KITTI; labels as a field.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/core/result.hpp"
#include "saccade/io/clouds/las_io.hpp"
#include "saccade/io/clouds/pcd_io.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/io/clouds/text_cloud.hpp"

namespace saccade {

inline constexpr std::string_view kLabelField{"label"};
/// Name of the field for surfel radii.
inline constexpr std::string_view kRadiusField{"radius"};
/// New name of the input's field label beside a new one.
inline constexpr std::string_view kEarlierLabelField{"label_input"};
/// Name of the field for the classes of a LAS.
inline constexpr std::string_view kLasClassField{"classification"};
/// Suffixes of clouds, for messages. A text needs none of them: content decides.
inline constexpr std::string_view kCloudSuffixes{".pcd, .ply, .las, .npy, .xyz, .txt, .csv, .pts, .asc, .bin"};

struct CloudFile {
  /// A scan of KITTI becomes a PCD in the sensor's frame, a table of NumPy a PCD.
  std::variant<PcdFile, PlyFile, TextCloud, LasFile> file;

  /// Return the table with one row per point: fields of a PCD or LAS, the columns of a text, or the scalar properties
  /// of a PLY's element "vertex".
  [[nodiscard]] const ColumnTable& fields() const;
  [[nodiscard]] ColumnTable& fields();
};

/// Reads a cloud. The first bytes decide, and the name where they leave it open: a file without header is a scan of
/// KITTI with the suffix .bin, if at least half of its points are plausible.
/// @return corrupt_data for an empty file and for anything else; unsupported for LAZ and E57, with how to convert them;
/// errors as parse_pcd, parse_ply, parse_las, parse_npy_table, parse_text_cloud and parse_kitti_scan. O(file).
[[nodiscard]] Result<CloudFile> read_cloud(const std::filesystem::path& path);
/// Tells whether the suffix is one of kCloudSuffixes, .xyzn, .xyzrgb, .laz or .e57, in either case.
[[nodiscard]] bool has_cloud_suffix(const std::filesystem::path& path);
/// Tells whether a file is a cloud, or should be one by its suffix: its content decides where the suffix leaves it
/// open, as .txt, .csv, .npy and unknown ones do. Reads the file's beginning.
[[nodiscard]] bool is_cloud(const std::filesystem::path& path);
/// Lists the clouds in a folder by suffix, sorted by name; without hidden files, texts that do not begin like a cloud
/// and arrays of NumPy of one dimension, which hold labels.
/// @return not_found when the folder is not there or holds none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> list_clouds(const std::filesystem::path& folder);
/// Writes a cloud atomically. PLY for names ending in .ply, text for suffixes of text, otherwise binary PCD; .las for a
/// cloud that was read from a LAS: its bytes with the field label, or else classification, as classes.
/// Binary keeps every bit of every field; a PLY written as PLY also keeps its faces, lists and comments. Answers
/// unsupported for a field that a PLY cannot hold, a list of points that a PCD or a text cannot, a class that the LAS
/// cannot, and the suffixes .laz, .e57, .npy and .bin.
[[nodiscard]] Status write_cloud(const std::filesystem::path& path, const CloudFile& cloud);

/// Largest median coordinate that needs no offset; there a float resolves 0.06 mm.
inline constexpr double kFarFromOrigin_m{1000.0};

/// Converts fields to a cloud: positions from x, y, z, relative to the cloud's offset_m; normals from normal_x … or nx
/// …; colours from rgb or rgba (packed, as in PCL), red, green, blue, or r, g, b; radii from radius, where present.
/// Where a median coordinate is beyond kFarFromOrigin_m, offset_m is the median point, rounded to hundreds of metres;
/// otherwise, and beyond 10^8 m, it is zero. Distances between points near it thus keep the precision of the file's
/// doubles.
/// @return corrupt_data without x, y and z.
[[nodiscard]] Result<PointCloud> cloud_from_fields(const ColumnTable& fields);

/// Reads labels from a field: 0, negative numbers and kUnlabelled become kUnlabelled.
/// @return not_found without the field; corrupt_data for values that are not integers.
[[nodiscard]] Result<std::vector<std::uint32_t>> labels_from_fields(const ColumnTable& fields,
                                                                    std::string_view field = kLabelField);
/// Adds the field label (uint32): label + 1, and 0 for kUnlabelled. An existing field of that name is renamed: to
/// label_input, or label_input2 and so on where that is taken.
/// @return the new name of the existing field; empty if there was none. Expects one label per row.
std::string add_labels(CloudFile& cloud, std::span<const std::uint32_t> labels);
/// Adds the field with the given numbers unchanged.
std::string add_label_field(CloudFile& cloud, std::span<const std::uint32_t> numbers);
/// Adds a field of f32. An existing field of that name is renamed to NAME_input, or NAME_input2 and so on; otherwise as
/// add_labels.
std::string add_number_field(CloudFile& cloud, std::string_view name, std::span<const float> numbers);

}  // namespace saccade
