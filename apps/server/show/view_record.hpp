// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewRecord: what a view of an exploration was chosen from, as it lies beside run.json; names of a view's files.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::server {

/// docs/formats.md, "The folder of an exploration". World frame.
struct ViewRecord {
  std::size_t view{1};                   ///< 1 for the first
  Region region{};                       ///< that the gain is of
  PinholeCamera sensor{};                ///< virtual, whose rays gains count
  std::vector<Pose> T_world_candidates;  ///< what the view was chosen from
  std::vector<double> gains;             ///< one per candidate; NaN: not evaluated
  std::vector<double> saliency;          ///< of each segment of the map before the view; none: no segments were made
  std::optional<std::uint32_t> segment;  ///< that the view is of
  std::vector<Eigen::Vector3d> path;     ///< the camera's centre on its way to the view
};

/// "view-03.json", "view-03.sacmap"
[[nodiscard]] std::string view_file(std::size_t view, const std::string& suffix);

/// Atomic. io_failure.
[[nodiscard]] Status write_view_record(const std::filesystem::path& folder, const ViewRecord& record);
/// not_found without one; unsupported for another version; corrupt_data.
[[nodiscard]] Result<ViewRecord> read_view_record(const std::filesystem::path& folder, std::size_t view);

}  // namespace saccade::server
