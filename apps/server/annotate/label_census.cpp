// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/label_census.hpp"

#include <array>
#include <string>

namespace saccade::server {
namespace {

std::size_t count_in(const std::map<std::uint32_t, std::size_t>& counts, std::uint32_t label) {
  const auto found = counts.find(label);
  return found == counts.end() ? 0 : found->second;
}

/// Collects keys whose values differ, or that only one map has.
void collect_different(const std::map<std::uint32_t, std::size_t>& before,
                       const std::map<std::uint32_t, std::size_t>& now, std::set<std::uint32_t>& different) {
  auto b = before.begin();
  auto n = now.begin();
  while (b != before.end() || n != now.end()) {
    const bool only_before = n == now.end() || (b != before.end() && b->first < n->first);
    const bool only_now = b == before.end() || (n != now.end() && n->first < b->first);
    const std::uint32_t label = only_now ? n->first : b->first;
    if (only_before || only_now || b->second != n->second) different.insert(label);
    if (!only_now) ++b;
    if (!only_before) ++n;
  }
}

}  // namespace

LabelCensus::LabelCensus(const Annotation& annotation) : points_{annotation.counts()} {
  for (const ControlPoint& control : annotation.control_points()) {
    label_of_[control.point] = control.label;
    ++control_points_[control.label];
  }
}

std::set<std::uint32_t> LabelCensus::update(const Annotation& annotation, const Applied& applied) {
  std::set<std::uint32_t> changed{applied.labels.begin(), applied.labels.end()};
  for (const std::uint32_t point : applied.control_points) {
    if (const auto before = label_of_.find(point); before != label_of_.end()) {
      changed.insert(before->second);
      const auto count = control_points_.find(before->second);
      if (--count->second == 0) control_points_.erase(count);
      label_of_.erase(before);
    }
    if (const auto now = annotation.control_point(point)) {
      changed.insert(now->label);
      ++control_points_[now->label];
      label_of_[point] = now->label;
    }
  }
  if (!applied.points.empty()) {
    collect_different(points_, annotation.counts(), changed);
    points_ = annotation.counts();
  }
  return changed;
}

std::set<std::uint32_t> LabelCensus::known(const Annotation& annotation) const {
  std::set<std::uint32_t> labels;
  for (const auto& [number, info] : annotation.label_table().defined()) labels.insert(number);
  for (const auto& [number, count] : points_) labels.insert(number);
  for (const auto& [number, count] : control_points_) labels.insert(number);
  return labels;
}

std::size_t LabelCensus::points(std::uint32_t label) const { return count_in(points_, label); }
std::size_t LabelCensus::control_points(std::uint32_t label) const { return count_in(control_points_, label); }

std::string color_text(const std::array<std::uint8_t, 3>& color) {
  constexpr const char* kDigits{"0123456789abcdef"};
  std::string text{"#"};
  for (const std::uint8_t value : color) {
    text += kDigits[value >> 4U];
    text += kDigits[value & 15U];
  }
  return text;
}

nlohmann::json well_apart_colors() {
  constexpr std::uint32_t kWellApart{256};
  const DistinctColors color_of;
  nlohmann::json colors = nlohmann::json::array();
  for (std::uint32_t label = 1; label <= kWellApart; ++label) colors.push_back(color_text(color_of(label)));
  return colors;
}

nlohmann::json label_rows(const std::set<std::uint32_t>& labels, const Annotation& annotation,
                          const LabelCensus& census) {
  nlohmann::json rows = nlohmann::json::array();
  for (const std::uint32_t label : labels) {
    const LabelInfo info = annotation.label_table().info(label);
    rows.push_back({{"number", label},
                    {"name", info.name},
                    {"class", info.class_name},
                    {"instance", info.instance},
                    {"color", color_text(info.color)},
                    {"defined", annotation.label_table().defined().contains(label)},
                    {"locked", annotation.is_locked(label)},
                    {"points", census.points(label)},
                    {"control_points", census.control_points(label)}});
  }
  return rows;
}

}  // namespace saccade::server
