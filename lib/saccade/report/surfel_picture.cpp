// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/surfel_picture.hpp"

#include <vector>

#include "saccade/report/internal/surfel_canvas.hpp"

namespace saccade {

void draw_surfels_into(Canvas& canvas, const SurfelDiscs& discs, std::span<const Rgb8> colors,
                       const Executor& executor) {
  SACCADE_EXPECTS(colors.size() == discs.positions_m.size());
  const SurfelView seen = view_surfels(discs, canvas.sample_camera(), canvas.view().T_world_camera, executor);
  for (std::size_t i = 0; i < seen.seen.size(); ++i) {
    const SurfelId id = seen.seen.pixels()[i];
    if (id == kNoSurfel) continue;
    canvas.samples().data()[i] = colors[id];
    canvas.sample_depth().data()[i] = seen.depth.pixels()[i];
  }
}

ColorImage draw_surfels(const SurfelDiscs& discs, std::span<const Rgb8> colors, const Viewpoint& view,
                        const Executor& executor, const SurfelPictureConfig& config) {
  Canvas canvas{view, config.background, config.samples};
  draw_surfels_into(canvas, discs, colors, executor);
  return canvas.finish();
}

ColorImage draw_surfels(const SurfelPoints& points, const Viewpoint& view, const Executor& executor,
                        const SurfelPictureConfig& config) {
  std::vector<Rgb8> colors;
  for (const Eigen::Vector3f& color : points.colors) colors.push_back(byte_color(color));
  return draw_surfels({points.positions_m, points.normals, points.radii_m}, colors, view, executor, config);
}

}  // namespace saccade
