// SPDX-License-Identifier: Apache-2.0
#pragma once
// Beginning of a session: its journal, seeds and presets; and keeping an earlier session.

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "saccade/annotate/label_seeds.hpp"
#include "saccade/io/sessions/annotation_session.hpp"

namespace saccade::server {

/// Returns a complaint where a session's graph differs from the requested one; nullopt: it is equal.
using GraphCheck = std::function<std::optional<std::string>(const NeighbourhoodConfig& saved)>;

/// Locks the journal of a cloud, or begins one with this graph; an existing one keeps its graph.
/// @return errors of AnnotationJournal::open_or_create; invalid_argument where a check complains.
[[nodiscard]] Result<AnnotationJournal::Opened> open_journal(const std::filesystem::path& path, SessionSubject subject,
                                                             std::span<const GraphCheck> checks);

/// Returns how many seeds a session holds whose planting was interrupted; nullopt: it holds something else, or all of
/// them.
[[nodiscard]] std::optional<std::size_t> planted_before(const LabelSeeds& seeds, std::uint64_t client,
                                                        std::span<const AnnotationAction> actions);

/// Returns the presets whose definitions are missing or different in the annotation.
[[nodiscard]] std::vector<NumberedLabel> missing_presets(std::span<const NumberedLabel> presets,
                                                         const Annotation& annotation);

/// Renames a file to a free name, NAME.1, NAME.2 …, which it returns. Never overwrites a file. Answers io_failure.
[[nodiscard]] Result<std::filesystem::path> keep_aside(const std::filesystem::path& file);

}  // namespace saccade::server
