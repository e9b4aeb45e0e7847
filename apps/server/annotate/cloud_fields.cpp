// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/cloud_fields.hpp"

#include "saccade/io/clouds/scalar_fields.hpp"

namespace saccade::server {

CloudFields::CloudFields(std::filesystem::path path, CloudFile file, std::size_t most_kept_bytes)
    : path_{std::move(path)}, names_{scalar_field_names(file.fields())}, rows_{file.fields().rows} {
  std::error_code ignored;  // a file that is gone is noticed when it is read again
  file_bytes_ = std::filesystem::file_size(path_, ignored);
  written_at_ = std::filesystem::last_write_time(path_, ignored);
  if (rows_ * file.fields().row_bytes() <= most_kept_bytes) kept_ = std::make_shared<const CloudFile>(std::move(file));
}

Result<std::shared_ptr<const CloudFile>> CloudFields::file() const {
  if (kept_) return kept_;
  const auto changed = [&] {
    return Error{
        Errc::corrupt_data,
        "the cloud changed after it was opened, so its fields are not those of the labelled points; put it back "
        "as it was",
        path_.string()};
  };
  std::error_code problem;
  const std::uintmax_t bytes = std::filesystem::file_size(path_, problem);
  if (!problem && (bytes != file_bytes_ || std::filesystem::last_write_time(path_, problem) != written_at_)) {
    return changed();
  }
  SACCADE_TRY(CloudFile read, read_cloud(path_));
  if (read.fields().rows != rows_) return changed();
  return std::make_shared<const CloudFile>(std::move(read));
}

Result<std::span<const float>> CloudFields::numbers(std::string_view name) const {
  if (named_ != name || numbers_.size() != rows_) {
    SACCADE_TRY(const auto read, file());
    numbers_ = scalar_values(read->fields(), name);
    named_ = name;
  }
  return std::span<const float>{numbers_};
}

}  // namespace saccade::server
