// SPDX-License-Identifier: Apache-2.0
#pragma once
// The figures and pages of `saccade update CELL`: one page for each task, in a folder of its own, and one that leads to
// them.

#include <nlohmann/json.hpp>

#include "run_folder.hpp"
#include "update_run.hpp"

namespace saccade::cli {

/// "task-3", the folder of the third task.
[[nodiscard]] std::string task_folder(std::size_t number);
/// Removes the folders of the tasks of an earlier run. io_failure.
[[nodiscard]] Status remove_task_folders(const RunFolder& out);

/// Returns the entry of a task in update.json.
/// @param end  why the robot looks no more, as in the record of a run, or "hand_came"
[[nodiscard]] nlohmann::json task_record(const UpdateOptions& options, const WatchedTask& task,
                                         const UpdateFigures& figures, const Box& workspace, std::string_view end);

/// corrupt_data for what is no record that task_record wrote.
[[nodiscard]] Status check_task_record(const nlohmann::json& record);
/// Returns a line for each task, from their records.
[[nodiscard]] std::string tasks_text(const nlohmann::json& records);

/// A task's report.html, from its pictures and its record, the last one in the document. io_failure.
[[nodiscard]] Status write_task_page(const UpdateOptions& options, const WatchedTask& task, const RunFolder& folder,
                                     const ExploreDevices& devices, const nlohmann::json& document,
                                     const nlohmann::json& record);

/// report.html from the document that goes to update.json, and map.png. io_failure.
[[nodiscard]] Status write_cell_page(const UpdateOptions& options, const TsdfSnapshot& map, const Box& workspace,
                                     ExploreDevices& devices, const RunFolder& out, const nlohmann::json& document,
                                     const Executor& executor);

}  // namespace saccade::cli
