// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_guarded: a reader that may crash, hang or take all memory on hostile files, in a child process with limits.

#include <cstddef>
#include <filesystem>
#include <functional>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

struct ReadLimits {
  double seconds{10.0};                ///< processor time; three times as much by the clock
  std::size_t bytes{256ULL << 20ULL};  ///< memory beyond that of the process
};

/// Returns limits for a file: the defaults, 1 s more per MiB, and 128 times its size more.
[[nodiscard]] ReadLimits limits_for(const std::filesystem::path& path);

/// Calls `read` in a child process and returns its result. Sanitizers need address space, so memory is not limited
/// there.
/// @return corrupt_data with the path where the reader crashed or took too much time or memory; cancelled where a
/// signal ended it; io_failure where no process can be started; errors of `read`. Adds a fork, about 1 ms, and one copy
/// of the mesh.
[[nodiscard]] Result<TriangleMesh> read_guarded(const std::filesystem::path& path, const ReadLimits& limits,
                                                const std::function<Result<TriangleMesh>()>& read);

}  // namespace saccade
