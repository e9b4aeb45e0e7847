// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/label_export.hpp"

#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "saccade/cloud/label_boxes.hpp"
#include "saccade/io/clouds/label_boxes_io.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::server {
namespace {

namespace fs = std::filesystem;

/// Folder that only this user can read, removed with its content at its end.
class PrivateFolder {
 public:
  [[nodiscard]] static Result<PrivateFolder> make() {
    std::error_code code;
    const fs::path parent = fs::temp_directory_path(code);
    std::string pattern = (parent / "saccade-XXXXXX").string();
    if (code || ::mkdtemp(pattern.data()) == nullptr) {
      return Error{Errc::io_failure, std::string{"cannot make a temporary folder: "} + std::strerror(errno), pattern};
    }
    return PrivateFolder{pattern};
  }
  PrivateFolder(PrivateFolder&& other) noexcept : path_{std::exchange(other.path_, fs::path{})} {}
  PrivateFolder& operator=(PrivateFolder&&) = delete;
  ~PrivateFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  explicit PrivateFolder(fs::path path) : path_{std::move(path)} {}
  fs::path path_;
};

struct Format {
  const char* name;
  const char* content_type;
};
constexpr std::array<Format, 10> kFormats{{{"pcd", "application/octet-stream"},
                                           {"ply", "application/octet-stream"},
                                           {"txt", "text/plain; charset=utf-8"},
                                           {"csv", "text/csv; charset=utf-8"},
                                           {"label", "application/octet-stream"},
                                           {"npy", "application/octet-stream"},
                                           {"names.txt", "text/plain; charset=utf-8"},
                                           {"names.json", "application/json"},
                                           {"boxes.json", "application/json"},
                                           {"boxes.txt", "text/plain; charset=utf-8"}}};

Status write_boxes(const fs::path& file, const LoadedCloud& cloud, const LabelledPoints& labels) {
  const Eigen::Vector3d up = box_up(cloud, file.extension() == ".json");
  return write_label_boxes(file, label_boxes(cloud.points.positions_m, labels.labels, up), labels.names(),
                           cloud.points.offset_m);
}

Status write_points(const fs::path& file, const LoadedCloud& cloud, const LabelledPoints& labels) {
  SACCADE_TRY(const auto fields, cloud.fields.file());
  return write_labels(file, *fields, labels.labels, labels.names());
}

}  // namespace

Result<HttpAnswer> label_file(const LoadedCloud& cloud, const LabelledPoints& labels, const std::string& format) {
  const auto* known =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& one) { return format == one.name; });
  if (known == kFormats.end()) {
    return Error{Errc::invalid_argument,
                 "format is pcd, ply, txt, csv, label, npy, names.txt, names.json, boxes.json or boxes.txt", "labels"};
  }
  SACCADE_TRY(const PrivateFolder folder, PrivateFolder::make());
  const fs::path file = folder.path() / (std::string{"labels."} + known->name);
  const bool is_names = format.starts_with("names.");
  const auto said = [](Error error) {
    error.context = "labels";  // hides the temporary path
    return error;
  };
  const Status written = format.starts_with("boxes.") ? write_boxes(file, cloud, labels)
                         : is_names                   ? write_names(file, labels.names())
                                                      : write_points(file, cloud, labels);
  if (!written) return said(written.error());
  auto content = read_file(file);
  if (!content) return said(content.error());
  HttpAnswer answer;
  answer.content_type = known->content_type;
  answer.file_name = cloud.path.stem().string() + "_labels." + known->name;
  answer.body.resize(content->size());
  if (!content->empty()) std::memcpy(answer.body.data(), content->data(), content->size());
  return answer;
}

}  // namespace saccade::server
