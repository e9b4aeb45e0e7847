// SPDX-License-Identifier: Apache-2.0
#include "json_output.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "saccade/core/version.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"

namespace saccade::cli {

nlohmann::json json_envelope(const std::string& command, const GlobalOptions& global, const Executor& executor,
                             const TimingsMs& timings_ms, nlohmann::json result) {
  return {{"schema", kJsonSchema},
          {"version", version()},
          {"command", command},
          {"backend", executor.backend_name()},
          {"threads", executor.threads()},
          {"seed", global.seed},
          {"timings_ms", timings_ms},
          {"result", std::move(result)}};
}

std::size_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024U;
}

Status check_json_output(const GlobalOptions& global) {
  if (global.json.empty() || global.json_to_stdout()) return {};
  SACCADE_TRY(const AtomicFile probe, AtomicFile::create(global.json));
  std::error_code ignored;
  if (const auto size = std::filesystem::file_size(global.json, ignored); ignored || size == 0) return {};
  const Result<nlohmann::json> existing = read_json(global.json);
  if (!existing || !existing->is_object() || existing->value("schema", nlohmann::json{}) != kJsonSchema) {
    return Error{Errc::invalid_argument, "holds something other than a result; name another file", global.json};
  }
  return {};
}

Status write_json_output(const GlobalOptions& global, const nlohmann::json& document) {
  if (global.json.empty()) return {};
  if (!global.json_to_stdout()) return write_json(global.json, document);
  std::cout << document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n' << std::flush;
  if (!std::cout) return Error{Errc::io_failure, "cannot write the result", "standard output"};
  return {};
}

Status write_result(const std::string& command, const GlobalOptions& global, const Executor& executor,
                    const TimingsMs& timings_ms, nlohmann::json result) {
  return write_json_output(global, json_envelope(command, global, executor, timings_ms, std::move(result)));
}

nlohmann::json point_json(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace saccade::cli
