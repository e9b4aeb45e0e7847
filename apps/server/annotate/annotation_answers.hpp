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

/// Points that a page has.
struct ShownPoints {
  std::size_t first{0};  ///< number of points, the first of the order
  bool tiled{false};     ///< the points of `held` in place of these
  HeldTiles held{};

  /// Lists them. Those of tiles are put into `room`.
  [[nodiscard]] std::span<const std::uint32_t> points(const OpenCloud& cloud, std::vector<std::uint32_t>& room) const;
};

/// Returns those of the given points that are shown.
[[nodiscard]] LabelGroups groups_of(std::span<const std::uint32_t> points, const OpenCloud& cloud,
                                    const ShownPoints& shown);
/// Returns the labelled ones of all points shown.
[[nodiscard]] LabelGroups labelled_groups(const OpenCloud& cloud, const ShownPoints& shown);

/// Adds sequence, client_actions, can_undo, can_redo.
void add_state(nlohmann::json& head, const OpenCloud& cloud, std::uint64_t client);
/// Adds read_only, labels and control_points (their number).
void add_annotation(nlohmann::json& head, const OpenCloud& cloud);

/// Answers `open` and `new`; adds to `head`.
[[nodiscard]] SharedMessage opened_message(nlohmann::json head, const OpenCloud& cloud, std::size_t index,
                                           const ShownPoints& shown, std::uint64_t client);
/// Answers `octree`.
[[nodiscard]] SharedMessage octree_message(nlohmann::json head, const Tiles& tiles);
/// Answers `points` and `tiles`; adds to `head`.
[[nodiscard]] SharedMessage points_message(nlohmann::json head, const OpenCloud& cloud,
                                           std::span<const std::uint32_t> chosen);
/// Name of the field of normals, three numbers per point.
inline constexpr std::string_view kNormalField{"normal"};
/// Answers `field`. Expects a name of scalar_field_names, or kNormalField where there are normals. Errors of
/// CloudFields::numbers.
[[nodiscard]] Result<SharedMessage> field_message(nlohmann::json head, const OpenCloud& cloud, std::string_view name,
                                                  std::span<const std::uint32_t> chosen);
/// Answers `segments`. Expects a cloud that has some.
[[nodiscard]] SharedMessage segments_message(nlohmann::json head, const OpenCloud& cloud,
                                             std::span<const std::uint32_t> chosen);
/// Answers `changes` and `ready`.
[[nodiscard]] SharedMessage changes_message(nlohmann::json head, std::span<const ControlPointRow> control_points,
                                            const LabelGroups& groups);

}  // namespace saccade::server
