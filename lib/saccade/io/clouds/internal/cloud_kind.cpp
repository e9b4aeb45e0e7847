// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/cloud_kind.hpp"

#include <algorithm>
#include <fstream>
#include <string>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/files/npy_io.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

std::string head_of(const fs::path& path) {
  std::string head(kKindBytes, '\0');
  std::ifstream file{path, std::ios::binary};
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return head;
}

}  // namespace

std::string lower_suffix(const fs::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return suffix;
}

CloudKind kind_of_cloud(const fs::path& path, std::string_view head) {
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return CloudKind::ply;
  if (head.starts_with("# .PCD")) return CloudKind::pcd;
  if (is_las(head)) return CloudKind::las;
  if (head.starts_with("ASTM-E57")) return CloudKind::e57;
  if (is_npy(head)) return CloudKind::npy;
  if (has_text_cloud_suffix(path)) return CloudKind::text;
  if (lower_suffix(path) == ".bin") return CloudKind::kitti;
  if (head.starts_with("ply")) return CloudKind::ply;
  for (const char* begin : {"VERSION", "FIELDS", "COLUMNS"}) {
    if (head.starts_with(begin)) return CloudKind::pcd;
  }
  if (looks_like_text_cloud(head)) return CloudKind::text;
  return head.starts_with("#") ? CloudKind::pcd : CloudKind::other;
}

bool is_cloud_file(const fs::path& path) {
  const std::string suffix = lower_suffix(path);
  if (path.filename().string().starts_with(".")) return false;
  if (suffix == ".txt" || suffix == ".csv") {
    const std::string head = head_of(path);
    return kind_of_cloud(path, head) != CloudKind::text || looks_like_text_cloud(head);
  }
  if (suffix == ".npy") return is_npy_table(head_of(path));  // labels are one row
  return has_cloud_suffix(path);
}

bool is_cloud(const fs::path& path) {
  if (has_cloud_suffix(path)) return is_cloud_file(path);
  return kind_of_cloud(path, head_of(path)) != CloudKind::other;
}

}  // namespace saccade
