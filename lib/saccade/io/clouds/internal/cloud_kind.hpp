// SPDX-License-Identifier: Apache-2.0
#pragma once
// CloudKind: the format of a cloud's file. The content decides; the name is a hint where content leaves it open.

#include <filesystem>
#include <string>
#include <string_view>

namespace saccade {

enum class CloudKind { pcd, ply, text, kitti, npy, las, e57, other };

/// Returns the suffix of a name, with its dot, in lower case.
[[nodiscard]] std::string lower_suffix(const std::filesystem::path& path);

/// Bytes at the beginning of a file that suffice for kind_of_cloud.
inline constexpr std::size_t kKindBytes{1 << 16};

/// @param head  the file, or its first kKindBytes.
[[nodiscard]] CloudKind kind_of_cloud(const std::filesystem::path& path, std::string_view head);

/// Tells whether a file of a folder is a cloud: by its suffix, and where many things have that suffix (.txt, .csv,
/// .npy) by its beginning, too. Hidden files are not.
[[nodiscard]] bool is_cloud_file(const std::filesystem::path& path);

}  // namespace saccade
