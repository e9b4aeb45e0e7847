// SPDX-License-Identifier: Apache-2.0
#pragma once
// run_campaign: does with the runs of a comparison what its options ask for, here or in slices, and reports them.

#include <functional>
#include <string>

#include "compare_output.hpp"
#include "comparison.hpp"
#include "context.hpp"

namespace saccade::cli {

/// The folder of a campaign, as commands declare it.
[[nodiscard]] FolderOption campaign_folder();

/// Opens DIR as Context::open_folder does, and knows a campaign by its slices as well.
[[nodiscard]] Status open_campaign_folder(Context& context);

/// Part of the report that a command adds: writes files of its own into the folder, adds to the result, and
/// returns the text for people.
using ReportPart =
    std::function<Result<std::string>(const Campaign& campaign, const ComparedRuns& compared, nlohmann::json& result)>;

/// Does what one of MachineOptions asks for, and without any runs what the campaign in the folder of --out lacks, until
/// the user interrupts. After runs and after a merge it writes the report of all runs of the comparison that the
/// campaign has: tables, pictures, what `part` adds, and the page. Errors: those of Campaign, run_missing, run_slice,
/// slice_status, merge_shards, submit_slices and `part`; io_failure.
[[nodiscard]] Result<Outcome> run_campaign(Context& context, const Comparison& comparison, const ReportPart& part);

}  // namespace saccade::cli
