// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the annotation service says of an open cloud. docs/protocol.md.

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "server/annotate/open_cloud.hpp"
#include "server/message.hpp"

namespace saccade::server {

/// A number of the head, from least to most.
[[nodiscard]] Result<std::uint64_t> whole_number(const nlohmann::json& head, const char* key, std::uint64_t least,
                                                 std::uint64_t most);

/// As messages have it; label 0: none any more.
struct ControlPointRow {
  std::uint32_t point{0};
  std::uint32_t label{kNoLabel};
  float start_cost{0.0F};
  std::array<float, 3> position_m{};  ///< a page may not have the point
};
static_assert(sizeof(ControlPointRow) == 24);

[[nodiscard]] std::vector<ControlPointRow> all_control_points(const OpenCloud& cloud);
[[nodiscard]] std::vector<ControlPointRow> control_points_now(std::span<const std::uint32_t> points,
                                                              const OpenCloud& cloud);

/// Shown points by their label.
struct LabelGroups {
  nlohmann::json list = nlohmann::json::array();  ///< [label, count]
  std::vector<std::uint32_t> points;
};

/// Of some points those that are shown.
[[nodiscard]] LabelGroups groups_of(std::span<const std::uint32_t> points, const OpenCloud& cloud, std::size_t shown);
/// Of all points that are shown those with a label.
[[nodiscard]] LabelGroups labelled_groups(const OpenCloud& cloud, std::size_t shown);

/// Adds sequence, client_actions, can_undo, can_redo.
void add_state(nlohmann::json& head, const OpenCloud& cloud, std::uint64_t client);
/// Adds read_only, labels and control_points (their number).
void add_annotation(nlohmann::json& head, const OpenCloud& cloud);

/// Answers `open` and `new`; what is in `head` stays.
[[nodiscard]] SharedMessage opened_message(nlohmann::json head, const OpenCloud& cloud, std::size_t index,
                                           std::size_t shown, std::uint64_t client);
/// Answers `points`.
[[nodiscard]] SharedMessage points_message(nlohmann::json head, const OpenCloud& cloud, std::size_t from,
                                           std::size_t count);
/// `changes` and `ready`.
[[nodiscard]] SharedMessage changes_message(nlohmann::json head, std::span<const ControlPointRow> control_points,
                                            const LabelGroups& groups);

}  // namespace saccade::server
