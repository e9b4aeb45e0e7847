// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/label_io.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/npy_io.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMost16{std::numeric_limits<std::uint16_t>::max()};

/// SemanticKITTI's 32 bits for each label.
class KittiLabels {
 public:
  [[nodiscard]] static Result<KittiLabels> create(std::span<const NamedLabel> names) {
    std::map<std::string_view, std::uint32_t> first_of_class;
    for (const NamedLabel& label : names) {
      const auto [entry, added] = first_of_class.emplace(label.class_name, label.number);
      if (!added) entry->second = std::min(entry->second, label.number);
    }
    KittiLabels kitti;
    for (const NamedLabel& label : names) {
      if (label.class_name.empty() && label.instance == 0) continue;  // its bits are its number
      const auto numbered = parse_integer<std::uint32_t>(label.class_name);
      const std::uint32_t of_class = label.class_name.empty() ? label.number : first_of_class[label.class_name];
      SACCADE_CHECK(kitti.add(label.number, numbered.value_or(of_class), label.instance));
    }
    return kitti;
  }

  /// Returns the number itself for a label without class and instance: what was read from a .label is written as it
  /// was.
  [[nodiscard]] std::uint32_t bits(std::uint32_t number) const {
    const auto found = bits_.find(number);
    return found == bits_.end() ? number : found->second;
  }

 private:
  [[nodiscard]] Status add(std::uint32_t number, std::uint32_t of_class, std::uint32_t instance) {
    if (of_class > kMost16 || instance > kMost16) {
      return Error{Errc::invalid_argument,
                   "a .label has 16 bits for a class and 16 for an instance, but label " + std::to_string(number) +
                       " is of class " + std::to_string(of_class) + ", instance " + std::to_string(instance),
                   {}};
    }
    bits_[number] = of_class | instance << 16U;
    return {};
  }

  std::map<std::uint32_t, std::uint32_t> bits_;
};

Result<std::vector<std::uint32_t>> kitti_labels(std::span<const std::uint32_t> labels,
                                                std::span<const NamedLabel> names) {
  SACCADE_TRY(const KittiLabels kitti, KittiLabels::create(names));
  std::vector<std::uint32_t> bits(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    bits[i] = i > 0 && labels[i] == labels[i - 1] ? bits[i - 1] : kitti.bits(labels[i]);
  }
  return bits;
}

Status write_npy(const fs::path& path, std::span<const std::uint32_t> labels) {
  SACCADE_TRY(AtomicFile out, AtomicFile::create(path));
  SACCADE_CHECK(out.write(npy_header("<u4", std::array{labels.size()})));
  SACCADE_CHECK(out.write_values(labels));
  return out.commit();
}

/// Writes in the encoding that the cloud was read in, if it was read from this format.
Status write_in_its_encoding(const fs::path& path, const CloudFile& cloud) {
  const auto* pcd = std::get_if<PcdFile>(&cloud.file);
  if (pcd != nullptr && path.extension() == ".pcd") return write_pcd(path, *pcd, pcd->format);
  const auto* ply = std::get_if<PlyFile>(&cloud.file);
  if (ply != nullptr && path.extension() == ".ply") return write_ply(path, *ply, ply->format);
  return write_cloud(path, cloud);
}

std::string hex(const std::array<std::uint8_t, 3>& color) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", color[0], color[1], color[2]);
  return text.data();
}

bool is_text_suffix(std::string_view suffix) { return suffix == ".xyz" || suffix == ".txt" || suffix == ".csv"; }

}  // namespace

Status check_labels_path(const fs::path& path) {
  const std::string suffix = path.extension().string();
  if (is_text_suffix(suffix) || suffix == ".pcd" || suffix == ".ply" || suffix == ".npy" || suffix == ".label" ||
      suffix == ".las")
    return {};
  return Error{Errc::invalid_argument, "labels are written as .pcd, .ply, .las, .xyz, .txt, .csv, .label or .npy",
               path.string()};
}

Status write_labels(const fs::path& path, const CloudFile& cloud, std::span<const std::uint32_t> labels,
                    std::span<const NamedLabel> names) {
  if (labels.size() != cloud.fields().rows) {
    return Error{Errc::size_mismatch,
                 std::to_string(labels.size()) + " labels for " + std::to_string(cloud.fields().rows) + " points",
                 path.string()};
  }
  SACCADE_CHECK(check_labels_path(path));
  const std::string suffix = path.extension().string();
  if (suffix == ".npy") return write_npy(path, labels);
  if (suffix == ".label") {
    SACCADE_TRY(const std::vector<std::uint32_t> bits, in_file(kitti_labels(labels, names), path));
    return write_file_atomically(path, std::as_bytes(std::span{bits}));
  }
  const bool is_text = is_text_suffix(suffix);
  const auto* text = std::get_if<TextCloud>(&cloud.file);
  if (text != nullptr && is_text) return write_labelled_text(path, *text, labels);
  CloudFile labelled = cloud;
  add_label_field(labelled, labels);
  return write_in_its_encoding(path, labelled);
}

Status write_label_names_text(const fs::path& path, std::span<const NamedLabel> names) {
  std::string text;
  for (const NamedLabel& label : names) {
    if (label.name.find_first_of("\r\n") != std::string::npos) {
      return Error{Errc::invalid_argument, "the name of label " + std::to_string(label.number) + " must be one line",
                   path.string()};
    }
    text.append(std::to_string(label.number)).append(" ").append(label.name).append("\n");
  }
  return write_file_atomically(path, text);
}

Status write_label_names_json(const fs::path& path, std::span<const NamedLabel> names) {
  nlohmann::ordered_json labels = nlohmann::ordered_json::array();
  for (const NamedLabel& label : names) {
    labels.push_back({{"number", label.number},
                      {"name", label.name},
                      {"class", label.class_name},
                      {"instance", label.instance},
                      {"color", hex(label.color)},
                      {"points", label.points}});
  }
  const nlohmann::ordered_json json{{"schema", "saccade-labels-1"}, {"labels", labels}};
  constexpr int kIndent{2};
  return write_file_atomically(path, json.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace saccade
