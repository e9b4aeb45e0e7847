// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/view_gain.hpp"

#include <algorithm>
#include <mutex>

#include "saccade/core/clock.hpp"
#include "saccade/views/internal/gain_problem.hpp"
#include "saccade/views/internal/no_gain.hpp"

namespace saccade {
namespace {

constexpr int kBandRows{64};
constexpr std::size_t kManyJobs{
    64};  // number of jobs that keeps all threads busy uncut, with each footprint drawn once

/// Band of rows of a job; the whole window where distinct voxels are counted, or footprints drawn for many jobs.
struct Band {
  std::size_t job;
  int row_begin;
  int row_end;
};

std::vector<Band> make_bands(const GainProblem& problem, GainCount count) {
  const std::vector<GainJob>& jobs = problem.jobs;
  const bool cut = count == GainCount::rays && !(problem.limits.savings.footprints && jobs.size() >= kManyJobs);
  std::vector<Band> bands;
  for (std::size_t job = 0; job < jobs.size(); ++job) {
    const auto rows = static_cast<int>(jobs[job].window.b.size());
    const int step = cut ? kBandRows : std::max(rows, 1);
    for (int row = 0; row < rows; row += step) bands.push_back({job, row, std::min(row + step, rows)});
  }
  return bands;
}

struct BandTally {
  std::uint64_t gain{0};
  std::uint64_t rays_cast{0};
};

BandTally cast_band(const Band& band, const GainProblem& problem, GainCount count) {
  const CastWindow& window = problem.jobs[band.job].window;
  std::optional<VoxelSet> seen;
  if (count == GainCount::distinct_voxels) seen.emplace(problem.grid.scoring_voxels());
  Footprint footprint;
  ShownPixels shown;
  if (problem.limits.savings.footprints) {
    PixelGrid pixels = window.grid();
    pixels.first_b = static_cast<double>(window.b[static_cast<std::size_t>(band.row_begin)]);
    pixels.rows = band.row_end - band.row_begin;
    footprint.draw(problem.faces, window.rays, pixels, problem.voxel_size_m, problem.limits.min_t,
                   problem.limits.max_t);
    shown = {&footprint, 0, -band.row_begin};
  }
  GainCaster caster{problem.grid, window, problem.limits, seen ? &*seen : nullptr, shown};
  caster.cast_rows(band.row_begin, band.row_end);
  return {seen ? seen->count() : caster.scored(), caster.rays_cast()};
}

/// Casts all bands. Gains are in the order of the bands for every thread count.
Status cast_jobs(const GainProblem& problem, GainCount count, const Executor& executor, const Progress& progress,
                 GainResult& result) {
  const std::vector<Band> bands = make_bands(problem, count);
  std::vector<BandTally> tallies(bands.size());
  std::mutex report;
  std::size_t done{0};
  executor.parallel_for(bands.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (progress.cancelled()) return;
      tallies[i] = cast_band(bands[i], problem, count);
      const std::lock_guard lock{report};
      progress.report(kEvaluation, ++done, bands.size());
    }
  });
  if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", std::string{kEvaluation}};
  for (std::size_t i = 0; i < bands.size(); ++i) {
    result.rays_cast += tallies[i].rays_cast;
    for (const std::size_t pose : problem.jobs[bands[i].job].poses) result.gains[pose] += tallies[i].gain;
  }
  return {};
}

}  // namespace

Result<GainResult> evaluate_views(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                                  const GainConfig& config, const Executor& executor, const Progress& progress) {
  SACCADE_TRY(const GainProblem problem, GainProblem::prepare(map, region, T_world_camera, config, executor, progress));
  GainResult result;
  result.backend = executor.backend_name();
  result.gains.assign(T_world_camera.size(), 0);
  result.rays_total = problem.rays_total;
  result.prepare_ms = problem.prepare_ms;
  Stopwatch clock;
  SACCADE_CHECK(cast_jobs(problem, config.count, executor, progress, result));
  result.evaluate_ms = clock.lap_ms();
  if (std::all_of(result.gains.begin(), result.gains.end(), [](std::uint64_t gain) { return gain == 0; })) {
    result.no_gain = why_no_gain(map, region, T_world_camera, config);
  }
  return result;
}

}  // namespace saccade
