// SPDX-License-Identifier: Apache-2.0
#pragma once
// describe_file: what is in a file or folder that the program reads.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade::cli {

struct Description {
  nlohmann::json result = nlohmann::json::object();          ///< "kind", and what is found under a key of that kind
  std::vector<std::pair<std::string, std::string>> lines{};  ///< for people

  void line(std::string name, std::string value) { lines.emplace_back(std::move(name), std::move(value)); }
};

/// Describes a map, cloud, mesh, RGB-D folder, bag, annotation session, campaign, run, URDF, scene, cell, trajectory of
/// a hand or NumPy array. not_found where nothing is there; unsupported for anything else, with what is read; errors of
/// the readers.
[[nodiscard]] Result<Description> describe_file(const std::filesystem::path& path, const Executor& executor);

// Kinds of files (info_geometry.cpp, info_recordings.cpp).
[[nodiscard]] Description describe_map(const std::filesystem::path& path, const TsdfSnapshot& map);
[[nodiscard]] Result<Description> describe_cloud(const std::filesystem::path& path, const Executor& executor);
[[nodiscard]] Result<Description> describe_mesh(const std::filesystem::path& path);
[[nodiscard]] Result<Description> describe_urdf(const std::filesystem::path& path);
[[nodiscard]] Result<Description> describe_scene(const std::filesystem::path& path);
[[nodiscard]] Result<Description> describe_array(const std::filesystem::path& path);
[[nodiscard]] Result<Description> describe_bag(const std::filesystem::path& path);
[[nodiscard]] Result<Description> describe_frames(const std::filesystem::path& folder);
[[nodiscard]] Result<Description> describe_session(const std::filesystem::path& path);
[[nodiscard]] Result<Description> describe_campaign(const std::filesystem::path& path);
[[nodiscard]] Result<Description> describe_hand(const std::filesystem::path& path);
/// A result of the program, such as run.json.
[[nodiscard]] Result<Description> describe_result(const std::filesystem::path& path);

}  // namespace saccade::cli
