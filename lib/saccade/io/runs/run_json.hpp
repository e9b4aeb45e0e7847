// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records of runs as JSON and back: what run.json, update.json and the journal of an interrupted run hold.

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "saccade/explore/run_record.hpp"

namespace saccade {

/// [q1, q2, …]; null where there is no arm.
[[nodiscard]] nlohmann::json configuration_to_json(const std::optional<Configuration>& q);
/// The inverse. corrupt_data for anything else, and for more joints than an arm may have.
[[nodiscard]] Result<std::optional<Configuration>> configuration_from_json(const nlohmann::json& value);

/// An entry of `views`. Measures that were not taken are null.
/// @param index  0 for the first view.
[[nodiscard]] nlohmann::json view_to_json(const ViewRecord& view, std::size_t index);
/// The inverse; what older versions did not write keeps its default. The path and the choice are not part of it.
/// corrupt_data.
[[nodiscard]] Result<ViewRecord> view_from_json(const nlohmann::json& value);
[[nodiscard]] nlohmann::json views_to_json(const std::vector<ViewRecord>& views);
/// The inverse. corrupt_data.
[[nodiscard]] Result<std::vector<ViewRecord>> views_from_json(const nlohmann::json& values);

/// `initial` of a run: {coverage, unknown_left, views, refused}.
[[nodiscard]] nlohmann::json scan_to_json(const ScanRecord& scan);
/// The inverse; the number of frames is not part of it. corrupt_data.
[[nodiscard]] Result<ScanRecord> scan_from_json(const nlohmann::json& value);
/// `final` of a run.
[[nodiscard]] nlohmann::json measures_to_json(const Measures& measures);
/// Milliseconds of each phase.
[[nodiscard]] nlohmann::json times_to_json(const PhaseTimes& times);
/// Seconds of all views per phase, and of the robot's motion: `phases_s`. Thesis Tables 2.8 and 3.1.
[[nodiscard]] nlohmann::json phases_to_json(const std::vector<ViewRecord>& views);

}  // namespace saccade
