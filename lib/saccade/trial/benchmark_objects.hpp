// SPDX-License-Identifier: Apache-2.0
#pragma once
// BenchmarkObject: the objects of a protocol, from its meshes, from other meshes, or as stand-ins.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "saccade/trial/benchmark.hpp"

namespace saccade {

struct BenchmarkObject {
  std::string name;                  ///< name of the file without its ending (own_object_names), or of the stand-in
  std::vector<TriangleMesh> bodies;  ///< z up; in metres where they keep their size
};

/// Returns the stand-ins of a protocol.
[[nodiscard]] Result<std::vector<BenchmarkObject>> stand_ins_of(const Benchmark& benchmark);

/// Reads the meshes of a protocol that are in the folder, in the protocol's order. Errors: plan_benchmark.
[[nodiscard]] Result<std::vector<BenchmarkObject>> read_objects(const Benchmark& benchmark,
                                                                const std::filesystem::path& folder);

/// Names objects after their files, without folder and ending. Where names clash, the nearest folders that tell these
/// files apart come before: "mug-nontextured", "bowl-nontextured". Answers invalid_argument where none do.
[[nodiscard]] Result<std::vector<std::string>> own_object_names(std::span<const std::filesystem::path> files);

/// Reads meshes that are not the protocol's, called by own_object_names. Each closed part is a body of its own
/// (bodies_of). Errors: plan_benchmark.
[[nodiscard]] Result<std::vector<BenchmarkObject>> read_own_objects(const Benchmark& benchmark,
                                                                    std::span<const std::filesystem::path> files,
                                                                    const MeshSceneConfig& config);

}  // namespace saccade
