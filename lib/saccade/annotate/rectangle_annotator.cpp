// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/simulated_annotator.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "saccade/annotate/internal/splat_depth.hpp"
#include "saccade/core/pose.hpp"

namespace saccade {

namespace {

constexpr double kWidest{1.7320508075688772};  ///< half the image width at 1 m: 120°

Error bad_annotator(const char* what) { return {Errc::invalid_argument, what, "rectangle annotator"}; }

/// Returns a view of all points in front of the camera, at most 120° wide.
Eigen::Matrix4d view_of(std::span<const Eigen::Vector3f> positions_m, const Pose& T_world_camera, double aspect) {
  const Pose T_camera_world = T_world_camera.inverse();
  double half{1e-3};  // half the image height at 1 m
  double farthest_m{1e-3};
  for (const Eigen::Vector3f& p_world : positions_m) {
    const Eigen::Vector3d p = T_camera_world * p_world.cast<double>();
    if (!p.allFinite() || p.z() <= 0.0) continue;
    farthest_m = std::max(farthest_m, p.z());
    half = std::max(half, std::max(std::abs(p.x()) / aspect, std::abs(p.y())) / p.z());
  }
  half = 1.001 * std::min(half, kWidest / aspect);
  const double near_m = 1e-4 * farthest_m;
  const double far_m = 2.0 * farthest_m;
  Eigen::Matrix4d clip_camera = Eigen::Matrix4d::Zero();
  clip_camera(0, 0) = 1.0 / (half * aspect);
  clip_camera(1, 1) = -1.0 / half;
  clip_camera(2, 2) = (far_m + near_m) / (far_m - near_m);
  clip_camera(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
  clip_camera(3, 2) = 1.0;
  return clip_camera * T_camera_world.matrix();
}

/// Returns the sensor's pose, and those around the centroid.
std::vector<Pose> viewpoints(std::span<const Eigen::Vector3f> positions_m, double orbit_rad) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count{0.0};
  for (const Eigen::Vector3f& p : positions_m) {
    if (!p.allFinite()) continue;
    sum += p.cast<double>();
    count += 1.0;
  }
  const Eigen::Vector3d centroid = sum / count;
  double radius_m{0.0};
  for (const Eigen::Vector3f& p : positions_m) {
    if (p.allFinite()) radius_m = std::max(radius_m, (p.cast<double>() - centroid).norm());
  }
  const double distance_m = std::max({centroid.norm(), 1.5 * radius_m, 1e-3});
  const Eigen::Vector3d from =
      centroid.norm() > 0.0 ? Eigen::Vector3d{-centroid.normalized()} : Eigen::Vector3d{-Eigen::Vector3d::UnitZ()};
  std::vector<Pose> poses{Pose::Identity()};
  const auto add = [&](double angle_rad, const Eigen::Vector3d& axis) {
    const Eigen::Vector3d turned = Eigen::AngleAxisd{angle_rad, axis} * from;
    poses.push_back(look_at(centroid + distance_m * turned, centroid, -Eigen::Vector3d::UnitY()));
  };
  for (const double orbits : {-2.0, -1.0, 1.0, 2.0}) add(orbits * orbit_rad, Eigen::Vector3d::UnitY());
  add(-orbit_rad, Eigen::Vector3d::UnitX());
  return poses;
}

/// Rectangle of cells and the sum over it.
struct BestRectangle {
  std::int64_t sum{0};
  int left{0}, top{0}, right{0}, bottom{0};
};

/// Returns the rectangle with the largest sum, at a tie the first by top, bottom, right; empty where no sum is
/// positive. Kadane's algorithm for every pair of rows. O(columns · rows²) in the part around positive cells, where the
/// best one ends.
BestRectangle best_rectangle(std::span<const std::int32_t> cells, int columns, int rows) {
  const auto cell = [&](int column, int row) { return cells[static_cast<std::size_t>(row * columns + column)]; };
  PixelWindow part{columns, rows, 0, 0};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (cell(column, row) <= 0) continue;
      part = {std::min(part.left, column), std::min(part.top, row), std::max(part.right, column + 1), row + 1};
    }
  }
  BestRectangle best;
  std::vector<std::int64_t> sums;  // per column, over rows top to bottom
  for (int top = part.top; top < part.bottom; ++top) {
    sums.assign(static_cast<std::size_t>(columns), 0);
    for (int row = top; row < part.bottom; ++row) {
      std::int64_t running{0};
      int left = part.left;
      for (int column = part.left; column < part.right; ++column) {
        std::int64_t& sum = sums[static_cast<std::size_t>(column)];
        sum += cell(column, row);
        if (running <= 0) {
          running = 0;
          left = column;
        }
        running += sum;
        if (running > best.sum) best = {running, left, top, column + 1, row + 1};
      }
    }
  }
  return best;
}

}  // namespace

Status RectangleAnnotatorConfig::validate() const {
  const auto is_in = [](int value, int most) { return value >= 1 && value <= most; };
  if (!is_in(columns, 1024) || !is_in(rows, 1024) || !is_in(cell_px, 8)) {
    return bad_annotator("columns and rows must be 1 to 1024, cell_px 1 to 8");
  }
  if (!is_in(point_size_px, 64)) return bad_annotator("point_size_px must be 1 to 64");
  if (!(orbit_rad > 0.0 && orbit_rad <= 90_deg)) {
    return bad_annotator("orbit_rad must be positive, and at most π/2");
  }
  return {};
}

Result<RectangleAnnotator> RectangleAnnotator::create(std::span<const Eigen::Vector3f> positions_m,
                                                      std::span<const std::uint32_t> truth,
                                                      const RectangleAnnotatorConfig& config,
                                                      const Executor& executor) {
  SACCADE_CHECK(config.validate());
  if (positions_m.size() != truth.size()) {
    return Error{Errc::size_mismatch, "as many points as true labels are needed", "rectangle annotator"};
  }
  RectangleAnnotator made;
  made.config_ = config;
  made.labels_.assign(truth.size(), 0);
  made.truth_.assign(truth.size(), 0);
  std::vector<std::uint32_t>& names = made.names_;
  const auto counts = [&](std::size_t i) { return truth[i] != 0 && positions_m[i].allFinite(); };
  names.push_back(0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (counts(i) && truth[i] != names.back()) names.push_back(truth[i]);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!counts(i)) continue;
    made.truth_[i] = static_cast<std::uint32_t>(std::lower_bound(names.begin(), names.end(), truth[i]) - names.begin());
    made.wrong_ += 1;
  }
  if (made.wrong_ == 0) return bad_annotator("no point has a true label");

  const std::vector<Pose> poses = viewpoints(positions_m, config.orbit_rad);
  const int width = config.columns * config.cell_px;
  const int height = config.rows * config.cell_px;
  made.pictures_.resize(poses.size());
  executor.parallel_for(poses.size(), 1, [&](std::size_t index, std::size_t) {
    Picture& picture = made.pictures_[index];
    picture.view = {view_of(positions_m, poses[index], static_cast<double>(width) / height), width, height,
                    config.point_size_px};
    const ScreenProjection project{picture.view};
    std::vector<ScreenPosition> positions;
    SplatDepth surface{{0, 0, width, height}, config.point_size_px, 0, Executor{}};
    for (const Eigen::Vector3f& p : positions_m) {
      positions.push_back(project(p));
      if (positions.back().in_view()) surface.add(0, {&positions.back(), 1});
    }
    surface.finish(Executor{});
    picture.cells.assign(positions.size(), kNowhere);
    picture.seen.assign(positions.size(), 0);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!positions[i].in_view()) continue;
      const int u = static_cast<int>(positions[i].u_px);
      const int v = static_cast<int>(positions[i].v_px);
      picture.cells[i] = static_cast<std::uint32_t>(v / config.cell_px * config.columns + u / config.cell_px);
      picture.seen[i] = positions[i].depth_m <= surface.depth_m(u, v) ? 1 : 0;
    }
  });
  return made;
}

RectangleAction RectangleAnnotator::best_in(std::size_t view, bool surface) const {
  const Picture& picture = pictures_[view];
  const std::size_t cells = static_cast<std::size_t>(config_.columns) * static_cast<std::size_t>(config_.rows);
  std::vector<std::size_t> wrong_of(names_.size(), 0);
  std::vector<std::int32_t> all_right(cells, 0);  // points that painting any label would break
  // Per label: the points that it does not break after all, and those that it corrects.
  std::vector<std::vector<std::int32_t>> gains(names_.size());
  for (std::size_t i = 0; i < truth_.size(); ++i) {
    if (truth_[i] == 0 || picture.cells[i] == kNowhere || (surface && picture.seen[i] == 0)) continue;
    std::vector<std::int32_t>& gain = gains[truth_[i]];
    if (gain.empty()) gain.assign(cells, 0);
    gain[picture.cells[i]] += 1;
    all_right[picture.cells[i]] += is_right(i) ? 1 : 0;
    wrong_of[truth_[i]] += is_right(i) ? 0 : 1;
  }
  std::vector<std::uint32_t> order(names_.size());
  for (std::uint32_t label = 0; label < order.size(); ++label) order[label] = label;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return wrong_of[a] > wrong_of[b]; });

  BestRectangle best;
  std::uint32_t best_label{0};
  for (const std::uint32_t label : order) {
    if (wrong_of[label] == 0 || static_cast<std::int64_t>(wrong_of[label]) < best.sum) break;
    std::vector<std::int32_t>& gain = gains[label];
    for (std::size_t i = 0; i < cells; ++i) gain[i] -= all_right[i];
    const BestRectangle found = best_rectangle(gain, config_.columns, config_.rows);
    if (found.sum < best.sum || (found.sum == best.sum && label > best_label)) continue;
    best = found;
    best_label = label;
  }
  RectangleAction action{view, surface, names_[best_label], best.left, best.top, best.right, best.bottom};
  action.corrected = static_cast<std::size_t>(best.sum);  // minus the broken points, until it is performed
  return action;
}

std::optional<RectangleAction> RectangleAnnotator::next(const Executor& executor) {
  std::vector<RectangleAction> actions(2 * pictures_.size());
  executor.parallel_for(actions.size(), 1,
                        [&](std::size_t i, std::size_t) { actions[i] = best_in(i / 2, i % 2 == 0); });
  // The first at a tie.
  RectangleAction best = *std::max_element(actions.begin(), actions.end(),
                                           [](const auto& a, const auto& b) { return a.corrected < b.corrected; });
  if (best.corrected == 0) return std::nullopt;
  carry_out(best);
  return best;
}

/// Returns the action with the numbers of points that it corrects and breaks.
RectangleAction RectangleAnnotator::around(const ErrorRegion& region, std::size_t view, bool surface) const {
  const Picture& picture = pictures_[view];
  RectangleAction action{view, surface, region.truth, config_.columns, config_.rows, 0, 0};
  for (const std::uint32_t point : region.points) {
    if (picture.cells[point] == kNowhere || (surface && picture.seen[point] == 0)) continue;
    const int column = static_cast<int>(picture.cells[point]) % config_.columns;
    const int row = static_cast<int>(picture.cells[point]) / config_.columns;
    action.left = std::min(action.left, column);
    action.top = std::min(action.top, row);
    action.right = std::max(action.right, column + 1);
    action.bottom = std::max(action.bottom, row + 1);
  }
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    if (truth_[i] == 0 || !is_selected(i, action)) continue;
    const bool gets_right = names_[truth_[i]] == action.label;
    action.corrected += !is_right(i) && gets_right ? 1 : 0;
    action.broken += is_right(i) && !gets_right ? 1 : 0;
  }
  return action;
}

std::optional<RectangleAction> RectangleAnnotator::next_around(const ErrorRegion& region, const Executor& executor) {
  const auto gain = [](const RectangleAction& action) {
    return static_cast<std::int64_t>(action.corrected) - static_cast<std::int64_t>(action.broken);
  };
  std::vector<RectangleAction> actions(2 * pictures_.size());
  executor.parallel_for(actions.size(), 1,
                        [&](std::size_t i, std::size_t) { actions[i] = around(region, i / 2, i % 2 == 0); });
  RectangleAction best = *std::max_element(actions.begin(), actions.end(),
                                           [&](const auto& a, const auto& b) { return gain(a) < gain(b); });
  if (gain(best) <= 0) return next(executor);
  carry_out(best);
  return best;
}

bool RectangleAnnotator::is_selected(std::size_t point, const RectangleAction& action) const {
  const Picture& picture = pictures_[action.view];
  if (picture.cells[point] == kNowhere || (action.surface && picture.seen[point] == 0)) return false;
  const int cell = static_cast<int>(picture.cells[point]);
  return PixelWindow{action.left, action.top, action.right, action.bottom}.contains(cell % config_.columns,
                                                                                    cell / config_.columns);
}

void RectangleAnnotator::carry_out(RectangleAction& action) {
  action.corrected = 0;
  action.broken = 0;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    if (!is_selected(i, action)) continue;
    const bool was_right = is_right(i);
    labels_[i] = action.label;
    if (truth_[i] == 0) continue;
    action.corrected += !was_right && is_right(i) ? 1 : 0;
    action.broken += was_right && !is_right(i) ? 1 : 0;
  }
  wrong_ = wrong_ + action.broken - action.corrected;
}

}  // namespace saccade
