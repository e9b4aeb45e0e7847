// SPDX-License-Identifier: Apache-2.0
#pragma once
// write_labels, read_labels: one number per point of a cloud, in PCD, PLY, text, SemanticKITTI's and NumPy's formats;
// and definitions of the numbers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/files/column_table.hpp"

namespace saccade {

/// Definition of a label's number.
struct NamedLabel {
  std::uint32_t number{0};  ///< 0 means no label
  std::string name;
  std::string class_name;               ///< empty: the label is its own class
  std::uint32_t instance{0};            ///< number within its class; 0: none
  std::array<std::uint8_t, 3> color{};  ///< red, green, blue
  std::size_t points{0};                ///< points with this label
};

/// Answers invalid_argument for a suffix that write_labels does not know.
[[nodiscard]] Status check_labels_path(const std::filesystem::path& path);
/// Writes labels atomically. `labels`: the number of each point, 0 for none. The suffix decides the format:
/// - .pcd, .ply: the cloud with every field, bit for bit, and the field label (u32) with these numbers; an existing
/// field label becomes label_input. A cloud read from this format also keeps its encoding, with size and viewpoint of a
/// PCD, faces, lists and comments of a PLY.
/// - .xyz, .txt, .csv: text with label as the last column; lines of a cloud that was read from text stay unchanged.
/// - .las: the bytes of the LAS that was read, with these numbers as classes.
/// - .label: SemanticKITTI's: the class in the lower 16 bits, the instance in the upper 16. The class of a label is its
/// class_name where that is a number, otherwise the smallest number among the labels of its class. A label without
/// class and instance is written as the 32 bits of its number, as it was read.
/// - .npy: a NumPy array of uint32.
/// @return size_mismatch unless there is one label per point; invalid_argument for another suffix, and for a class or
/// an instance of more than 16 bits in a .label; unsupported for fields that the format cannot hold; io_failure.
/// O(file).
[[nodiscard]] Status write_labels(const std::filesystem::path& path, const CloudFile& cloud,
                                  std::span<const std::uint32_t> labels, std::span<const NamedLabel> names = {});

/// Writes one line "NUMBER NAME" per label, atomically. Answers invalid_argument for a name of more than one line.
[[nodiscard]] Status write_label_names_text(const std::filesystem::path& path, std::span<const NamedLabel> names);
/// Writes {"schema": "saccade-labels-1", "labels": [{"number", "name", "class", "instance", "color": "#rrggbb",
/// "points"}, …]}, atomically.
[[nodiscard]] Status write_label_names_json(const std::filesystem::path& path, std::span<const NamedLabel> names);

/// Parses one number per line, ignoring comments (#, //) and a first line "label".
/// @return corrupt_data with the line for a word that is not an integer, and for a second word.
[[nodiscard]] Result<Column> parse_label_lines(std::string_view text);

/// Reads labels of `points` points; 0 is none. From a .label all 32 bits (class + 65536 · instance), from a .npy an
/// array of integers, from .xyz, .txt, .csv and .pts lines of one number each or a column label, otherwise the field
/// label of a PCD, PLY or LAS, and classes of a LAS without one.
/// @return size_mismatch for another number of labels; not_found without a field label; corrupt_data with the point for
/// a label that is negative, above 2^32 − 1 or not an integer; errors as of the readers of these formats. O(file).
[[nodiscard]] Result<std::vector<std::uint32_t>> read_labels(const std::filesystem::path& path, std::size_t points);

}  // namespace saccade
