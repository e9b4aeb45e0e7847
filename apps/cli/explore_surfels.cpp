// SPDX-License-Identifier: Apache-2.0
#include "explore_surfels.hpp"

#include <CLI/CLI.hpp>
#include <array>

#include "add_value.hpp"
#include "saccade/io/clouds/surfel_cloud.hpp"
#include "saccade/surfel/surfel_points.hpp"

namespace saccade::cli {
namespace {

/// Options that say nothing about surfels, and what to do instead.
struct Refused {
  const char* option;
  const char* why;
};
constexpr std::array kRefused{
    Refused{"--strategy",
            "with --map surfels views are chosen by the surface expected beyond the surfels; leave it out"},
    Refused{"--voxel-size", "with --map surfels surface has no voxels; --free-voxel sets those of free space"},
    Refused{"--truncation", "with --map surfels surface has no voxels; leave it out"},
    Refused{"--saliency", "with --map surfels nothing is segmented; leave it out, or explore a volume"},
    Refused{"--dry-run", "moves nothing and sees no surfel; leave --map surfels out"},
};

}  // namespace

void add_surfel_options(CLI::App& command, ExploreOptions& options) {
  command.get_option("--map")
      ->type_name("FILE|surfels")
      ->description(
          "start from a saved map (.sacmap) instead of an unknown one; or the word surfels: make a map of "
          "surfels, and a coarse volume of what is free (docs/guides/exploration.md)");
  add_value(command, "--free-voxel", options.run.free_voxel_m, "METRES",
            "with --map surfels: edge of the voxels of free space, in which the arm plans and unknown surfels lie");
}

void check_surfel_options(const CLI::App& command, ExploreOptions& options) {
  if (options.map != kSurfelsWord) {
    if (command.count("--free-voxel") > 0) usage_error("--free-voxel", "is for --map surfels");
    return;
  }
  for (const Refused& refused : kRefused) {
    if (command.count(refused.option) > 0) usage_error(refused.option, refused.why);
  }
  constexpr double kFinest_m{1e-4};
  constexpr double kCoarsest_m{1.0};
  if (!(options.run.free_voxel_m >= kFinest_m && options.run.free_voxel_m <= kCoarsest_m)) {
    usage_error("--free-voxel", "must be from 0.0001 to 1 m");
  }
  if (options.tracking.value_or(TrackingMode::forced) != TrackingMode::forced)
    usage_error("--tracking", "with --map surfels frames are not tracked, they lie where the robot says; leave it out");
  options.map.clear();
  options.run.map_kind = MapKind::surfels;
  auto model = SurfelModel::create();
  require_ok(model.ok() ? Status{} : Status{model.error()}, "--map");
  options.surfels = std::make_shared<SurfelModel>(std::move(*model));
}

Result<std::vector<SurfelDisc>> unknown_surfels_of(const ExploreOptions& options, const TsdfSnapshot& map,
                                                   const Executor& executor) {
  if (!options.surfels) return std::vector<SurfelDisc>{};
  return unknown_surfels(map, options.surfels->surfels(), UnknownSurfelConfig{}, executor);
}

nlohmann::json map_to_json(const ExploreOptions& options, const TsdfSnapshot& map, std::size_t unknown_surfels) {
  const std::size_t voxels_bytes = map.grid.usage().bytes;
  nlohmann::json json{{"kind", to_string(options.run.map_kind)},
                      {"voxel_size_m", map.config.voxel_size_m},
                      {"voxels_bytes", voxels_bytes},
                      {"memory_bytes", voxels_bytes}};
  if (!options.surfels) return json;
  const std::size_t surfels_bytes = options.surfels->memory_bytes();
  json["memory_bytes"] = voxels_bytes + surfels_bytes;
  json["surfels_bytes"] = surfels_bytes;
  json["surfels"] = options.surfels->surfels().size();
  json["unknown_surfels"] = unknown_surfels;
  json["min_confidence"] = UnknownSurfelConfig{}.min_weight;
  return json;
}

Status write_surfels(const RunFolder& out, const ExploreOptions& options, std::span<const SurfelDisc> unknown) {
  if (!options.surfels) return {};
  const double least = UnknownSurfelConfig{}.min_weight;
  const SurfelMap& seen = options.surfels->surfels();
  if (!shown_surfels(seen, least).empty()) SACCADE_CHECK(write_surfel_cloud(out / "surfels.ply", seen, {}, least));
  if (unknown.empty()) return {};
  SurfelMap frontier;
  frontier.resize(unknown.size());
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    frontier.discs[i] = unknown[i];
    frontier.colors[i] = {Eigen::Vector3f::Zero(), 0.0F};
  }
  return write_surfel_cloud(out / "unknown.ply", frontier);
}

}  // namespace saccade::cli
