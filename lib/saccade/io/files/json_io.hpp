// SPDX-License-Identifier: Apache-2.0
#pragma once
// JSON in files: parsing with errors as values, atomic writing, poses as 4×4 row-major nested arrays.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "saccade/core/pose.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

/// Returns the message of an exception without its leading tag, which means nothing to a reader.
[[nodiscard]] std::string message_of(const nlohmann::json::exception& exception);

/// Parses JSON. Answers corrupt_data with the byte offset.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text);
[[nodiscard]] Result<nlohmann::json> read_json(const std::filesystem::path& path);
/// Writes JSON indented by two spaces, with a final newline; atomic.
[[nodiscard]] Status write_json(const std::filesystem::path& path, const nlohmann::json& value);

/// Returns [[r r r x], [r r r y], [r r r z], [0 0 0 1]].
[[nodiscard]] nlohmann::json pose_to_json(const Pose& T_a_b);
/// Reads a pose back. Answers corrupt_data unless it is a 4×4 nested array of numbers; invalid_argument unless it is a
/// rigid motion.
[[nodiscard]] Result<Pose> pose_from_json(const nlohmann::json& value);

}  // namespace saccade
