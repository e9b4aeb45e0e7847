// SPDX-License-Identifier: Apache-2.0
#pragma once
// write_labels, read_labels: one number per point of a cloud, in PCD, PLY, text, SemanticKITTI's and NumPy's formats;
// and what the numbers mean.

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

/// What a number of a label stands for.
struct NamedLabel {
  std::uint32_t number{0};  ///< 0 is no label
  std::string name;
  std::string class_name;               ///< empty: the label is a class of its own
  std::uint32_t instance{0};            ///< of its class; 0: none
  std::array<std::uint8_t, 3> color{};  ///< red, green, blue
  std::size_t points{0};                ///< that have the label
};

/// invalid_argument for a suffix that write_labels does not know.
[[nodiscard]] Status check_labels_path(const std::filesystem::path& path);
/// Atomic. `labels`: the number of each point, 0 for none. What is written follows from the suffix:
/// - .pcd, .ply: the cloud with every field, bit for bit, and the field label (u32) of these numbers; a field label of
///   the cloud is kept as label_input. A cloud that was read from the same format keeps its encoding, too, and with it
///   size and viewpoint of a PCD, faces, lists and comments of a PLY.
/// - .xyz, .txt, .csv: text with label as the last column; lines of a cloud that was read from text stay as they were.
/// - .label: SemanticKITTI's: the class in the lower 16 bits, the instance in the upper 16. The class of a label is its
///   class_name where that is a number, else the smallest number of the labels of its class; of a label without a class
///   it is its number.
/// - .npy: a NumPy array of uint32.
/// @return size_mismatch unless there is one label per point; invalid_argument for another suffix, and for a class or
/// an instance of more than 16 bits in a .label; unsupported for fields that the format cannot hold; io_failure.
/// O(file).
[[nodiscard]] Status write_labels(const std::filesystem::path& path, const CloudFile& cloud,
                                  std::span<const std::uint32_t> labels, std::span<const NamedLabel> names = {});

/// One line "NUMBER NAME" per label. Atomic. invalid_argument for a name of more than one line.
[[nodiscard]] Status write_label_names_text(const std::filesystem::path& path, std::span<const NamedLabel> names);
/// {"schema": "saccade-labels-1", "labels": [{"number", "name", "class", "instance", "color": "#rrggbb", "points"},
/// …]}. Atomic.
[[nodiscard]] Status write_label_names_json(const std::filesystem::path& path, std::span<const NamedLabel> names);

/// One number per line, comments (#, //) and a first line "label" aside.
/// @return corrupt_data with the line for a word that is no whole number, and for a second word.
[[nodiscard]] Result<Column> parse_label_lines(std::string_view text);

/// Labels of `points` points; 0 is none. From a .label all 32 bits (class + 65536 · instance), from a .npy an array of
/// whole numbers, from .xyz, .txt, .csv and .pts lines of one number each or a column label, else the field label of a
/// PCD or PLY.
/// @return size_mismatch when there are not so many; not_found without a field label; corrupt_data with the point for a
/// label that is negative, above 2^32 − 1 or no whole number; errors as of the readers of these formats. O(file).
[[nodiscard]] Result<std::vector<std::uint32_t>> read_labels(const std::filesystem::path& path, std::size_t points);

}  // namespace saccade
