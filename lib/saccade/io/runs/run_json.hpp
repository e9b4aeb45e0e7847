// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records of runs as JSON and back: the content of run.json, update.json and the journal of an interrupted run, the
// alternatives of a view, and the names of a view's files.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/explore/run_record.hpp"
#include "saccade/explore/view_record.hpp"
#include "saccade/robot/refusal.hpp"

namespace saccade {

/// Returns {"no_ik": 3, …}: counts by reason, without zeros.
[[nodiscard]] nlohmann::json refusals_to_json(const RefusalCounts& refused);
/// Reads counts back; unknown reasons are ignored. Answers corrupt_data for anything else.
[[nodiscard]] Result<RefusalCounts> refusals_from_json(const nlohmann::json& value);

/// Returns "view-03.json", "view-03.sacmap"; 1 for the first view.
[[nodiscard]] std::string view_file(std::size_t view, const std::string& suffix);

/// Writes the choice and the path of a view (docs/reference/formats.md, "The folder of an exploration"); atomic.
/// Expects a record with a choice. io_failure.
[[nodiscard]] Status write_view_choice(const std::filesystem::path& folder, std::size_t view, const ViewRecord& record);
/// Reads the choice and the path back; the rest of the record keeps its defaults. not_found without a file; unsupported
/// for another version; corrupt_data.
[[nodiscard]] Result<ViewRecord> read_view_choice(const std::filesystem::path& folder, std::size_t view);

/// Returns [q1, q2, …]; null without an arm.
[[nodiscard]] nlohmann::json configuration_to_json(const std::optional<Configuration>& q);
/// Reads a configuration back. Answers corrupt_data for anything else, and for too many joints.
[[nodiscard]] Result<std::optional<Configuration>> configuration_from_json(const nlohmann::json& value);

/// Returns an entry of `views`. Missing measures are null.
/// @param index  0 for the first view.
[[nodiscard]] nlohmann::json view_to_json(const ViewRecord& view, std::size_t index);
/// Reads a view back; values missing in older versions keep their defaults. The path and the choice are not included.
/// corrupt_data.
[[nodiscard]] Result<ViewRecord> view_from_json(const nlohmann::json& value);
[[nodiscard]] nlohmann::json views_to_json(const std::vector<ViewRecord>& views);
/// Reads views back. Answers corrupt_data.
[[nodiscard]] Result<std::vector<ViewRecord>> views_from_json(const nlohmann::json& values);

/// Returns `initial` of a run: {coverage, unknown_left, views, refused}.
[[nodiscard]] nlohmann::json scan_to_json(const ScanRecord& scan);
/// Reads a scan back; the number of frames is not included. Answers corrupt_data.
[[nodiscard]] Result<ScanRecord> scan_from_json(const nlohmann::json& value);
/// Returns `final` of a run.
[[nodiscard]] nlohmann::json measures_to_json(const Measures& measures);
/// Returns the milliseconds of each phase.
[[nodiscard]] nlohmann::json times_to_json(const PhaseTimes& times);
/// Returns the seconds of all views per phase, and of the robot's motion: `phases_s`. Thesis Tables 2.8 and 3.1.
[[nodiscard]] nlohmann::json phases_to_json(const std::vector<ViewRecord>& views);

}  // namespace saccade
