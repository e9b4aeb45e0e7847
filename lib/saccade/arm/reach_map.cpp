// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/reach_map.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace saccade {
namespace {

/// Poses tested together: enough for all threads, few enough to stop soon.
constexpr std::size_t kPosesAtOnce{8192};
constexpr std::size_t kNumericPosesAtOnce{256};

Error bad_map(const std::string& what) { return {Errc::invalid_argument, what, "reach map"}; }

std::size_t squares_along(double length_m, double step_m) {
  return static_cast<std::size_t>(std::floor(length_m / step_m + 1e-9));
}

std::vector<ReachPoint> grid_of(const ReachMapConfig& config, std::size_t columns, std::size_t rows) {
  const Eigen::Vector3d middle = 0.5 * (config.workspace.min + config.workspace.max);
  const auto at = [&](double center, std::size_t i, std::size_t count) {
    return center + config.step_m * (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1));
  };
  std::vector<ReachPoint> points;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      points.push_back({{at(middle.x(), column, columns), at(middle.y(), row, rows), config.height_m}, {}});
    }
  }
  return points;
}

/// Position of a pose within a sphere's results: the index order of view_sphere.
struct SphereOrder {
  std::size_t rolls;
  std::size_t longitudes;
  std::size_t directions;

  explicit SphereOrder(const std::vector<ViewCandidate>& sphere, std::size_t radii) {
    const ViewCandidate& first = sphere.front();
    const auto same_roll = [&](const ViewCandidate& c) { return c.longitude_rad == first.longitude_rad; };
    const auto same_latitude = [&](const ViewCandidate& c) {
      return c.latitude_rad == first.latitude_rad && c.radius_m == first.radius_m;
    };
    const auto run = [&](const auto& same) {
      return static_cast<std::size_t>(std::find_if_not(sphere.begin(), sphere.end(), same) - sphere.begin());
    };
    const std::size_t on_circle = run(same_latitude);
    rolls = std::min(run(same_roll), on_circle);
    longitudes = on_circle / rolls;
    directions = sphere.size() / radii / rolls;
  }
  [[nodiscard]] std::size_t direction(std::size_t i) const { return i / rolls % directions; }
  [[nodiscard]] std::size_t radius(std::size_t i) const { return i / rolls / directions; }
};

}  // namespace

void ReachCounts::add(const std::optional<Refusal>& refusal) {
  if (!refusal) {
    ++reachable;
  } else if (*refusal == Refusal::no_ik) {
    ++no_ik;
  } else if (*refusal == Refusal::outside_limits) {
    ++outside_limits;
  } else {
    ++goal_in_collision;
  }
}

ReachCounts& ReachCounts::operator+=(const ReachCounts& other) {
  reachable += other.reachable;
  no_ik += other.no_ik;
  outside_limits += other.outside_limits;
  goal_in_collision += other.goal_in_collision;
  return *this;
}

double ReachCounts::share() const {
  const std::size_t all = poses();
  return all == 0 ? 0.0 : static_cast<double>(reachable) / static_cast<double>(all);
}

Status ReachMapConfig::validate() const {
  if (!saccade::validate(Region{workspace})) return bad_map("the workspace is empty");
  if (!std::isfinite(height_m)) return bad_map("the height is not a number");
  if (!(step_m > 0.0) || !std::isfinite(step_m)) return bad_map("the step must be positive");
  const Eigen::Vector3d size = workspace.max - workspace.min;
  if (step_m > std::min(size.x(), size.y()) * (1.0 + 1e-9)) {
    return bad_map("the step is larger than the workspace; choose a smaller one");
  }
  SACCADE_TRY(const std::vector<ViewCandidate> views, view_sphere(Eigen::Vector3d::Zero(), sphere));
  const double squares = std::floor(size.x() / step_m) * std::floor(size.y() / step_m);
  if (squares * static_cast<double>(views.size()) > static_cast<double>(kMostPoses)) {
    return bad_map("more than " + std::to_string(kMostPoses / 1'000'000) +
                   " million poses to test; choose a larger step or fewer radii");
  }
  return {};
}

ReachCounts ReachMap::total() const {
  ReachCounts all;
  for (const ReachPoint& point : points) all += point.counts;
  return all;
}

std::vector<ReachDirection> ReachMap::by_latitude() const {
  std::vector<ReachDirection> bands;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (i % longitudes == 0) bands.push_back({directions[i].latitude_rad, 0.0, {}});
    bands.back().counts += directions[i].counts;
  }
  return bands;
}

std::size_t ReachMap::best() const {
  SACCADE_EXPECTS(points_done > 0);
  const auto last = points.begin() + static_cast<std::ptrdiff_t>(points_done);
  const auto less = [](const ReachPoint& a, const ReachPoint& b) { return a.counts.reachable < b.counts.reachable; };
  return static_cast<std::size_t>(std::max_element(points.begin(), last, less) - points.begin());
}

std::size_t ReachMap::worst() const {
  SACCADE_EXPECTS(points_done > 0);
  const auto last = points.begin() + static_cast<std::ptrdiff_t>(points_done);
  const auto less = [](const ReachPoint& a, const ReachPoint& b) { return a.counts.reachable < b.counts.reachable; };
  return static_cast<std::size_t>(std::min_element(points.begin(), last, less) - points.begin());
}

Result<ReachMap> reach_map(const Reachability& reachability, const Configuration& reference,
                           const ObstacleMap& obstacles, const ReachMapConfig& config, const Executor& executor,
                           const Progress& progress) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(const std::vector<ViewCandidate> sphere, view_sphere(Eigen::Vector3d::Zero(), config.sphere));
  const SphereOrder order{sphere, config.sphere.radii_m.size()};
  const Eigen::Vector3d size = config.workspace.max - config.workspace.min;
  ReachMap map;
  map.columns = squares_along(size.x(), config.step_m);
  map.rows = squares_along(size.y(), config.step_m);
  map.points = grid_of(config, map.columns, map.rows);
  map.poses_per_point = sphere.size();
  map.longitudes = order.longitudes;
  map.by_radius.resize(config.sphere.radii_m.size());
  for (std::size_t i = 0; i < order.directions; ++i) {
    const ViewCandidate& view = sphere[i * order.rolls];
    map.directions.push_back({view.latitude_rad, view.longitude_rad, {}});
  }

  const std::size_t total = map.points.size() * sphere.size();
  const bool numeric = reachability.ik().method() == IkMethod::numeric;
  const std::size_t at_once = numeric ? kNumericPosesAtOnce : kPosesAtOnce;
  std::vector<Pose> poses;
  for (std::size_t first = 0; first < total && !progress.cancelled(); first += at_once) {
    progress.report("testing poses", first, total);
    const std::size_t end = std::min(total, first + at_once);
    poses.clear();
    for (std::size_t i = first; i < end; ++i) {
      Pose T_world_camera = sphere[i % sphere.size()].T_world_camera;
      T_world_camera.translation() += map.points[i / sphere.size()].p_world;
      poses.push_back(T_world_camera);
    }
    const std::vector<std::optional<Refusal>> refusals = reachability.test(poses, reference, obstacles, executor);
    for (std::size_t i = first; i < end; ++i) {
      const std::optional<Refusal>& refusal = refusals[i - first];
      const std::size_t view = i % sphere.size();
      map.points[i / sphere.size()].counts.add(refusal);
      map.directions[order.direction(view)].counts.add(refusal);
      map.by_radius[order.radius(view)].add(refusal);
    }
    map.points_done = end / sphere.size();
  }
  if (!progress.cancelled()) progress.report("testing poses", total, total);
  return map;
}

}  // namespace saccade
