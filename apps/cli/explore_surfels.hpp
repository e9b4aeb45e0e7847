// SPDX-License-Identifier: Apache-2.0
#pragma once
// Explorations whose model is surfels: saccade explore --map surfels.

#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "explore_options.hpp"
#include "run_folder.hpp"

namespace saccade::cli {

/// The word that --map takes instead of a file.
inline constexpr std::string_view kSurfelsWord{"surfels"};

/// Adds --free-voxel, and what --map takes besides a file.
void add_surfel_options(CLI::App& command, ExploreOptions& options);
/// After parsing, before all other checks: takes `--map surfels` in, and throws a usage error for options that say
/// nothing about surfels.
void check_surfel_options(const CLI::App& command, ExploreOptions& options);

/// Unknown surfels of a run as it stands; none where the model is no surfels. Errors: those of unknown_surfels.
[[nodiscard]] Result<std::vector<SurfelDisc>> unknown_surfels_of(const ExploreOptions& options, const TsdfSnapshot& map,
                                                                 const Executor& executor);
/// Kind and memory of the map that a run has made.
[[nodiscard]] nlohmann::json map_to_json(const ExploreOptions& options, const TsdfSnapshot& map,
                                         std::size_t unknown_surfels);
/// Writes surfels.ply and unknown.ply, or nothing where there is no surfel. io_failure.
[[nodiscard]] Status write_surfels(const RunFolder& out, const ExploreOptions& options,
                                   std::span<const SurfelDisc> unknown);

}  // namespace saccade::cli
