// SPDX-License-Identifier: Apache-2.0
// Table 2.9: one phase of next-best view by NBV-GPU, NBV-CPU and NBV-CPU-step; here by Saccade, PCL's octree, a fixed
// step.
#include <algorithm>
#include <optional>

#include "experiments/experiments.hpp"
#include "peer_comparison.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/views/view_gain.hpp"
#include "tables.hpp"
#include "text.hpp"
#include "thesis/ray_search.hpp"
#include "thesis/update_task.hpp"

namespace saccade::reproduce {
namespace {

using bench::Cost;
using bench::CostClock;
using nlohmann::json;
using thesis::RayComparison;
using thesis::RaySearch;
using thesis::StopVolume;
using thesis::UpdateTask;

constexpr double kStep_m{0.003};
constexpr std::size_t kCheckedPoses{8};
constexpr int kOurRuns{5};
constexpr double kMostOtherVoxels{1e-3};  ///< share of rays; an octree that differs more is no peer

struct Views {
  const UpdateTask& task;
  std::vector<Pose> poses;
  std::vector<Pose> checked;  ///< the poses whose rays are compared one by one
  const Executor& executor;
  const Progress& progress;

  [[nodiscard]] double voxel_size_m() const { return task.map.config.voxel_size_m; }
};

/// Cost of one algorithm, and how its rays agree with the exact ones.
struct Measured {
  Cost total;
  double prepare_s{0.0};  ///< share of its wall_s
  RayComparison agreement;
  std::vector<std::uint64_t> gains;
};

/// The median of several runs; the first one, with cold caches, does not count.
Result<Measured> measure_ours(const Views& views, const RaySearch& exact, const StopVolume& volume) {
  GainConfig config;
  config.sensor = views.task.sensor;
  const auto evaluate = [&](const std::vector<Pose>& poses) {
    return evaluate_views(views.task.map, views.task.region, poses, config, views.executor, views.progress);
  };
  SACCADE_TRY(const GainResult few, evaluate(views.checked));
  SACCADE_TRY(const auto one_by_one, thesis::gains_of(exact, volume, views.checked, config.sensor, views.voxel_size_m(),
                                                      views.executor, views.progress));
  SACCADE_EXPECTS(few.gains == one_by_one);
  Measured measured;
  std::vector<double> prepare_s;
  std::vector<double> wall_s;
  std::vector<double> cpu_s;
  for (int run = 0; run <= kOurRuns; ++run) {
    const CostClock clock;
    SACCADE_TRY(const GainResult result, evaluate(views.poses));
    const Cost cost = clock.elapsed();
    measured.gains = result.gains;
    if (run == 0) continue;
    prepare_s.push_back(1e-3 * result.prepare_ms);
    wall_s.push_back(cost.wall_s);
    cpu_s.push_back(cost.cpu_s);
  }
  measured.total = {median(wall_s), median(cpu_s)};
  measured.prepare_s = median(prepare_s);
  return measured;
}

/// Once; `prepared` is what came before.
Result<Measured> measure_peer(const Views& views, const RaySearch& peer, const RaySearch& exact,
                              const StopVolume& volume, const Cost& prepared) {
  Measured measured;
  measured.prepare_s = prepared.wall_s;
  const PinholeCamera& sensor = views.task.sensor;
  SACCADE_TRY(measured.agreement, thesis::compare_rays(peer, exact, volume, views.checked, sensor, views.voxel_size_m(),
                                                       views.executor, views.progress));
  const CostClock clock;
  SACCADE_TRY(measured.gains, thesis::gains_of(peer, volume, views.poses, sensor, views.voxel_size_m(), views.executor,
                                               views.progress));
  measured.total = prepared + clock.elapsed();
  return measured;
}

/// A row of the table. `here` is nothing where the algorithm is not built in or failed its check.
struct Row {
  std::string name;  ///< in the thesis
  std::string what;  ///< here
  double thesis_s;
  std::optional<Measured> here;
  std::string instead{};  ///< text in place of figures
};

/// Fills the row of PCL's octree, or says there why it has no figures.
Status measure_octree(const Views& views, const RaySearch& exact, const StopVolume& volume, const Cost& filled,
                      Row& row) {
  views.progress.report("building PCL's octree", 0, 0);
  const CostClock clock;
  const auto octree = thesis::octree_search(volume);
  const Cost built = clock.elapsed();
  if (!octree) {
    row.instead = octree.error().message;
    return {};
  }
  SACCADE_TRY(Measured measured, measure_peer(views, **octree, exact, volume, filled + built));
  if (measured.agreement.other_voxel_share() <= kMostOtherVoxels) {
    row.here = std::move(measured);
  } else {
    row.instead = "not shown: " + std::to_string(measured.agreement.other_voxel) + " rays end elsewhere";
  }
  return {};
}

std::vector<std::string> cells_of(const Row& row, const Row& first) {
  std::vector<std::string> cells{row.name, row.what, fixed(row.thesis_s, 1),
                                 fixed(row.thesis_s / first.thesis_s, 1) + "×"};
  if (!row.here) {
    cells.insert(cells.end(), {row.instead, "–", "–", "–", "–"});
    return cells;
  }
  const Measured& here = *row.here;
  const RayComparison& rays = here.agreement;
  const auto seconds = [](double s) { return fixed(s, s < 10.0 ? 3 : 1); };
  cells.push_back(seconds(here.total.wall_s));
  cells.push_back(fixed(here.total.wall_s / first.here->total.wall_s, 1) + "×");
  cells.push_back(seconds(here.total.cpu_s));
  cells.push_back(fixed(here.prepare_s, 3));
  cells.push_back(rays.rays == 0 ? "none"
                                 : std::to_string(rays.other_voxel) + " of " + std::to_string(rays.rays) + " (" +
                                       fixed(100.0 * rays.other_voxel_share(), 4) + " %)");
  return cells;
}

json json_of(const Row& row, const Row& first) {
  json figures{{"algorithm", row.name}, {"here", row.what}, {"thesis_s", row.thesis_s}, {"s", nullptr}};
  if (!row.here) {
    figures["unavailable"] = row.instead;
    return figures;
  }
  const Measured& here = *row.here;
  figures["s"] = here.total.wall_s;
  figures["cpu_s"] = here.total.cpu_s;
  figures["prepare_s"] = here.prepare_s;
  figures["rays_compared"] = here.agreement.rays;
  figures["rays_other_voxel"] = here.agreement.other_voxel;
  figures["rays_other_score"] = here.agreement.other_score;
  figures["gain_difference"] = bench::gain_difference(here.gains, first.here->gains);
  return figures;
}

std::vector<std::string> notes_of(const Views& views, const StopVolume& volume, bool octree, const Row& fixed_step) {
  const UpdateTask& task = views.task;
  const PinholeCamera& sensor = task.sensor;
  const std::string poses = std::to_string(views.poses.size());
  const std::size_t blocked = thesis::blocked_cameras(volume, views.poses, views.voxel_size_m());
  std::vector<std::string> notes;
  if (views.poses.size() < task.view_sphere.size()) {
    notes.push_back("Only " + poses + " of the " + std::to_string(task.view_sphere.size()) +
                    " poses were evaluated: not comparable with the thesis.");
  }
  notes.push_back("Here: " + poses + " poses 0.8 m from a sphere S(POI) of 0.2 m, " + std::to_string(sensor.width) +
                  " × " + std::to_string(sensor.height) + " rays each, voxels of " + millimetres(views.voxel_size_m()) +
                  ", " + std::to_string(views.executor.threads()) +
                  " threads. The map: " + std::to_string(task.frames) + " simulated frames of the scene " + task.scene +
                  "; then S(POI), on top of a box, set back to unknown.");
  if (blocked > 0) {
    notes.push_back(std::to_string(blocked) +
                    " cameras lie in space that no frame showed empty: their rays end at once, for all three.");
  }
  notes.push_back(
      "Other than in the thesis: the machine (there a GeForce GTX 670 for NBV-GPU and a Core i7-4770; here "
      "everything runs on the CPU) and the scene. The thesis does not say its image size and volume; " +
      std::to_string(sensor.width) + " × " + std::to_string(sensor.height) + " and " + std::to_string(volume.size().x) +
      "³ voxels are assumed.");
  notes.push_back(
      "Ours casts only rays that can meet S(POI), and those that several poses share once; the two others "
      "cast every ray, as in the thesis. Times hold the preparation: for them the map as ternary voxels "
      "(eq. 2.11), and the octree of those at the boundary of empty space (all that are not empty would "
      "take GiBs). Ours: median of " +
      std::to_string(kOurRuns) +
      " runs; the others ran once. On a busy machine compare the CPU times, summed over threads.");
  notes.push_back(
      "Checked before the times were taken, on all rays of " + std::to_string(views.checked.size()) +
      " poses: ours gives exactly the gains of rays walked one by one." +
      (octree ? " The octree's few other rays pass an edge of a voxel more closely than it computes." : "") +
      " Steps of " + millimetres(kStep_m) + " pass over corners of voxels: " +
      std::to_string(fixed_step.here->agreement.other_score) + " rays count wrongly for the gain.");
  return notes;
}

}  // namespace

Result<ReproducedTable> table_2_9(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                  const Progress& progress) {
  SACCADE_CHECK(carry_out_update_task(options, executor, progress, experiments.update_task));
  const thesis::UpdateTask& task = *experiments.update_task;
  const std::size_t poses = options.poses == 0 ? task.view_sphere.size() : options.poses;
  const Views views{task, task.some_poses(poses), task.some_poses(std::min(poses, kCheckedPoses)), executor, progress};
  const CostClock clock;
  const StopVolume volume = StopVolume::fill(task.map, task.region, task.volume_bricks, executor);
  const Cost filled = clock.elapsed();
  const auto exact = thesis::exact_search(task.map, volume);
  std::vector<Row> rows{{"NBV-GPU", "ours", 10.6, {}},
                        {"NBV-CPU", "PCL's octree", 211.5, {}},
                        {"NBV-CPU-step", "fixed step of " + millimetres(kStep_m), 619.6, {}}};
  SACCADE_TRY(rows[0].here, measure_ours(views, *exact, volume));

  SACCADE_CHECK(measure_octree(views, *exact, volume, filled, rows[1]));
  SACCADE_TRY(rows[2].here, measure_peer(views, *thesis::fixed_step_search(volume, kStep_m / views.voxel_size_m()),
                                         *exact, volume, filled));

  ReproducedTable table;
  table.caption = "Table 2.9: execution time of one phase of next-best view, in seconds";
  table.columns = {"thesis",      "here",           "thesis, s",
                   "ratio",       "here, s",        "ratio",
                   "here, CPU s", "preparation, s", "rays that end elsewhere"};
  json row_figures = json::array();
  for (const Row& row : rows) {
    table.rows.push_back(cells_of(row, rows.front()));
    row_figures.push_back(json_of(row, rows.front()));
  }
  table.notes = notes_of(views, volume, rows[1].here.has_value(), rows[2]);
  table.figures = {{"poses", views.poses.size()},
                   {"blocked_cameras", thesis::blocked_cameras(volume, views.poses, views.voxel_size_m())},
                   {"image_size", {task.sensor.width, task.sensor.height}},
                   {"voxel_size_m", views.voxel_size_m()},
                   {"volume_voxels", {volume.size().x, volume.size().y, volume.size().z}},
                   {"step_m", kStep_m},
                   {"checked_poses", views.checked.size()},
                   {"rows", std::move(row_figures)}};
  return table;
}

}  // namespace saccade::reproduce
