// SPDX-License-Identifier: Apache-2.0
#pragma once
// CloudFields: the file of a cloud with every field, kept in memory or read again when it is needed.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/io/clouds/cloud_io.hpp"

namespace saccade::server {

/// Labels need a cloud's points alone; its other fields are needed where labels are written and where points are
/// coloured by a field. Fields of a large cloud would take more memory than its points, so they are read again then.
class CloudFields {
 public:
  /// Files whose fields take more are read again when they are needed.
  static constexpr std::size_t kMostKept_bytes{1U << 30U};

  CloudFields() = default;
  /// Keeps a file that was just read from `path`, unless its fields take more than `most_kept_bytes`.
  CloudFields(std::filesystem::path path, CloudFile file, std::size_t most_kept_bytes = kMostKept_bytes);

  /// Returns the names of the fields that points can be coloured by (scalar_field_names).
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool in_memory() const { return kept_ != nullptr; }
  /// Returns the file. One that is not in memory is read: O(file). Errors of read_cloud; corrupt_data where the file is
  /// not as it was.
  [[nodiscard]] Result<std::shared_ptr<const CloudFile>> file() const;
  /// Returns a number per point of one of names(). The field that was named last stays in memory: 4 bytes per point.
  /// Errors of file. For one thread.
  [[nodiscard]] Result<std::span<const float>> numbers(std::string_view name) const;

 private:
  std::filesystem::path path_;
  std::shared_ptr<const CloudFile> kept_;
  std::vector<std::string> names_;
  std::size_t rows_{0};
  std::uintmax_t file_bytes_{0};
  std::filesystem::file_time_type written_at_{};
  mutable std::string named_;  ///< field of `numbers_`; empty: none
  mutable std::vector<float> numbers_;
};

}  // namespace saccade::server
