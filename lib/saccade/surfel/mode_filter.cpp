// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/mode_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

constexpr std::size_t kModeRowsPerTask{16};
constexpr std::size_t kWinnersPerTask{4096};

/// What a task of rows counted, and the surfels that need more or fewer blocks than they have.
struct RowsDone {
  ModeFilterReport counts;
  std::vector<std::pair<SurfelId, SurfelModes>> refitted;
};

void merge(SurfelMode& into, const SurfelMode& other) {
  into.color = weighted_mean(into.color, into.weight, other.color, other.weight);
  into.position_m = weighted_mean(into.position_m, into.weight, other.position_m, other.weight);
  into.weight += other.weight;
}

std::size_t lightest(const SurfelModes& modes) {
  std::size_t best{0};
  for (std::size_t i = 1; i < modes.count; ++i) {
    if (modes.modes[i].weight < modes.modes[best].weight) best = i;
  }
  return best;
}

/// Line 22: p_N(c_i, c_n, σ_c) · w_n > p_N(c_i, c_i, σ_c) · w_i; the common factor of the densities is left out.
bool absorbs(const SurfelMode& n, const SurfelMode& i, double color_sigma) {
  if (n.weight <= i.weight) return false;
  const auto squared = static_cast<double>((i.color - n.color).squaredNorm());
  return std::exp(-squared / (2.0 * color_sigma * color_sigma)) * static_cast<double>(n.weight) >
         static_cast<double>(i.weight);
}

/// Lines 1–26 for one pixel; `enhanced` is the observation with the position of d′_e.
void observe(SurfelModes& modes, const SurfelMode& observed, const SurfelMode& enhanced, const ModeFilterConfig& config,
             ModeFilterReport& counts) {
  const double sigma = config.guided.color_sigma;
  std::size_t n{0};
  if (modes.count > 0) n = modes.nearest(observed.color);
  const bool is_new = modes.count == 0 ||
                      static_cast<double>((modes.modes[n].color - observed.color).norm()) > config.color_sigmas * sigma;
  if (is_new) {
    if (modes.count >= static_cast<std::size_t>(config.max_modes)) {
      const std::size_t evicted = lightest(modes);
      counts.evicted_weight += static_cast<double>(modes.modes[evicted].weight);
      ++counts.evicted_modes;
      modes.remove(evicted);
    }
    modes.add(observed);
    ++counts.new_modes;
    return;
  }
  merge(modes.modes[n], enhanced);
  for (std::size_t i = 0; i < modes.count;) {
    if (i != n && absorbs(modes.modes[n], modes.modes[i], sigma)) {
      merge(modes.modes[n], modes.modes[i]);
      modes.remove(i);
      if (i < n) --n;
      ++counts.merged_modes;
    } else {
      ++i;
    }
  }
}

void add_counts(ModeFilterReport& sum, const ModeFilterReport& counts) {
  sum.pixels += counts.pixels;
  sum.guided += counts.guided;
  sum.new_modes += counts.new_modes;
  sum.merged_modes += counts.merged_modes;
  sum.evicted_modes += counts.evicted_modes;
  sum.evicted_weight += counts.evicted_weight;
}

}  // namespace

Status ModeFilterConfig::validate() const {
  SACCADE_CHECK(guided.validate());
  if (!(color_sigmas > 0.0)) return Error{Errc::invalid_argument, "mode filter: K must be positive", {}};
  if (max_modes < 1 || max_modes > static_cast<int>(kMostModes)) {
    return Error{Errc::invalid_argument, "mode filter: a surfel has 1 to 32 modes", {}};
  }
  return {};
}

Result<ModeFilter> ModeFilter::create(const ModeFilterConfig& config) {
  SACCADE_CHECK(config.validate());
  return ModeFilter{config};
}

void ModeFilter::guide(const Frame& frame, const SurfelAssociation& seen, const Executor& executor,
                       ModeFilterReport& report) {
  const std::size_t pixels = seen.of_pixel.size();
  guidance_.resize(pixels);
  used_.assign(pixels, 0);
  const Eigen::Vector3f forward = seen.T_world_camera.linear().col(2).cast<float>();
  const Eigen::Vector3f center = seen.T_world_camera.translation().cast<float>();
  const std::size_t per_task = kModeRowsPerTask * static_cast<std::size_t>(seen.camera.width);
  std::vector<std::size_t> guided((pixels + per_task - 1) / per_task);
  const double limit = config_.color_sigmas * config_.guided.color_sigma;
  executor.parallel_for(pixels, per_task, [&](std::size_t begin, std::size_t end) {
    SurfelModes modes;
    for (std::size_t i = begin; i < end; ++i) {
      const SurfelId id = seen.of_pixel.data()[i];
      if (id == kNoSurfel || store_.count(id) == 0) continue;
      store_.load(id, modes);
      const Eigen::Vector3f color = unit_color(frame.color->data()[i]);
      const SurfelMode& mode = modes.modes[modes.nearest(color)];
      if (static_cast<double>((mode.color - color).norm()) > limit) continue;
      guidance_[i] << mode.color, forward.dot(mode.position_m - center);
      used_[i] = 1;
      ++guided[begin / per_task];
    }
  });
  for (const std::size_t count : guided) report.guided += count;
}

void ModeFilter::integrate(const Frame& frame, const SurfelAssociation& seen, const Executor& executor,
                           ModeFilterReport& report) {
  const auto rows = static_cast<std::size_t>(seen.camera.height);
  std::vector<RowsDone> done((rows + kModeRowsPerTask - 1) / kModeRowsPerTask);
  executor.parallel_for(rows, kModeRowsPerTask, [&](std::size_t begin, std::size_t end) {
    RowsDone& mine = done[begin / kModeRowsPerTask];
    SurfelModes modes;
    for_each_seen_surfel(
        seen, static_cast<int>(begin), static_cast<int>(end), [&](SurfelId id, std::span<const SeenPixel> pixels) {
          store_.load(id, modes);
          for (const auto& [u, v] : pixels) {
            const float depth_m = frame.depth(u, v);
            float enhanced_m = depth_m;
            if (config_.enhance_depth) {
              const float out = enhanced_m_[static_cast<std::size_t>(v) * static_cast<std::size_t>(seen.camera.width) +
                                            static_cast<std::size_t>(u)];
              if (std::isfinite(out) && out > 0.0F) enhanced_m = out;
            }
            SurfelMode observed{unit_color((*frame.color)(u, v)), seen.back_project(u, v, depth_m), seen.weight(u, v)};
            SurfelMode enhanced = observed;
            if (enhanced_m != depth_m) enhanced.position_m = seen.back_project(u, v, enhanced_m);
            observe(modes, observed, enhanced, config_, mine.counts);
            ++mine.counts.pixels;
          }
          if (!store_.store(id, modes)) mine.refitted.emplace_back(id, modes);
        });
  });
  for (const RowsDone& part : done) {
    add_counts(report, part.counts);
    for (const auto& [id, modes] : part.refitted) store_.store_and_fit(id, modes);
  }
}

Result<ModeFilterReport> ModeFilter::add_frame(const Frame& frame, const SurfelAssociation& seen,
                                               const Executor& executor) {
  const int width = seen.of_pixel.width();
  const int height = seen.of_pixel.height();
  const bool color_fits = !frame.color || (frame.color->width() == width && frame.color->height() == height);
  if (frame.depth.width() != width || frame.depth.height() != height || !color_fits) {
    return Error{Errc::size_mismatch, "mode filter: the frame is not of the association's size", frame.name};
  }
  ModeFilterReport report;
  store_.resize(std::max(seen.surfels, store_.size()));
  report.has_color = frame.color.has_value();
  if (!report.has_color) return report;
  Stopwatch stopwatch;
  if (config_.enhance_depth) {
    guide(frame, seen, executor, report);
    report.associate_ms = stopwatch.lap_ms();
    enhanced_m_.resize(frame.depth.size());
    guided_.apply(width, height, frame.depth.pixels(), guidance_, used_, executor, enhanced_m_);
    report.guided_filter_ms = stopwatch.lap_ms();
  }
  integrate(frame, seen, executor, report);
  report.integrate_ms = stopwatch.lap_ms();
  return report;
}

std::vector<SurfelMode> ModeFilter::modes(SurfelId id) const {
  SurfelModes loaded;
  store_.load(id, loaded);
  return {loaded.modes.begin(), loaded.modes.begin() + static_cast<std::ptrdiff_t>(loaded.count)};
}

std::vector<SurfelMode> ModeFilter::winners(const Executor& executor) const {
  std::vector<SurfelMode> best(store_.size());
  executor.parallel_for(best.size(), kWinnersPerTask, [&](std::size_t begin, std::size_t end) {
    SurfelModes loaded;
    for (std::size_t i = begin; i < end; ++i) {
      store_.load(static_cast<SurfelId>(i), loaded);
      best[i] = {Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), 0.0F};
      for (const SurfelMode& mode : loaded.span()) {
        if (mode.weight > best[i].weight) best[i] = mode;
      }
    }
  });
  return best;
}

}  // namespace saccade
