// SPDX-License-Identifier: Apache-2.0
// Table 2.10: what KinFu pays to keep unknown and empty apart when its volume moves; here: snapshot, save, load.
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "experiments/experiments.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "tables.hpp"
#include "text.hpp"
#include "thesis/update_task.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;

constexpr int kRuns{5};
constexpr int kSnapshots{101};

/// A folder of its own below the system's temporary one, removed at the end.
class ScratchFolder {
 public:
  [[nodiscard]] static Result<ScratchFolder> create() {
    std::error_code error;
    const std::filesystem::path base = std::filesystem::temp_directory_path(error);
    if (error) return Error{Errc::io_failure, "it names no folder; let it name one", "TMPDIR"};
    std::string path = (base / "saccade-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) {
      return Error{Errc::io_failure, "cannot make a folder here; let TMPDIR name another place", base.string()};
    }
    return ScratchFolder{path};
  }
  ScratchFolder(ScratchFolder&& other) noexcept : path_{std::exchange(other.path_, {})} {}
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  explicit ScratchFolder(std::filesystem::path path) : path_{std::move(path)} {}
  std::filesystem::path path_;
};

/// Medians.
struct Costs {
  double snapshot_ms{0.0};
  double frame_alone_ms{0.0};           ///< fusing a frame
  double frame_after_snapshot_ms{0.0};  ///< the same while a snapshot is held: what is written is copied first
  double save_ms{0.0};
  double load_ms{0.0};
  std::uintmax_t file_bytes{0};

  [[nodiscard]] double copy_ms() const { return frame_after_snapshot_ms - frame_alone_ms; }
  [[nodiscard]] double in_the_way_ms() const { return snapshot_ms + copy_ms(); }
  [[nodiscard]] double total_ms() const { return in_the_way_ms() + save_ms + load_ms; }
};

/// Saves and loads the map; the last one loaded shares nothing with it.
Result<TsdfSnapshot> measure_file(const thesis::UpdateTask& task, const Executor& executor, const Progress& progress,
                                  Costs& costs) {
  SACCADE_TRY(const ScratchFolder folder, ScratchFolder::create());
  const std::filesystem::path file = folder / "map.sacmap";
  std::vector<double> save_ms;
  std::vector<double> load_ms;
  std::optional<TsdfSnapshot> loaded;
  for (int run = 0; run < kRuns; ++run) {
    progress.report("saving and loading", static_cast<std::size_t>(run), kRuns);
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "Table 2.10"};
    loaded.reset();
    Stopwatch clock;
    SACCADE_CHECK(save_map(task.map, file, executor));
    save_ms.push_back(clock.lap_ms());
    SACCADE_TRY(loaded, load_map(file, executor));
    load_ms.push_back(clock.lap_ms());
    SACCADE_EXPECTS(loaded->grid == task.map.grid);
  }
  std::error_code ignored;
  costs.file_bytes = std::filesystem::file_size(file, ignored);
  costs.save_ms = median(save_ms);
  costs.load_ms = median(load_ms);
  return *std::move(loaded);
}

Status measure_map(const thesis::UpdateTask& task, TsdfMap& map, const Executor& executor, const Progress& progress,
                   Costs& costs) {
  std::vector<double> snapshot_ms;
  for (int run = 0; run < kSnapshots; ++run) {
    Stopwatch clock;
    const TsdfSnapshot snapshot = map.snapshot();
    snapshot_ms.push_back(clock.lap_ms());
    if (run == 0) SACCADE_EXPECTS(snapshot.grid == map.content().grid);
  }
  costs.snapshot_ms = median(snapshot_ms);

  std::vector<double> alone_ms;
  std::vector<double> held_ms;
  for (int run = 0; run <= kRuns; ++run) {
    progress.report("fusing beside a snapshot", static_cast<std::size_t>(run), kRuns + 1);
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "Table 2.10"};
    std::optional<TsdfSnapshot> held{map.snapshot()};
    SACCADE_TRY(const FusionStats beside,
                map.integrate(task.camera, task.next_frame.depth, *task.next_frame.T_world_camera, executor));
    held.reset();
    SACCADE_TRY(const FusionStats alone,
                map.integrate(task.camera, task.next_frame.depth, *task.next_frame.T_world_camera, executor));
    if (run == 0) continue;  // it also makes bricks
    held_ms.push_back(beside.ms);
    alone_ms.push_back(alone.ms);
  }
  costs.frame_alone_ms = median(alone_ms);
  costs.frame_after_snapshot_ms = median(held_ms);
  return {};
}

struct OverheadPhase {
  const char* thesis;
  int kinfu_ms;
  int nbv_gpu_ms;
  std::string here;
  std::optional<double> ms;
};

}  // namespace

Result<ReproducedTable> table_2_10(const TableOptions& options, Experiments& experiments, const Executor& executor,
                                   const Progress& progress) {
  SACCADE_CHECK(carry_out_update_task(options, executor, progress, experiments.update_task));
  const thesis::UpdateTask& task = *experiments.update_task;
  Costs costs;
  SACCADE_TRY(TsdfSnapshot loaded, measure_file(task, executor, progress, costs));
  TsdfMap map{std::move(loaded)};
  SACCADE_CHECK(measure_map(task, map, executor, progress, costs));

  const std::vector<OverheadPhase> phases{
      {"Shifting", 830, 836, "nothing: the map has no bounds to shift", std::nullopt},
      {"weights download", 0, 283, "snapshot of the whole map, weights and all", costs.snapshot_ms},
      {"read octree (parallel)", 0, 3396, "load it from a .sacmap file (parallel)", costs.load_ms},
      {"weights upload", 0, 45, "the next frame copies what it writes: so much longer it takes", costs.copy_ms()},
      {"write octree (parallel)", 0, 1638, "save it to a .sacmap file (parallel)", costs.save_ms},
      {"Total time", 830, 6232, "total", costs.total_ms()}};
  ReproducedTable table;
  table.caption = "Table 2.10: overhead of keeping unknown and empty apart while data moves, in milliseconds";
  table.columns = {"thesis", "standard KinFu LS, ms", "NBV-GPU, ms", "here", "here, ms"};
  json rows = json::array();
  for (const OverheadPhase& phase : phases) {
    table.rows.push_back({phase.thesis, std::to_string(phase.kinfu_ms), std::to_string(phase.nbv_gpu_ms), phase.here,
                          phase.ms ? fixed(*phase.ms, *phase.ms < 1.0 ? 3 : 1) : "–"});
    rows.push_back({{"phase", phase.thesis},
                    {"thesis_kinfu_ms", phase.kinfu_ms},
                    {"thesis_nbv_gpu_ms", phase.nbv_gpu_ms},
                    {"here", phase.here},
                    {"ms", phase.ms ? json(*phase.ms) : json(nullptr)}});
  }
  const TsdfGrid::Usage usage = task.map.grid.usage();
  table.notes = {
      "What corresponds: KinFu LS keeps 512³ voxels on the GPU and forgets weights as they leave it; NBV-GPU carries "
      "them to an octree in the computer's memory and back. Here weights are part of the map, which stays where it is: "
      "readers get a snapshot, and only a map that is put away goes through a file (compressed, with checksums), off "
      "the path of fusion.",
      "In the way of mapping: 283 + 45 ms in the thesis; here " + fixed(costs.in_the_way_ms(), 2) +
          " ms: the snapshot, and a frame that takes " + fixed(costs.frame_after_snapshot_ms, 2) + " ms instead of " +
          fixed(costs.frame_alone_ms, 2) + " ms while one is held.",
      "The map: " + std::to_string(task.frames) + " simulated frames of the scene " + task.scene + ", " +
          std::to_string(usage.bricks()) + " bricks of 8³ voxels of " + millimetres(task.map.config.voxel_size_m) +
          ", " + mebibytes(usage.bytes) + " in memory, " + mebibytes(costs.file_bytes) + " in the file; " +
          std::to_string(executor.threads()) +
          " threads. Snapshot and loaded map were found equal to the map, voxel by voxel, weights included.",
      "The thesis' phases add up to 6198 ms, not to the total that it prints. Its machine: Core i7-4770, GeForce GTX "
      "670. Medians of " +
          std::to_string(kRuns) + " runs (snapshot: " + std::to_string(kSnapshots) + ")."};
  table.figures = {{"rows", std::move(rows)},
                   {"in_the_way_ms", costs.in_the_way_ms()},
                   {"frame_ms", {{"alone", costs.frame_alone_ms}, {"after_snapshot", costs.frame_after_snapshot_ms}}},
                   {"bricks", usage.bricks()},
                   {"bytes", usage.bytes},
                   {"file_bytes", costs.file_bytes},
                   {"equal", true}};
  return table;
}

}  // namespace saccade::reproduce
