// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunFolder: where a command's results go; checked before the work, never mixed with foreign files.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"

namespace saccade::cli {

/// An output folder of one command. It is made at the beginning; if nothing was written into a folder that was made,
/// it is removed again.
class RunFolder {
 public:
  /// Makes the folder, or takes one that is empty, holds an earlier run (nothing but `own_files`, or a file or
  /// folder `marker`) or is forced. A `marker` that is a document and says that its run cannot be repeated is not
  /// written over unless forced. A write of some size is tried, so that a folder that cannot be written and a full disk
  /// show before the work. Half-written files that a killed run left are removed. The folder is locked while this
  /// lives. invalid_argument for foreign content, for such a run, or when another run holds the lock; io_failure.
  [[nodiscard]] static Result<RunFolder> open(const std::filesystem::path& path,
                                              std::span<const std::string_view> own_files, std::string_view marker,
                                              bool force);
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  /// Removes what an earlier run left under these names. io_failure.
  [[nodiscard]] Status remove(std::span<const std::string_view> names) const;

 private:
  RunFolder(std::filesystem::path path, bool made) : path_{std::move(path)}, made_{made} {}
  std::filesystem::path path_;
  bool made_;
  int lock_{-1};  // a descriptor of the folder itself, so that the lock leaves no file and ends with the process
};

}  // namespace saccade::cli
