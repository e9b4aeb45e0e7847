// SPDX-License-Identifier: Apache-2.0
#include "robot_reach_output.hpp"

#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "json_output.hpp"
#include "saccade/arm/arm_mesh.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/io/files/csv.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/robot_drawing.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

json counts_json(const ReachCounts& counts) {
  return {{"poses", counts.poses()},
          {"reachable", counts.reachable},
          {"no_ik", counts.no_ik},
          {"outside_limits", counts.outside_limits},
          {"goal_in_collision", counts.goal_in_collision},
          {"share", counts.share()}};
}

json place_json(const ReachPoint& point) {
  json entry = counts_json(point.counts);
  entry["p_world"] = point_json(point.p_world);
  return entry;
}

std::string metres(const Eigen::Vector3d& p) {
  return '(' + fixed(p.x(), 3) + ", " + fixed(p.y(), 3) + ", " + fixed(p.z(), 3) + ") m";
}

std::string part_of(std::size_t part, std::size_t all) {
  return percent(all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all));
}

int whole_degrees(double angle_rad) { return static_cast<int>(std::lround(to_deg(angle_rad))); }

std::string radii_text(const std::vector<double>& radii_m) {
  return joined(radii_m, ", ", [](double radius_m) { return fixed(radius_m, 2); }) + " m";
}

std::string names_of(const std::vector<FixtureBox>& fixtures) {
  return fixtures.empty() ? "no fixtures" : joined(fixtures, ", ", &FixtureBox::name);
}

/// A row of the tables by latitude and radius.
void write_row(std::ostream& text, const std::string& name, const ReachCounts& counts) {
  text << std::right << std::setw(8) << name;
  const std::size_t all = counts.poses();
  for (const std::size_t part : {counts.reachable, counts.no_ik, counts.outside_limits, counts.goal_in_collision}) {
    text << std::setw(16) << part_of(part, all);
  }
  text << '\n';
}

void write_head(std::ostream& text, const char* name) {
  text << '\n' << std::right << std::setw(8) << name;
  for (const char* column : {"reachable", "out of reach", "outside limits", "in collision"}) {
    text << std::setw(16) << column;
  }
  text << '\n';
}

/// From above, with every joint in the middle of its limits: the points of each link's bodies.
std::vector<std::vector<Eigen::Vector2d>> arm_from_above(const ArmModel& arm) {
  const ArmPoses poses = forward_kinematics(arm, arm.middle());
  std::vector<std::vector<Eigen::Vector2d>> parts;
  for (std::size_t i = 0; i < arm.links().size(); ++i) {
    for (const CollisionBody& body : arm.links()[i].bodies) {
      std::vector<Eigen::Vector2d>& part = parts.emplace_back();
      for (const Eigen::Vector3f& p : body_surface(body).vertices) {
        part.emplace_back((poses.T_world_link[i] * p.cast<double>()).head<2>());
      }
    }
  }
  return parts;
}

ReachScene scene_of(const ReachTask& task, const ReachMap& map) {
  ReachScene scene;
  scene.title = "Reach of " + task.robot.arm.name() + ", points at z = " + fixed(task.config.height_m, 2) + " m";
  scene.workspace = task.config.workspace;
  scene.square_m = task.config.step_m;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const ReachPoint& point = map.points[i];
    const bool done = i < map.points_done;
    scene.squares.push_back(
        {point.p_world.head<2>(), done ? std::optional{point.counts.share()} : std::optional<double>{}});
  }
  const ReachPoint& best = map.points[map.best()];
  if (best.counts.reachable > 0) scene.best = best.p_world.head<2>();
  for (const ReachDirection& direction : map.directions) {
    scene.directions.push_back({direction.latitude_rad, direction.longitude_rad, direction.counts.share()});
  }
  for (const FixtureBox& fixture : task.fixtures) scene.fixtures.push_back(fixture.box);
  scene.arm = arm_from_above(task.robot.arm);
  const ReachCounts total = map.total();
  scene.note = percent(total.share()) + " of " + std::to_string(total.poses()) + " view poses at " +
               radii_text(task.config.sphere.radii_m) + " can be taken; " + part_of(total.no_ik, total.poses()) +
               " no inverse kinematics, " + part_of(total.outside_limits, total.poses()) + " outside the limits, " +
               part_of(total.goal_in_collision, total.poses()) + " in collision";
  return scene;
}

Status write_table(const std::filesystem::path& path, const ReachMap& map) {
  CsvTable table{{"x", "y", "z", "poses", "reachable", "no_ik", "outside_limits", "goal_in_collision"}};
  for (std::size_t i = 0; i < map.points_done; ++i) {
    const auto& [p, counts] = map.points[i];
    table.add(p.x()).add(p.y()).add(p.z());
    for (const std::size_t count :
         {counts.poses(), counts.reachable, counts.no_ik, counts.outside_limits, counts.goal_in_collision}) {
      table.add(std::uint64_t{count});
    }
    table.end_row();
  }
  return table.write(path);
}

}  // namespace

json reach_json(const ReachTask& task, const ReachMap& map) {
  json fixtures = json::array();
  for (const auto& [name, box, support] : task.fixtures) {
    fixtures.push_back({{"name", name}, {"min_m", point_json(box.min)}, {"max_m", point_json(box.max)}});
  }
  json latitudes = json::array();
  for (const ReachDirection& band : map.by_latitude()) {
    json entry = counts_json(band.counts);
    entry["latitude_rad"] = band.latitude_rad;
    latitudes.push_back(std::move(entry));
  }
  json directions = json::array();
  for (const ReachDirection& direction : map.directions) {
    directions.push_back({{"latitude_rad", direction.latitude_rad},
                          {"longitude_rad", direction.longitude_rad},
                          {"poses", direction.counts.poses()},
                          {"reachable", direction.counts.reachable}});
  }
  json radii = json::array();
  for (std::size_t i = 0; i < map.by_radius.size(); ++i) {
    json entry = counts_json(map.by_radius[i]);
    entry["radius_m"] = task.config.sphere.radii_m[i];
    radii.push_back(std::move(entry));
  }
  const Box& workspace = task.config.workspace;
  return {{"robot", task.robot.arm.name()},
          {"T_world_base", pose_to_json(task.robot.arm.T_world_base())},
          {"inverse_kinematics", to_string(task.ik.method())},
          {"scene", task.scene},
          {"fixtures", std::move(fixtures)},
          {"workspace", {{"min_m", point_json(workspace.min)}, {"max_m", point_json(workspace.max)}}},
          {"height_m", task.config.height_m},
          {"step_m", task.config.step_m},
          {"columns", map.columns},
          {"rows", map.rows},
          {"points", map.points.size()},
          {"points_done", map.points_done},
          {"poses_per_point", map.poses_per_point},
          {"total", counts_json(map.total())},
          {"best", place_json(map.points[map.best()])},
          {"worst", place_json(map.points[map.worst()])},
          {"by_latitude", std::move(latitudes)},
          {"by_radius", std::move(radii)},
          {"by_direction", std::move(directions)}};
}

std::string reach_text(const ReachTask& task, const ReachMap& map, double test_ms) {
  std::ostringstream text;
  const Summary summary{text};
  const ReachCounts total = map.total();
  const InverseKinematics& ik = task.ik;
  summary.line("robot", task.robot.arm.name() + ", inverse kinematics: " + std::string{to_string(ik.method())});
  summary.line("scene", task.scene + ": " + names_of(task.fixtures));
  summary.line("points", std::to_string(map.points_done) + " at z = " + fixed(task.config.height_m, 3) +
                             " m, one every " + fixed(task.config.step_m, 3) + " m");
  summary.line("poses", std::to_string(map.poses_per_point) + " around each, from " +
                            radii_text(task.config.sphere.radii_m) + " away; " + std::to_string(total.poses()) +
                            " in all");
  summary.line("reachable", percent(total.share()) + " (" + std::to_string(total.reachable) + ")");
  const ReachPoint& best = map.points[map.best()];
  const ReachPoint& worst = map.points[map.worst()];
  summary.line("best point", metres(best.p_world) + ": " + percent(best.counts.share()));
  summary.line("worst point", metres(worst.p_world) + ": " + percent(worst.counts.share()));
  summary.line("speed", fixed(static_cast<double>(total.poses()) / test_ms, 1) + " thousand poses/s, " +
                            fixed(test_ms / 1000.0, 1) + " s");
  if (ik.method() == IkMethod::numeric) {
    summary.line("note", ik.why_numeric());
    summary.line("note",
                 "a few starts per pose, one configuration each: somewhat more may be reachable than said here");
  }
  write_head(text, "latitude");
  for (const ReachDirection& band : map.by_latitude()) {
    write_row(text, std::to_string(whole_degrees(band.latitude_rad)), band.counts);
  }
  write_row(text, "all", total);
  if (map.by_radius.size() < 2) return text.str();
  write_head(text, "radius");
  for (std::size_t i = 0; i < map.by_radius.size(); ++i) {
    write_row(text, fixed(task.config.sphere.radii_m[i], 2), map.by_radius[i]);
  }
  return text.str();
}

Status write_reach(const RunFolder& out, const ReachTask& task, const ReachMap& map, bool pictures) {
  SACCADE_CHECK(out.remove(std::span{kReachFiles}.first(1)));
  SACCADE_CHECK(write_table(out / "reach.csv", map));
  if (!pictures) return {};
  return write_png(out / "reach.png", reach_picture(scene_of(task, map)));
}

}  // namespace saccade::cli
