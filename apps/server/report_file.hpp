// SPDX-License-Identifier: Apache-2.0
#pragma once
// The page of reports (web/src/report) with a record in it, as one file beside the pictures of a run.
// docs/guides/report.md.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade::server {

/// Returns the names of the files in a folder, in "pictures" and in the folders of a cell's tasks in it, relative to it
/// and sorted; hidden files and pages left out. Empty for a path that is not a folder.
[[nodiscard]] std::vector<std::string> report_files(const std::filesystem::path& folder);

/// Returns {schema, record, files, details}, which the page reads.
/// @param record   what a command writes with --json
/// @param folder   holds the pictures
/// @param details  what the page shows beyond the record, such as the curves of a comparison
[[nodiscard]] nlohmann::json report_document(nlohmann::json record, const std::filesystem::path& folder,
                                             nlohmann::json details = nullptr);

/// Returns the page with a document in it: UTF-8, nothing in it from elsewhere. No text of the document can end the
/// element that holds it.
[[nodiscard]] std::string report_html(const nlohmann::json& document);

/// Writes the page, with links to the pictures in its folder. Atomic. io_failure.
[[nodiscard]] Status write_report(const std::filesystem::path& file, nlohmann::json record,
                                  nlohmann::json details = nullptr);

}  // namespace saccade::server
