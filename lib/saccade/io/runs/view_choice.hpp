// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a view was chosen from, as it lies beside run.json; names of a view's files.

#include <filesystem>
#include <string>

#include "saccade/explore/view_record.hpp"

namespace saccade {

/// "view-03.json", "view-03.sacmap"; 1 for the first view.
[[nodiscard]] std::string view_file(std::size_t view, const std::string& suffix);

/// Writes the choice and the path of a view (docs/formats.md, "The folder of an exploration"); atomic. Expects a record
/// with a choice. io_failure.
[[nodiscard]] Status write_view_choice(const std::filesystem::path& folder, std::size_t view, const ViewRecord& record);
/// Reads the choice and the path back; the rest of the record keeps its defaults. not_found without a file; unsupported
/// for another version; corrupt_data.
[[nodiscard]] Result<ViewRecord> read_view_choice(const std::filesystem::path& folder, std::size_t view);

}  // namespace saccade
