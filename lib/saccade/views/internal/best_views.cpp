// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/best_views.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "saccade/core/clock.hpp"
#include "saccade/views/internal/gain_problem.hpp"

namespace saccade {
namespace {

constexpr int kLookOverPx{16};           // tiles of the first look
constexpr std::size_t kLatticeGrain{4};  // lattices
constexpr std::size_t kLeastBatch{4};    // jobs before bounds are compared with a new best; fixed: see best_views
constexpr std::size_t kMostBatch{64};

bool better(const OrderedView& a, const OrderedView& b) {
  return a.gain != b.gain ? a.gain > b.gain : a.index < b.index;
}

/// Keeps the best places_ views evaluated so far.
class TopViews {
 public:
  TopViews(std::size_t places, std::span<const Pose> poses) : places_{places}, poses_{poses} {}

  void add(std::size_t pose, std::uint64_t gain) {
    const OrderedView view{pose, gain, poses_[pose]};
    views_.insert(std::upper_bound(views_.begin(), views_.end(), view, better), view);
    if (views_.size() > places_) views_.pop_back();
  }
  /// Returns the smallest gain with which a pose enters the list. At equal gains the index decides.
  [[nodiscard]] std::uint64_t entry(std::size_t pose) const {
    return views_.size() < places_ ? 0 : views_.back().gain + (pose > views_.back().index ? 1 : 0);
  }
  [[nodiscard]] std::vector<OrderedView> take() { return std::move(views_); }

 private:
  std::size_t places_;
  std::span<const Pose> poses_;
  std::vector<OrderedView> views_;
};

Result<BestViews> evaluate_all(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                               std::size_t count, const GainConfig& config, const Executor& executor) {
  SACCADE_TRY(const GainResult all, evaluate_views(map, region, T_world_camera, config, executor));
  BestViews best;
  best.views = order_views(all.gains, T_world_camera);
  best.views.resize(std::min(count, best.views.size()));
  best.poses_evaluated = T_world_camera.size();
  best.rays_cast = all.rays_cast;
  best.prepare_ms = all.prepare_ms;
  best.evaluate_ms = all.evaluate_ms;
  return best;
}

/// Returns the common pixel grid of windows whose pixels coincide.
std::optional<PixelGrid> common_grid(const GainProblem& problem, std::span<const std::size_t> jobs) {
  constexpr double kOff_px{1e-3};
  PixelGrid hull = problem.jobs[jobs.front()].window.grid();
  double last_a{hull.first_a};
  double last_b{hull.first_b};
  for (const std::size_t job : jobs) {
    const CastWindow& window = problem.jobs[job].window;
    if (window.pixels_per_a != hull.pixels_per_a || window.pixels_per_b != hull.pixels_per_b) return std::nullopt;
    const double columns = (static_cast<double>(window.a.front()) - hull.first_a) * hull.pixels_per_a;
    const double rows = (static_cast<double>(window.b.front()) - hull.first_b) * hull.pixels_per_b;
    if (std::abs(columns - std::round(columns)) > kOff_px || std::abs(rows - std::round(rows)) > kOff_px) {
      return std::nullopt;
    }
    hull.first_a = std::min(hull.first_a, static_cast<double>(window.a.front()));
    hull.first_b = std::min(hull.first_b, static_cast<double>(window.b.front()));
    last_a = std::max(last_a, static_cast<double>(window.a.back()));
    last_b = std::max(last_b, static_cast<double>(window.b.back()));
  }
  hull.columns = static_cast<int>(std::lround((last_a - hull.first_a) * hull.pixels_per_a)) + 1;
  hull.rows = static_cast<int>(std::lround((last_b - hull.first_b) * hull.pixels_per_b)) + 1;
  return hull;
}

ShownPixels pixels_of(const CastWindow& window, const PixelGrid& grid, const Footprint& footprint) {
  return {&footprint,
          static_cast<int>(std::lround((static_cast<double>(window.a.front()) - grid.first_a) * grid.pixels_per_a)),
          static_cast<int>(std::lround((static_cast<double>(window.b.front()) - grid.first_b) * grid.pixels_per_b))};
}

void draw(const GainProblem& problem, const CastWindow& window, const PixelGrid& grid, Footprint& footprint) {
  footprint.draw(problem.faces, window.rays, grid, problem.voxel_size_m, problem.limits.min_t, problem.limits.max_t);
}

std::uint64_t bound_of(const CastWindow& window, const ShownPixels& shown) {
  const auto columns = static_cast<int>(window.a.size());
  const auto rows = static_cast<int>(window.b.size());
  return shown.footprint->count({shown.column, shown.column + columns, shown.row, shown.row + rows});
}

/// Bounds the gains of windows that share camera centre and axes.
void bound_lattice(const GainProblem& problem, std::span<const std::size_t> jobs, Footprint& footprint,
                   std::vector<std::uint64_t>& bounds) {
  const std::optional<PixelGrid> common = common_grid(problem, jobs);
  if (common) draw(problem, problem.jobs[jobs.front()].window, *common, footprint);
  for (const std::size_t job : jobs) {
    const CastWindow& window = problem.jobs[job].window;
    const PixelGrid grid = common ? *common : window.grid();
    if (!common) draw(problem, window, grid, footprint);
    bounds[job] = bound_of(window, pixels_of(window, grid, footprint));
  }
}

/// Returns an upper bound of the gain of each job.
std::vector<std::uint64_t> bound_gains(const GainProblem& problem, const Executor& executor) {
  std::vector<std::uint64_t> bounds(problem.jobs.size());
  executor.parallel_for(problem.lattices.size(), kLatticeGrain, [&](std::size_t begin, std::size_t end) {
    Footprint footprint;
    for (std::size_t i = begin; i < end; ++i) bound_lattice(problem, problem.lattices[i], footprint, bounds);
  });
  return bounds;
}

/// Result of deciding a job's rays.
struct Refined {
  std::optional<std::uint64_t> gain;  ///< none: below the best
  std::uint64_t rays_cast{0};
};

std::vector<Refined> refine(const GainProblem& problem, std::span<const std::size_t> jobs, const TopViews& podium,
                            const Executor& executor) {
  std::vector<Refined> refined(jobs.size());
  executor.parallel_for(jobs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const GainJob& job = problem.jobs[jobs[i]];
      Footprint footprint;
      draw(problem, job.window, job.window.grid(), footprint);
      GainCaster caster{problem.grid, job.window, problem.limits, nullptr, {&footprint, 0, 0}};
      caster.look_over(kLookOverPx);
      caster.classify_open_tiles();
      caster.refine(podium.entry(job.poses.front()));
      refined[i].rays_cast = caster.rays_cast();
      if (caster.decided()) refined[i].gain = caster.scored();
    }
  });
  return refined;
}

}  // namespace

Result<BestViews> best_views(const TsdfSnapshot& map, const Region& region, std::span<const Pose> T_world_camera,
                             std::size_t count, const GainConfig& config, const Executor& executor) {
  if (count == 0) return Error{Errc::invalid_argument, "at least one view must be asked for", "view evaluation"};
  const GainSavings& savings = config.savings;
  if (config.count != GainCount::rays || !savings.tiles || !savings.empty_bricks || !savings.region_rays ||
      !savings.footprints) {
    return evaluate_all(map, region, T_world_camera, count, config, executor);
  }
  SACCADE_TRY(const GainProblem problem, GainProblem::prepare(map, region, T_world_camera, config, executor));
  BestViews best;
  best.prepare_ms = problem.prepare_ms;
  const Stopwatch clock;
  const std::vector<std::uint64_t> bounds = bound_gains(problem, executor);
  std::vector<std::size_t> order(problem.jobs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return bounds[a] > bounds[b]; });

  TopViews podium{count, T_world_camera};
  std::vector<bool> in_a_job(T_world_camera.size());
  for (const GainJob& job : problem.jobs) {
    for (const std::size_t pose : job.poses) in_a_job[pose] = true;
  }
  for (std::size_t pose = 0; pose < T_world_camera.size(); ++pose) {
    if (!in_a_job[pose]) podium.add(pose, 0);
  }
  const auto may_enter = [&](std::size_t job) { return bounds[job] >= podium.entry(problem.jobs[job].poses.front()); };
  std::vector<std::size_t> batch;
  for (auto next = order.begin(); next != order.end();) {
    const std::size_t size = std::clamp(static_cast<std::size_t>(next - order.begin()), kLeastBatch, kMostBatch);
    batch.clear();
    for (; next != order.end() && batch.size() < size; ++next) {
      if (may_enter(*next)) batch.push_back(*next);
    }
    const std::vector<Refined> refined = refine(problem, batch, podium, executor);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      best.rays_cast += refined[i].rays_cast;
      if (!refined[i].gain) continue;
      for (const std::size_t pose : problem.jobs[batch[i]].poses) podium.add(pose, *refined[i].gain);
      best.poses_evaluated += problem.jobs[batch[i]].poses.size();
    }
  }
  best.views = podium.take();
  best.evaluate_ms = clock.elapsed_ms();
  return best;
}

}  // namespace saccade
