// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/segment_picture.hpp"

#include <algorithm>

#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/internal/orientation_marks.hpp"
#include "saccade/report/mesh_picture.hpp"
#include "saccade/report/sheet.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kBackdrop{236, 239, 243};
constexpr Rgb8 kUnsegmented{150, 154, 160};
constexpr Rgb8 kChosenView{214, 28, 92};
constexpr Rgb8 kChosenContour{0, 150, 136};
constexpr Rgb8 kOtherContour{255, 255, 255};

void draw_contours(Canvas& canvas, std::span<const DrawnContour> contours) {
  constexpr double kHidden{0.3};
  constexpr double kNormal_m{0.05};
  for (const DrawnContour& contour : contours) {
    if (!contour.chosen) {
      canvas.point(contour.p_world, 3.0, kOtherContour, 0.0);
      continue;
    }
    canvas.point(contour.p_world, 6.0, kChosenContour, kHidden);
    canvas.line(contour.p_world, contour.p_world + kNormal_m * contour.normal_world, {kChosenContour, 2.0, kHidden});
  }
}

}  // namespace

ColorImage saliency_picture(const SaliencyScene& scene, const Executor& executor, const OverviewConfig& config) {
  SACCADE_EXPECTS(scene.labels.size() == scene.mesh.vertices.size());
  constexpr double kFrustum_m{0.12};
  const double most = scene.saliency.empty() ? 0.0 : *std::max_element(scene.saliency.begin(), scene.saliency.end());
  const ColorBar bar = round_bar(most > 0.0 ? most : 1.0, "saliency");
  TriangleMesh mesh = scene.mesh;
  mesh.colors.clear();
  for (const std::uint32_t label : scene.labels) {
    const bool known = label < scene.saliency.size();
    mesh.colors.push_back(known ? amount_colors()(scene.saliency[label] / bar.high) : kUnsegmented);
  }
  std::vector<Eigen::Vector3d> shown{scene.T_world_chosen.translation()};
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    if (contains(scene.workspace, vertex.cast<double>())) shown.emplace_back(vertex.cast<double>());
  }
  Canvas canvas{overview_of(shown, config), kBackdrop};
  draw_mesh(canvas, mesh, executor);
  draw_contours(canvas, scene.contours);
  canvas.frustum(scene.sensor, scene.T_world_chosen, kFrustum_m, {kChosenView, 2.2, 0.4});
  draw_orientation(canvas, 0.5 * (scene.workspace.min + scene.workspace.max));
  return with_scale(canvas.finish(), amount_colors(), bar, kBackdrop);
}

}  // namespace saccade
