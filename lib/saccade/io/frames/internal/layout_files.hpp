// SPDX-License-Identifier: Apache-2.0
#pragma once
// Files of a layout: names by patterns, in the order of their numbers. Used by rgbd_layout.cpp and what it calls.

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

enum class FileKind { depth, color, any };

/// File with the part of its name that '#' stands for.
struct KeyedFile {
  std::string key;
  std::filesystem::path path;
};

/// Compares names of frames: by value where both are decimal numbers, else with runs of digits by their value, else
/// by character.
[[nodiscard]] bool comes_before(std::string_view a, std::string_view b);

/// Returns the number in a frame's name: the first of two that a dash joins ("0000001-000000033369"), else the last
/// run of digits; nullopt without digits.
[[nodiscard]] std::optional<std::int64_t> number_in(std::string_view key);

/// Finds the regular files of a pattern, relative to the folder and ordered by comes_before of their keys. Patterns
/// have '/' between folders, '*' for any text, and '#' for any text that is kept as the key. Of files with one key the
/// first by extension stays. A folder that cannot be listed has no files.
[[nodiscard]] std::vector<KeyedFile> find_files(const std::filesystem::path& folder, std::string_view pattern,
                                                FileKind kind = FileKind::any);
/// Returns the files of the first pattern that has any.
[[nodiscard]] std::vector<KeyedFile> find_first(const std::filesystem::path& folder,
                                                std::span<const std::string_view> patterns,
                                                FileKind kind = FileKind::any);

/// Files by the frame that they belong to.
class FilesByFrame {
 public:
  explicit FilesByFrame(const std::vector<KeyedFile>& files);
  /// Returns the file with this key, else the only one with the key's number; nullptr without one.
  [[nodiscard]] const std::filesystem::path* find(const std::string& key) const;

 private:
  std::map<std::string, std::filesystem::path, std::less<>> by_key_;
  std::map<std::int64_t, std::vector<std::filesystem::path>> by_number_;
};

}  // namespace saccade
