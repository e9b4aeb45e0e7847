// SPDX-License-Identifier: Apache-2.0
// Table 3.2: saliency and view poses of the segments before the third view of experiment 1.
#include <algorithm>
#include <map>

#include "experiments/experiments.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "tables.hpp"
#include "text.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

std::string name_of_object(const GroundTruth& truth, const RayScene& rays, std::span<const Eigen::Vector3f> points,
                           const std::vector<MeshDistance>& distances) {
  constexpr double kBeyond_m{0.1};
  constexpr std::size_t kSamples{200};
  std::map<std::string, std::size_t> votes;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / kSamples)) {
    const Eigen::Vector3d p = points[i].cast<double>();
    std::size_t nearest = 0;
    for (std::size_t object = 1; object < distances.size(); ++object) {
      if (distances[object].distance_m(p, kBeyond_m) < distances[nearest].distance_m(p, kBeyond_m)) nearest = object;
    }
    const bool of_object = truth.to_objects_m(p, kBeyond_m) < truth.to_supports_m(p, kBeyond_m);
    const ObjectMesh& mesh = rays.meshes()[nearest];
    ++votes[of_object && !mesh.support ? mesh.name : "part of the table"];
  }
  return std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

}  // namespace

Result<ReproducedTable> table_3_2(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  constexpr std::size_t kThird{2};
  progress.report("experiment 1", 0, 1);
  SACCADE_TRY(Scene scene, find_scene(kTabletops[0]));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
  SACCADE_TRY(const GroundTruth truth, GroundTruth::build(rays, kTruthSpacing_m, executor));
  SACCADE_TRY(const Exploration* found,
              exploration(options, executor, progress, experiments.explorations.attention, 0));
  const RunRecord& experiment = found->run;
  if (experiment.views.size() <= kThird || !experiment.views[kThird].choice->surface) {
    return Error{Errc::unavailable, "the exploration ended before its third view", kTabletops[0]};
  }
  std::vector<MeshDistance> distances;
  for (const ObjectMesh& object : rays.meshes()) {
    SACCADE_TRY(MeshDistance distance, MeshDistance::build(object.mesh));
    distances.push_back(std::move(distance));
  }
  const ViewRecord& third = experiment.views[kThird];
  const ViewChoice& choice = *third.choice;
  const SalientSurface& seen = *choice.surface;
  const std::size_t per_point = ContourViewConfig{}.views_per_point();
  const auto contours_of = choice.contours->points_of_segments(seen.points.segments());
  ReproducedTable table;
  table.caption =
      "Table 3.2: saliency and view poses of the segments before the third view of experiment 1, up to the first one "
      "that is no object's";
  table.columns = {"saliency", "no. of poses", "description"};
  json rows = json::array();
  std::size_t of_objects = 0;
  for (const std::uint32_t segment : seen.order) {
    if (contours_of[segment].empty()) continue;
    const std::string name = name_of_object(truth, rays, seen.points.points_of(segment), distances);
    const std::size_t poses = per_point * contours_of[segment].size();
    const double saliency = seen.saliency[segment].value;
    table.rows.push_back({fixed(saliency, 3), std::to_string(poses), name});
    rows.push_back({{"saliency", saliency}, {"poses", poses}, {"object", name}});
    if (name == "part of the table") break;
    of_objects += poses;
  }
  const std::size_t chosen = choice.segment ? per_point * contours_of[*choice.segment].size() : 0;
  table.notes = {
      "Thesis: 0.589 (960 poses, top of a jug) down to 0.177 for nine segments of objects, then 0.172 (7720 "
      "poses) for a part of the table; 10,480 poses point at objects, 91,960 in all, 960 were evaluated.",
      "Here: " + std::to_string(of_objects) + " poses of the segments before the first that is no object's, " +
          std::to_string(third.candidates) + " in all; the segment that was chosen has " + std::to_string(chosen) +
          ", of which the arm can take " + std::to_string(choice.candidates.size()) +
          ". Segments without contour points are left out.",
      "A segment is of the object that most of its points are nearest to."};
  add_exploration_notes(options, table);
  table.figures = {{"rows", std::move(rows)},
                   {"candidates", third.candidates},
                   {"of_objects", of_objects},
                   {"of_chosen", chosen},
                   {"evaluated", third.evaluated}};
  return table;
}

}  // namespace saccade::reproduce
