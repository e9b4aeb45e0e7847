// SPDX-License-Identifier: Apache-2.0
#pragma once
// Answers of the annotation service about an open cloud. docs/reference/protocol.md.

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "server/annotate/open_cloud.hpp"
#include "server/message.hpp"

namespace saccade::server {

/// Reads a number of the head within limits.
[[nodiscard]] Result<std::uint64_t> whole_number(const nlohmann::json& head, const char* key, std::uint64_t least,
                                                 std::uint64_t most);

/// Control point as in messages; label 0: removed.
struct ControlPointRow {
  std::uint32_t point{0};
  std::uint32_t label{kNoLabel};
  float start_cost{0.0F};
  std::array<float, 3> position_m{};  ///< included because a page may not have the point
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

/// Returns those of the given points that are shown.
[[nodiscard]] LabelGroups groups_of(std::span<const std::uint32_t> points, const OpenCloud& cloud, std::size_t shown);
/// Returns the labelled ones of all points shown.
[[nodiscard]] LabelGroups labelled_groups(const OpenCloud& cloud, std::size_t shown);

/// Adds sequence, client_actions, can_undo, can_redo.
void add_state(nlohmann::json& head, const OpenCloud& cloud, std::uint64_t client);
/// Adds read_only, labels and control_points (their number).
void add_annotation(nlohmann::json& head, const OpenCloud& cloud);

/// Answers `open` and `new`; adds to `head`.
[[nodiscard]] SharedMessage opened_message(nlohmann::json head, const OpenCloud& cloud, std::size_t index,
                                           std::size_t shown, std::uint64_t client);
/// Answers `points`.
[[nodiscard]] SharedMessage points_message(nlohmann::json head, const OpenCloud& cloud, std::size_t from,
                                           std::size_t count);
/// Name of the field of normals, three numbers per point.
inline constexpr std::string_view kNormalField{"normal"};
/// Answers `field`. Expects a name of scalar_field_names, or kNormalField where there are normals.
[[nodiscard]] SharedMessage field_message(nlohmann::json head, const OpenCloud& cloud, std::string_view name,
                                          std::size_t from, std::size_t count);
/// Answers `changes` and `ready`.
[[nodiscard]] SharedMessage changes_message(nlohmann::json head, std::span<const ControlPointRow> control_points,
                                            const LabelGroups& groups);

}  // namespace saccade::server
