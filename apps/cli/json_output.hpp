// SPDX-License-Identifier: Apache-2.0
#pragma once
// The machine-readable result: its envelope, and writing it to a file or to standard output.

#include <Eigen/Core>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "saccade/core/executor.hpp"

namespace saccade::cli {

constexpr const char* kJsonSchema{"saccade-result/1"};

using TimingsMs = std::map<std::string, double>;

/// {schema, version, command, backend, threads, seed, timings_ms, result}.
[[nodiscard]] nlohmann::json json_envelope(const std::string& command, const GlobalOptions& global,
                                           const Executor& executor, const TimingsMs& timings_ms,
                                           nlohmann::json result);

/// Fails before the long work where --json names a file that cannot be written, or an existing file that is not JSON.
[[nodiscard]] Status check_json_output(const GlobalOptions& global);
/// Does what --json asks for; nothing without it.
[[nodiscard]] Status write_json_output(const GlobalOptions& global, const nlohmann::json& document);
/// Puts a result into its envelope and does the same with it.
[[nodiscard]] Status write_result(const std::string& command, const GlobalOptions& global, const Executor& executor,
                                  const TimingsMs& timings_ms, nlohmann::json result);

/// The most memory that the program held so far.
[[nodiscard]] std::size_t peak_rss_bytes();

/// Null for none.
template <class T>
[[nodiscard]] nlohmann::json optional_json(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

/// [x, y, z]
[[nodiscard]] nlohmann::json point_json(const Eigen::Vector3d& p);

}  // namespace saccade::cli
