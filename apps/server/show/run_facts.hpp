// SPDX-License-Identifier: Apache-2.0
#pragma once
// Facts of a run from its JSON, and of its scan and views from their records; images of a view in the folder.

#include <filesystem>

#include "saccade/explore/run_record.hpp"
#include "server/show/scene_document.hpp"

namespace saccade::server {

/// Returns the facts in the JSON; missing and malformed values are omitted.
/// @param result  as in run.json, of any command.
[[nodiscard]] Facts facts_of_run(const nlohmann::json& result);
[[nodiscard]] Facts facts_of_scan(const ScanRecord& scan);
[[nodiscard]] Facts facts_of_view(const ViewRecord& view);

/// Returns the existing images of a view, the camera's first; 0: of the scan.
[[nodiscard]] std::vector<StepPicture> pictures_of_view(const std::filesystem::path& folder, std::size_t view);
/// Returns all PNG files of a folder, by name.
[[nodiscard]] std::vector<StepPicture> pictures_in(const std::filesystem::path& folder);

}  // namespace saccade::server
