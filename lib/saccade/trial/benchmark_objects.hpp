// SPDX-License-Identifier: Apache-2.0
#pragma once
// BenchmarkObject: the objects of a protocol, from the user's meshes or as stand-ins.

#include "saccade/trial/benchmark.hpp"

namespace saccade {

struct BenchmarkObject {
  std::string name;                  ///< name of the file without its ending, or of the stand-in
  std::vector<TriangleMesh> bodies;  ///< in the unit of the file, z up
};

/// Returns the stand-ins of a protocol.
[[nodiscard]] Result<std::vector<BenchmarkObject>> stand_ins_of(const Benchmark& benchmark);

/// Reads the meshes of a protocol that are in the folder, in the protocol's order. Errors: plan_benchmark.
[[nodiscard]] Result<std::vector<BenchmarkObject>> read_objects(const Benchmark& benchmark,
                                                                const std::filesystem::path& folder);

}  // namespace saccade
