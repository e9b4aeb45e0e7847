// SPDX-License-Identifier: Apache-2.0
#include "fuse_paging.hpp"

#include "saccade/io/maps/spill_file.hpp"
#include "summary.hpp"

namespace saccade::cli {

using nlohmann::json;

Status page_map(TsdfMap& map, const FuseOptions& options, const std::filesystem::path& out) {
  if (!options.is_paged()) return {};
  PagingConfig config;
  config.memory_bytes = options.map_memory_bytes;
  config.moving_volume_m = options.moving_volume_m;
  SACCADE_TRY(config.store, SpillFile::create(options.page_folder.empty() ? out : options.page_folder));
  return map.keep_within(config);
}

json paging_json(const std::optional<PagingStats>& stats, const FuseOptions& options) {
  if (!stats) return nullptr;
  return {{"memory_bytes", options.map_memory_bytes ? json(*options.map_memory_bytes) : json()},
          {"moving_volume_m", options.moving_volume_m ? json(*options.moving_volume_m) : json()},
          {"sectors_out", stats->sectors_out},
          {"sectors_in", stats->sectors_in},
          {"bytes_written", stats->bytes_written},
          {"bytes_read", stats->bytes_read},
          {"shifts", stats->shifts},
          {"peak_map_bytes", stats->peak_map_bytes}};
}

std::string paging_text(const PagingStats& stats) {
  const std::string shifts = stats.shifts > 0 ? ", " + std::to_string(stats.shifts) + " shifts" : "";
  return std::to_string(stats.sectors_out) + " sectors out (" + mebibytes(stats.bytes_written) + " written), " +
         std::to_string(stats.sectors_in) + " in again, at most " + mebibytes(stats.peak_map_bytes) + " in memory" +
         shifts;
}

Result<TriangleMesh> mesh_of(const TsdfSnapshot& map, const Executor& executor) {
  if (map.grid.all_in_memory()) return extract_mesh(map, executor);
  return extract_mesh_by_parts(map, executor);
}

Result<PictureMap> map_for_picture(const TsdfSnapshot& map, const Viewpoint& view, const Executor& executor) {
  if (map.grid.all_in_memory()) return PictureMap{map, std::nullopt};
  const PinholeCamera& camera = view.camera;
  Box seen{view.T_world_camera.translation(), view.T_world_camera.translation()};
  for (const double u : {-0.5, camera.width - 0.5}) {
    for (const double v : {-0.5, camera.height - 0.5}) {
      const Eigen::Vector3d corner = view.T_world_camera * Eigen::Vector3d{camera.ray(u, v) * camera.max_range_m};
      seen.min = seen.min.cwiseMin(corner);
      seen.max = seen.max.cwiseMax(corner);
    }
  }
  const double sector_m = kSectorVoxelEdge * map.config.voxel_size_m;
  const IndexBox sectors{voxel_at(seen.min, sector_m), voxel_at(seen.max, sector_m) + Index3{1, 1, 1}};
  SACCADE_TRY(TsdfGrid grid, with_in_memory(map.grid, map.grid.away_in(sectors.grown(1)), executor));
  return PictureMap{{map.config, std::move(grid)}, seen};
}

}  // namespace saccade::cli
