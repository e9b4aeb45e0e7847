// SPDX-License-Identifier: Apache-2.0
#include "fuse_pictures.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "fuse_paging.hpp"
#include "interrupt.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/report/depth_picture.hpp"
#include "saccade/report/view_picture.hpp"

namespace saccade::cli {
namespace {

/// The frame's camera, opened wider, so that the picture shows what lies beyond its borders.
Viewpoint wider_view(const PinholeCamera& camera, const Pose& T_world_camera) {
  constexpr double kWider{1.35};
  constexpr int kWidth{960};
  const double scale = kWidth / static_cast<double>(camera.width);
  PinholeCamera wide = camera;
  wide.width = kWidth;
  wide.height = std::max(1, static_cast<int>(scale * camera.height));
  wide.fx = camera.fx * scale / kWider;
  wide.fy = camera.fy * scale / kWider;
  wide.cx = 0.5 * (wide.width - 1);
  wide.cy = 0.5 * (wide.height - 1);
  return {wide, T_world_camera};
}

Status write_fusion_picture(const std::filesystem::path& path, const TsdfSnapshot& map, const PinholeCamera& camera,
                            const RgbdFolderSource& source, const RgbdFolderConfig& config, const FusedFrame& fused,
                            const Executor& executor) {
  SACCADE_TRY(const Frame frame, read_frame_again(source, config, fused.index));
  SACCADE_TRY(const SurfaceView view, raycast(map, camera, fused.T_world_camera, executor));
  FusionPictureConfig picture;
  picture.title = "Depth image " + fused.name + " against the map";
  return write_png(path, fusion_picture(frame.depth, view.depth, picture));
}

}  // namespace

Status write_fuse_pictures(const RunFolder& out, const TsdfSnapshot& map, const PinholeCamera& camera,
                           const RgbdFolderSource& source, const RgbdFolderConfig& config, const FuseRecord& record,
                           const Executor& executor, ProgressBar& progress) {
  const std::array<std::pair<const char*, std::size_t>, 3> chosen{{{"fusion-first.png", 0},
                                                                   {"fusion-middle.png", record.fused.size() / 2},
                                                                   {"fusion-last.png", record.fused.size() - 1}}};
  std::size_t done = 0;
  for (const auto& [name, position] : chosen) {
    if (interrupted()) return {};
    progress.update("drawing", done++, chosen.size() + 1);
    SACCADE_CHECK(write_fusion_picture(out / name, map, camera, source, config, record.fused[position], executor));
  }
  progress.update("drawing", done, chosen.size() + 1);
  const FusedFrame& first = record.fused.front();
  const Viewpoint wider = wider_view(camera, first.T_world_camera);
  SACCADE_TRY(const PictureMap seen, map_for_picture(map, wider, executor));
  TernaryPictureConfig ternary_config;
  ternary_config.crop = seen.crop;
  const ColorImage ternary =
      ternary_figure(seen.map, wider, executor, "Occupied, empty and unknown, seen from " + first.name, ternary_config);
  return write_png(out / "ternary.png", ternary);
}

}  // namespace saccade::cli
