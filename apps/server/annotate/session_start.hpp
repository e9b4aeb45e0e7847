// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a session begins with: its journal, seeds, presets; and how an earlier one is kept.

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/annotate/label_seeds.hpp"
#include "saccade/io/sessions/annotation_session.hpp"

namespace saccade::server {

/// What is to be said where a session's graph is another one than was asked for; none: it is the same.
using GraphCheck = std::function<std::optional<std::string>(const NeighbourhoodConfig& saved)>;

/// Locks the journal of a cloud, or begins one with this graph; of one that is there the graph is what it is.
/// @return errors of AnnotationJournal::open_or_create; invalid_argument where a check says something.
[[nodiscard]] Result<AnnotationJournal::Opened> open_journal(const std::filesystem::path& path, SessionSubject subject,
                                                             std::span<const GraphCheck> checks);

/// How many of the seeds a session holds whose planting was cut short; none: it holds something else, or all of them.
[[nodiscard]] std::optional<std::size_t> planted_before(const LabelSeeds& seeds, std::uint64_t client,
                                                        std::span<const AnnotationAction> actions);

/// Those of which something else is known than in the presets, or nothing.
[[nodiscard]] std::vector<NumberedLabel> missing_presets(std::span<const NumberedLabel> presets,
                                                         const Annotation& annotation);

/// Gives a file a free name, NAME.1, NAME.2 …, which it returns. No file is lost by it. io_failure.
[[nodiscard]] Result<std::filesystem::path> keep_aside(const std::filesystem::path& file);

}  // namespace saccade::server
