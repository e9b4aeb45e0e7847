// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/sequence_labels.hpp"

#include <algorithm>
#include <utility>

namespace saccade::server {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> oldest_first(std::span<const fs::path> files) {
  std::vector<std::pair<fs::file_time_type, fs::path>> dated;
  for (const fs::path& file : files) {
    std::error_code code;
    const fs::file_time_type written = fs::last_write_time(file, code);
    if (!code) dated.emplace_back(written, file);
  }
  std::stable_sort(dated.begin(), dated.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<fs::path> ordered;
  for (auto& [written, file] : dated) ordered.push_back(std::move(file));
  return ordered;
}

}  // namespace

SequenceLabels SequenceLabels::of_sessions(std::span<const fs::path> sessions) {
  SequenceLabels labels;
  for (const fs::path& file : oldest_first(sessions)) {
    const auto saved = read_journal(file);
    if (!saved) continue;
    ActionHistory history{static_cast<std::size_t>(saved->subject.points)};
    for (const AnnotationAction& action : saved->actions) history.push(action);
    for (const std::uint32_t label : history.written().labels) {
      if (const LabelInfo* info = history.definition(label)) labels.defined_[label] = *info;
    }
  }
  return labels;
}

void SequenceLabels::take(std::span<const NumberedLabel> labels) {
  for (const NumberedLabel& label : labels) defined_[label.number] = label.info;
}

void SequenceLabels::update(const Annotation& annotation, std::span<const std::uint32_t> labels) {
  const auto& defined = annotation.label_table().defined();
  for (const std::uint32_t label : labels) {
    const auto found = defined.find(label);
    if (found == defined.end()) {
      defined_.erase(label);
    } else {
      defined_[label] = found->second;
    }
  }
}

void SequenceLabels::update(const Annotation& annotation) {
  for (const auto& [label, info] : annotation.label_table().defined()) defined_[label] = info;
}

std::vector<NumberedLabel> SequenceLabels::list() const {
  std::vector<NumberedLabel> labels;
  for (const auto& [number, info] : defined_) labels.push_back({number, info});
  return labels;
}

Pose place_in(const Pose& T_world_to, const Eigen::Vector3d& to_offset_m, const Pose& T_world_from,
              const Eigen::Vector3d& from_offset_m) {
  const Pose T_to_from = T_world_to.inverse(Eigen::Isometry) * T_world_from;
  Pose T = T_to_from;
  T.translation() = T_to_from * from_offset_m - to_offset_m;
  return T;
}

}  // namespace saccade::server
