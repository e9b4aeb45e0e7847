// SPDX-License-Identifier: Apache-2.0
#pragma once
// The output of `saccade update`: JSON, summary, pictures and page.

#include <nlohmann/json.hpp>

#include "run_folder.hpp"
#include "update_run.hpp"

namespace saccade::cli {

/// `result` of the JSON: the figures, held against the truth. Once it is cancelled, coverage is measured no more.
[[nodiscard]] Result<nlohmann::json> update_json(const UpdateOptions& options, const UpdateCase& subject,
                                                 const WatchedTask& task, const UpdateFigures& figures,
                                                 const ExploreDevices& devices, const Executor& executor,
                                                 const Progress& progress);
/// One region as far as the robot itself knows of it: without coverage.
[[nodiscard]] nlohmann::json region_json(const WatchedTask& task, const UpdateFigures& figures, std::size_t region);
/// Whether and how the robot came back to its stand-by.
[[nodiscard]] nlohmann::json return_json(const StandByResult& back);
/// Returns the summary for people.
/// @param result  update_json's
[[nodiscard]] std::string update_text(const UpdateOptions& options, const WatchedTask& task,
                                      const nlohmann::json& result);

}  // namespace saccade::cli
